// Images on oblique surfaces: the anisotropic filter against averages and against mip-maps alone.
#include <OpenImageIO/imageio.h>

#include <cmath>

#include "tests/postrender_fixture.h"

namespace nullcone::postrender {
namespace {

constexpr int kTexels = 512, kCheck = 16, kWidth = 96, kHeight = 64;

/// Checks of 16 x 16 texels.
void write_checks(const std::string& path) {
  std::vector<std::uint8_t> bytes;
  for (int j = 0; j < kTexels; ++j)
    for (int i = 0; i < kTexels; ++i) bytes.push_back((i / kCheck + j / kCheck) % 2 == 0 ? 255 : 0);
  const auto out = OIIO::ImageOutput::create("png");
  ASSERT_TRUE(out->open(path, OIIO::ImageSpec(kTexels, kTexels, 1, OIIO::TypeDesc::UINT8)));
  ASSERT_TRUE(out->write_image(OIIO::TypeDesc::UINT8, bytes.data()));
  out->close();
}

/// A plane that runs away from the eye, its texture turned by 30 degrees.
std::array<double, 2> uv_at(double x, double y) {
  const double depth = 40 / (y + 4), across = (x / kWidth - 0.5) * depth * 0.2;
  const double c = std::sqrt(0.75), s = 0.5, along = depth * 0.12;
  return {0.5 + c * across - s * along, 0.1 + s * across + c * along};
}

Dataset plane(bool recorded) {
  Dataset out = make_dataset(kWidth, kHeight, {{"earth"}}, [](int column, int row) {
    const auto [u, v] = uv_at(column + 0.5, row + 0.5);
    TestHit hit;
    hit.u = static_cast<float>(u);
    hit.v = static_cast<float>(v);
    return std::vector{hit};
  });
  if (!recorded) return out;
  out.hits.channels = out.manifest.channels = out.hits.channels | ChannelSet::of("duv");
  for (int row = 0; row < kHeight; ++row)
    for (int column = 0; column < kWidth; ++column)
      for (std::size_t k = 0; k < 4; ++k) {
        const double x = column + 0.5, y = row + 0.5, h = 1e-4;
        const auto before = k < 2 ? uv_at(x - h, y) : uv_at(x, y - h),
                   after = k < 2 ? uv_at(x + h, y) : uv_at(x, y + h);
        out.hits.duv[k].push_back(static_cast<float>((after[k % 2] - before[k % 2]) / (2 * h)));
      }
  return out;
}

/// The checks averaged over a pixel: 32 x 32 points.
double averaged(int column, int row) {
  constexpr int kFine = 32;
  double sum = 0;
  for (int j = 0; j < kFine; ++j)
    for (int i = 0; i < kFine; ++i) {
      const auto [u, v] = uv_at(column + (i + 0.5) / kFine, row + (j + 0.5) / kFine);
      const double x = (u - std::floor(u)) * kTexels,
                   y = (1 - std::min(std::max(v, 0.0), 1 - 1e-9)) * kTexels;
      sum += (static_cast<int>(x) / kCheck + static_cast<int>(y) / kCheck) % 2 == 0 ? 1 : 0;
    }
  return sum / (kFine * kFine);
}

class Oblique : public testing::Test {
 protected:
  void SetUp() override { write_checks(folder.file("checks.png")); }
  std::string look(const std::string& filter, const std::string& rest = "") {
    return R"({"objects":{"earth":{"texture":{"type":"image","file":"checks.png","filter":")" + filter +
           "\"" + rest + "}}}}";
  }
  /// Root mean square of the differences from averages.
  double error(const Dataset& data, const std::string& filter) {
    const Image image = picture(data, look(filter), folder.path());
    double squares = 0;
    for (int row = 0; row < kHeight; ++row)
      for (int column = 0; column < kWidth; ++column) {
        const float found = image.display[static_cast<std::size_t>(row * kWidth + column)].r;
        squares += std::pow(static_cast<double>(found) - averaged(column, row), 2);
      }
    return std::sqrt(squares / (kWidth * kHeight));
  }
  TestFolder folder;
};

TEST_F(Oblique, checks_are_nearer_to_averages_than_mipmaps) {
  for (const bool recorded : {false, true}) {
    const Dataset data = plane(recorded);
    const double sharp = error(data, "anisotropic"), soft = error(data, "mipmap"),
                 rough = error(data, "bilinear");
    RecordProperty(recorded ? "recorded" : "neighbours",
                   std::to_string(sharp) + " " + std::to_string(soft) + " " + std::to_string(rough));
    EXPECT_LT(sharp, 0.35 * soft) << sharp << " " << soft;
    EXPECT_LT(sharp, 0.5 * rough) << sharp << " " << rough;
  }
}

TEST_F(Oblique, checks_below_a_pixel_turn_grey) {
  // 128 texels a pixel along one direction, 64 along the other: nothing but the mean may be left.
  Dataset data = plane(true);
  const std::array<float, 4> steps = {0.25f, 0.02f, 0.01f, 0.125f};
  for (std::size_t k = 0; k < 4; ++k) std::ranges::fill(data.hits.duv[k], steps[k]);
  for (const Rgb c : picture(data, look("anisotropic"), folder.path()).display) ASSERT_NEAR(c.r, 0.5f, 0.05f);
}

TEST_F(Oblique, round_footprints_are_as_with_mipmaps) {
  Dataset data = plane(true);
  const std::array<float, 4> steps = {0.02f, 0, 0, 0.02f};
  for (std::size_t k = 0; k < 4; ++k) std::ranges::fill(data.hits.duv[k], steps[k]);
  const Image one = picture(data, look("anisotropic"), folder.path()),
              other = picture(data, look("mipmap"), folder.path());
  for (std::size_t i = 0; i < one.display.size(); ++i)
    ASSERT_NEAR(one.display[i].r, other.display[i].r, 2e-4f);  // levels within 1e-4
}

TEST_F(Oblique, unknown_steps_blur_fully_and_kernels_agree) {
  constexpr float kNan = std::numeric_limits<float>::quiet_NaN(),
                  kInf = std::numeric_limits<float>::infinity();
  for (const bool recorded : {false, true})
    for (const char* rest :
         {"", R"(,"scale":[0,1])", R"(,"scale":[1e4,-1e4])", R"(,"rotate_deg":[20,0,0])"}) {
      Dataset data = plane(recorded);
      for (std::size_t i = 0; i < 4; ++i) {
        const float odd = std::array{kNan, kInf, -kInf, 1e30f}[i];
        data.hits.u[5 + 2 * i] = odd;
        data.hits.v[kWidth + 2 * i] = odd;
        if (recorded) std::fill_n(data.hits.duv[i].begin() + 4 * kWidth, kWidth, odd);
      }
      Image first;
      for (const Kernel* kernel : kernels()) {
        Renderer renderer(data, *kernel);
        const Image image =
            renderer.render(look_of(look("anisotropic", rest), renderer.manifest(), folder.path()));
        for (const Rgb c : image.exposed) ASSERT_TRUE(c.r >= 0 && c.r <= 1.001f) << rest;
        if (recorded) {
          EXPECT_NEAR(image.exposed[4 * kWidth + 30].r, 0.5f, 1e-3f) << rest;
        }
        if (kernel == kernels().front()) first = image;
        EXPECT_EQ(image.exposed, first.exposed) << kernel->isa << rest;
      }
    }
}

}  // namespace
}  // namespace nullcone::postrender
