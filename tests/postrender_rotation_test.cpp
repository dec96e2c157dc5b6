// Textures rotated on the sphere: closed forms, steps near poles and seam, and pictures against averages.
#include <cmath>
#include <numbers>
#include <random>

#include "postrender/moving_texture.h"
#include "tests/postrender_fixture.h"

namespace nullcone::postrender {
namespace {

using Vector = std::array<double, 3>;
constexpr double kPi = std::numbers::pi;

Vector direction(double u, double v) {
  const double longitude = 2 * kPi * (u - 0.5), latitude = kPi * (v - 0.5);
  return {std::cos(latitude) * std::cos(longitude), std::cos(latitude) * std::sin(longitude),
          std::sin(latitude)};
}

/// Right-handed, about the axis number `axis`, written out.
Vector turned(const Vector& p, std::size_t axis, double degrees) {
  const double c = std::cos(degrees * kPi / 180), s = std::sin(degrees * kPi / 180);
  const std::size_t j = (axis + 1) % 3, k = (axis + 2) % 3;
  Vector out = p;
  out[j] = c * p[j] - s * p[k];
  out[k] = s * p[j] + c * p[k];
  return out;
}

/// Where the texture is looked up: the rotation undone, the last axis first.
Vector in_texture(Vector p, const Vector& about) {
  for (std::size_t axis = 3; axis-- > 0;) p = turned(p, axis, -about[axis]);
  return p;
}

std::array<double, 2> uv_of(const Vector& p) {
  return {0.5 + std::atan2(p[1], p[0]) / (2 * kPi), 0.5 + std::atan2(p[2], std::hypot(p[0], p[1])) / kPi};
}

double distance(const Vector& a, const Vector& b) {
  return std::hypot(a[0] - b[0], a[1] - b[1], a[2] - b[2]);
}

Rotation rotation_of(const Vector& about) { return {{Number{about[0]}, Number{about[1]}, Number{about[2]}}}; }

const std::vector<Vector> kRotations = {{0, 0, 0},    {90, 0, 0},     {0, 90, 0},        {0, 180, 0},
                                        {23.4, 0, 0}, {10, -75, 200}, {-120, 35, 3600.5}};

TEST(Rotation, looks_up_where_the_closed_form_does) {
  std::mt19937 random(7);
  std::uniform_real_distribution<float> any(0, 1);
  for (const Vector& about : kRotations)
    for (int i = 0; i < 2000; ++i) {
      // Poles and seam among them.
      float u = i % 7 == 0 ? 0.0f : any(random), v = i % 5 == 0 ? static_cast<float>(i % 2) : any(random);
      const Vector expected = in_texture(direction(static_cast<double>(u), static_cast<double>(v)), about);
      rotate({rotation_of(about).to_texture({})}, 1, &u, &v, {}, false);
      ASSERT_TRUE(u >= 0 && u <= 1 && v >= 0 && v <= 1) << u << " " << v;
      // 5e-7: a few roundings of numbers up to 1, and pi times that of v.
      ASSERT_LT(distance(direction(static_cast<double>(u), static_cast<double>(v)), expected), 5e-7);
    }
}

TEST(Rotation, turns_by_the_right_hand_about_x_then_y_then_z) {
  const auto seen_at = [](const Rotation& rotation, float u, float v) {
    rotate({rotation.to_texture({})}, 1, &u, &v, {}, false);
    return std::array{u, v};
  };
  // About x by 90 degrees +y comes to +z, the north pole.
  EXPECT_NEAR(seen_at(rotation_of({90, 0, 0}), 0.3f, 1)[0], 0.75f, 1e-6f);
  EXPECT_NEAR(seen_at(rotation_of({90, 0, 0}), 0.3f, 1)[1], 0.5f, 1e-6f);
  // Then about y +z comes to +x.
  EXPECT_NEAR(seen_at(rotation_of({90, 90, 0}), 0.5f, 0.5f)[0], 0.75f, 1e-6f);
  // Then about z +x comes to +y.
  EXPECT_NEAR(seen_at(rotation_of({90, 90, 90}), 0.75f, 0.5f)[0], 0.75f, 1e-6f);
  // About an axis of any length.
  const Rotation about_y = {{Number{40.0}}, Vector{0, 1, 0}};
  for (std::size_t k = 0; k < 9; ++k)
    EXPECT_NEAR(about_y.to_texture({})[k], rotation_of({0, 40, 0}).to_texture({})[k], 1e-7f);
}

/// Steps of one pixel after rotation.
std::array<float, 4> steps_after(const Vector& about, float u, float v, std::array<float, 4> steps,
                                 bool recorded) {
  rotate({rotation_of(about).to_texture({})}, 1, &u, &v, {&steps[0], &steps[1], &steps[2], &steps[3]},
         recorded);
  return steps;
}

TEST(RotatedSteps, are_derivatives_where_they_were_recorded) {
  std::mt19937 random(8);
  std::uniform_real_distribution<float> any(0, 1);
  for (const Vector& about : kRotations)
    for (int i = 0; i < 500; ++i) {
      const float u = any(random), v = 0.02f + 0.96f * any(random);
      const std::array<float, 4> steps = {0.02f * any(random), -0.02f * any(random), 0.01f,
                                          0.01f * any(random)};
      const auto found = steps_after(about, u, v, steps, true);
      for (std::size_t k = 0; k < 4; k += 2) {
        constexpr double h = 1e-5;
        const auto at = [&](double s) {
          return in_texture(direction(static_cast<double>(u) + s * static_cast<double>(steps[k]),
                                      static_cast<double>(v) + s * static_cast<double>(steps[k + 1])),
                            about);
        };
        const Vector p = at(0);
        if (std::hypot(p[0], p[1]) < 0.01) continue;  // there the difference below is no derivative
        const auto before = uv_of(at(-h)), after = uv_of(at(h));
        const double du = std::remainder(after[0] - before[0], 1) / (2 * h),
                     dv = (after[1] - before[1]) / (2 * h);
        const double tolerance = 2e-5 * (std::hypot(du, dv) + 0.01) / std::hypot(p[0], p[1]);
        EXPECT_NEAR(static_cast<double>(found[k]), du, tolerance);
        EXPECT_NEAR(static_cast<double>(found[k + 1]), dv, tolerance);
      }
    }
}

TEST(RotatedSteps, are_differences_where_neighbours_gave_them) {
  // Also across the pole of the record and over the seam of the texture.
  for (const Vector& about : kRotations)
    for (const auto& [u, v, du, dv] :
         {std::array{0.1f, 0.97f, 0.45f, 0.01f}, {0.99f, 0.5f, 0.02f, 0.03f}, {0.3f, 0.02f, -0.3f, -0.02f}}) {
      const auto from = uv_of(in_texture(direction(static_cast<double>(u), static_cast<double>(v)), about)),
                 to = uv_of(
                     in_texture(direction(static_cast<double>(u + du), static_cast<double>(v + dv)), about));
      const auto found = steps_after(about, u, v, {du, dv, 0, 0}, false);
      // Where the texture's pole is hit its longitude is anything.
      if (std::max(std::abs(from[1] - 0.5), std::abs(to[1] - 0.5)) < 0.4999) {
        EXPECT_NEAR(static_cast<double>(found[0]), std::remainder(to[0] - from[0], 1), 1e-4);
      }
      EXPECT_NEAR(static_cast<double>(found[1]), to[1] - from[1], 1e-5);
      EXPECT_EQ(found[2], 0);
      EXPECT_EQ(found[3], 0);
    }
}

TEST(RotatedSteps, stay_unknown_and_finite) {
  for (const Vector& about : kRotations)
    for (const float v : {0.0f, 1e-30f, 0.5f, 1.0f})
      for (const float step : {0.0f, 1e6f, -1e6f, 0.5f}) {
        const auto found = steps_after(about, 0.5f, v, {step, step, 0, 1e-3f}, true);
        for (const float one : found) EXPECT_TRUE(std::abs(one) <= 1e6f) << one;
        if (std::abs(step) == 1e6f) {
          EXPECT_EQ(found[0], 1e6f);
        }
      }
}

std::string board(const std::string& rest) {
  return R"({"objects":{"earth":{"texture":{"type":"checkerboard","counts":[16,8],"colors":[[1,1,1],[0,0,0]])" +
         rest + "}}}}";
}

/// A sphere seen from +x far away, north up; with the derivatives of longitude and latitude, or without.
Dataset ball(int side, bool recorded) {
  std::vector<std::array<float, 4>> steps;
  const double scale = 2.0 / side;
  Dataset out = make_dataset(side, side, {{"earth"}}, [&](int column, int row) {
    const double y = (column + 0.5 - side / 2.0) * scale, z = (side / 2.0 - row - 0.5) * scale;
    const double xx = 1 - y * y - z * z;
    if (xx < 0.15) return std::vector<TestHit>{};
    const double x = std::sqrt(xx), ring = xx + y * y;
    TestHit hit;
    hit.u = static_cast<float>(0.5 + std::atan2(y, x) / (2 * kPi));
    hit.v = static_cast<float>(0.5 + std::asin(z) / kPi);
    steps.push_back({static_cast<float>(scale * (x + y * y / x) / ring / (2 * kPi)), 0,
                     static_cast<float>(-scale * (y * z / x) / ring / (2 * kPi)),
                     static_cast<float>(-scale / std::sqrt(1 - z * z) / kPi)});
    return std::vector{hit};
  });
  if (!recorded) return out;
  out.hits.channels = out.manifest.channels = out.hits.channels | ChannelSet::of("duv");
  for (const auto& step : steps)
    for (std::size_t i = 0; i < 4; ++i) out.hits.duv[i].push_back(step[i]);
  return out;
}

/// The board of 16 x 8 squares, rotated, averaged over a pixel of ball().
double averaged_board(int side, int column, int row, const Vector& about) {
  constexpr int kFine = 8;
  double sum = 0;
  for (int j = 0; j < kFine; ++j)
    for (int i = 0; i < kFine; ++i) {
      const double y = (column + (i + 0.5) / kFine - side / 2.0) * 2 / side;
      const double z = (side / 2.0 - row - (j + 0.5) / kFine) * 2 / side;
      const auto [u, v] = uv_of(in_texture({std::sqrt(std::max(0.0, 1 - y * y - z * z)), y, z}, about));
      sum += (static_cast<int>(u * 16) + static_cast<int>(v * 8)) % 2 == 0 ? 1 : 0;
    }
  return sum / (kFine * kFine);
}

TEST(RotatedBoard, is_that_of_averages_also_at_its_poles) {
  constexpr int kSide = 64;
  for (const Vector& about : {Vector{0, 0, 30}, {90, 0, 0}, {0, 60, 0}, {20, -70, 130}})
    for (const bool recorded : {false, true}) {
      const std::string rest = R"(,"rotate_deg":[)" + std::to_string(about[0]) + "," +
                               std::to_string(about[1]) + "," + std::to_string(about[2]) + "]";
      const Dataset data = ball(kSide, recorded);
      const Image image = picture(data, board(rest));
      double error = 0, none = 0;
      for (int row = 0; row < kSide; ++row)
        for (int column = 0; column < kSide; ++column) {
          const auto pixel = static_cast<std::size_t>(row * kSide + column);
          if (data.hits.offset[pixel] == data.hits.offset[pixel + 1]) continue;
          const double expected = averaged_board(kSide, column, row, about);
          error += std::abs(static_cast<double>(image.display[pixel].r) - expected);
          none += std::abs(averaged_board(kSide, column, row, {}) - expected);
        }
      const auto hits = static_cast<double>(data.hits.count());
      EXPECT_GT(none / hits, 0.1);    // the rotation is seen
      EXPECT_LT(error / hits, 0.05);  // edges: a box in (u, v) is no box of the pixel
    }
}

TEST(RotatedBoard, about_z_is_exact_and_the_same_as_an_offset) {
  for (const bool recorded : {false, true}) {
    const Dataset data = ball(40, recorded);
    const Image turned = picture(data, board(R"(,"rotate_deg":[0,0,90])"));
    EXPECT_EQ(turned.exposed, picture(data, board(R"(,"offset":[-0.25,0])")).exposed);
    EXPECT_EQ(turned.exposed,
              picture(data, board(R"(,"rotate_deg":{"axis":[0,0,-2],"angle_deg":270})")).exposed);
    EXPECT_EQ(turned.exposed, picture(data, board(R"(,"rotate_deg":[0,0,3690])")).exposed);
    EXPECT_NE(turned.exposed, picture(data, board("")).exposed);
  }
}

TEST(RotatedBoard, is_the_same_with_every_instruction_set_and_without_numbers) {
  constexpr float kNan = std::numeric_limits<float>::quiet_NaN(),
                  kInf = std::numeric_limits<float>::infinity();
  Dataset data = ball(40, true);
  const std::vector<float> odd = {kNan, kInf, -kInf, 3e38f, -1e7f, 1e-40f};
  for (std::size_t i = 0; i < odd.size(); ++i) {
    data.hits.u[3 * i] = odd[i];
    data.hits.v[5 * i + 1] = odd[i];
    data.hits.duv[i % 4][7 * i] = odd[i];
  }
  for (const char* rest : {R"(,"rotate_deg":[10,20,30])", R"(,"rotate_deg":[0,0,30],"scale":[0,1e4])",
                           R"(,"rotate_deg":[1e9,0,0],"offset":[-1e4,1e4])"}) {
    Image first;
    for (const Kernel* kernel : kernels()) {
      Renderer renderer(data, *kernel);
      const Image image = renderer.render(look_of(board(rest), renderer.manifest()));
      for (const Rgb c : image.exposed) ASSERT_TRUE(c.r >= 0 && c.r <= 1) << rest << " " << c.r;
      if (kernel == kernels().front()) first = image;
      EXPECT_EQ(image.exposed, first.exposed) << kernel->isa;
    }
  }
}

TEST(RotatedBoard, that_makes_no_sense_is_refused) {
  for (const auto& [rest, place] :
       {std::pair{R"("rotate_deg":[1,2])", "rotate_deg:"},
        {R"("rotate_deg":30)", "rotate_deg:"},
        {R"("rotate_deg":[1,2,"x"])", "rotate_deg/2:"},
        {R"("rotate_deg":[1,2,1e10])", "rotate_deg/2:"},
        {R"("rotate_deg":{"axis":[0,0,0],"angle_deg":3})", "rotate_deg/axis:"},
        {R"("rotate_deg":{"axis":[0,0,1]})", "rotate_deg/angle_deg:"},
        {R"("rotate_deg":{"axis":[0,0,1],"angle_deg":3,"deg":1})", "rotate_deg/deg:"},
        {R"("offset":[0,{"keyframes":[[0,2e4]],"by":"t"}])", "offset/1/keyframes/0:"},
        {R"("offset":[0,{"keyframes":[[0,1]],"by":"frame"}])", "offset/1/by:"},
        {R"("offset":[0,{"keyframes":[[1e300,1]],"by":"t"}])", "offset/1/keyframes/0:"}}) {
    const std::string found =
        complaint([&] { look_of(board("," + std::string(rest)), ball(4, false).manifest); });
    EXPECT_NE(found.find("look.json: /objects/earth/texture/" + std::string(place)), std::string::npos)
        << rest << " -> " << found;
  }
  const std::string color =
      R"({"objects":{"earth":{"texture":{"type":"color","rgb":[1,1,1],"offset":[0,0]}}}})";
  EXPECT_NE(complaint([&] { look_of(color, ball(4, false).manifest); }).find("/texture/offset:"),
            std::string::npos);
}

}  // namespace
}  // namespace nullcone::postrender
