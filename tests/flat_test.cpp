// The flat companion of datasets that are made by hand: which crossing and which ray stand for a pixel.
#include "apps/flat.h"

#include <ImfFrameBuffer.h>
#include <ImfHeader.h>
#include <ImfInputFile.h>
#include <gtest/gtest.h>

#include <bit>

#include "apps/cryptomatte.h"
#include "tests/dataset_fixture.h"

namespace nullcone::test {
namespace {

/// One channel of a flat file, row by row.
template <class T>
std::vector<T> column(const std::string& path, const std::string& name) {
  constexpr Imf::PixelType kType = std::is_same_v<T, half>    ? Imf::HALF
                                   : std::is_same_v<T, float> ? Imf::FLOAT
                                                              : Imf::UINT;
  Imf::InputFile file(path.c_str());
  const Imath::Box2i window = file.header().dataWindow();
  std::vector<T> out(static_cast<std::size_t>((window.size().x + 1) * (window.size().y + 1)));
  Imf::FrameBuffer buffer;
  buffer.insert(name, Imf::Slice::Make(kType, out.data(), window));
  file.setFrameBuffer(buffer);
  file.readPixels(window.min.y, window.max.y);
  return out;
}

class FlatFile : public DatasetFile {
 protected:
  std::string flat = folder / "flat.exr";

  void flatten(Dataset dataset) {
    fingerprint(dataset);
    write(path, dataset);
    write_flat(path, flat);
  }
};

/// A picture of one pixel with 2 x 2 rays.
Dataset one_pixel() {
  Dataset out = sample(false, kDefaultChannels | ChannelSet::of("sample"));
  out.manifest.set_size(1, 1);
  out.manifest.samples = 2;
  out.hits.offset = {0, 0};
  out.rays = {{0, 0, 0, 0}, {1, 2, 3, 4}, {0, 0, 0, 0}, {0, 0, 0, 0}};
  return out;
}

void add_crossing(Dataset& to, std::uint32_t ray, float Z, float A, std::uint32_t id) {
  for_each_channel([](const ChannelInfo&, auto& values) { values.push_back(0); }, to.hits);
  to.hits.sample.back() = ray, to.hits.Z.back() = Z, to.hits.A.back() = A, to.hits.id.back() = id;
  ++to.hits.offset.back();
}

TEST_F(FlatFile, TakesTheFirstOpaqueCrossingElseTheNearest) {
  const Dataset dataset = sample();
  flatten(dataset);
  const auto Z = column<float>(flat, "Z"), t = column<float>(flat, "t");
  const auto order = column<std::uint32_t>(flat, "order");
  int opaque_behind = 0, sheer = 0;
  for (std::size_t i = 0; i < dataset.pixels(); ++i) {
    const std::uint64_t first = dataset.hits.offset[i], end = dataset.hits.offset[i + 1];
    if (first == end) {
      EXPECT_EQ(Z[i], INFINITY);
      EXPECT_EQ(t[i], 0);
      continue;
    }
    std::uint64_t k = first;
    while (k < end && dataset.hits.A[k] < 1) ++k;
    opaque_behind += k > first && k < end, sheer += k == end;
    if (k == end) k = first;
    EXPECT_EQ(Z[i], dataset.hits.Z[k]) << i;
    EXPECT_EQ(t[i], dataset.hits.t[k]) << i;
    EXPECT_EQ(order[i], dataset.hits.order[k]) << i;
  }
  EXPECT_GT(opaque_behind, 0);
  EXPECT_GT(sheer, 0);
}

TEST_F(FlatFile, LooksAlongTheRayNearestTheCentre) {
  Dataset dataset = one_pixel();
  add_crossing(dataset, 3, 1, 1, 1);
  add_crossing(dataset, 0, 2, 0.25F, 1);
  add_crossing(dataset, 0, 3, 1, 2);
  flatten(dataset);
  EXPECT_EQ(column<float>(flat, "Z"), std::vector<float>{3});
  EXPECT_EQ(column<std::uint32_t>(flat, "id"), std::vector<std::uint32_t>{2});
  EXPECT_EQ(column<half>(flat, "A"), std::vector<half>{half(1)});
  EXPECT_EQ(column<float>(flat, "CryptoObject00.G"), std::vector<float>{0.3125F});  // earth: (1 + 1/4)/4
  EXPECT_EQ(column<float>(flat, "CryptoObject00.A"), std::vector<float>{0.1875F});  // moon: 3/16
  const auto hash = column<float>(flat, "CryptoObject00.R");
  EXPECT_EQ(std::bit_cast<std::uint32_t>(hash[0]), cryptomatte_hash("earth"));
}

TEST_F(FlatFile, ShowsTheWorstRay) {
  Dataset dataset = one_pixel();
  flatten(dataset);
  EXPECT_EQ(column<std::uint32_t>(flat, "steps"), std::vector<std::uint32_t>{1});  // of equals: the centre's
  dataset.rays.error = {1, 2, 0, 0}, dataset.rays.drift = {0, 7, 0, 9};
  flatten(dataset);
  EXPECT_EQ(column<std::uint32_t>(flat, "steps"), std::vector<std::uint32_t>{2});
  EXPECT_EQ(column<float>(flat, "drift"), std::vector<float>{7});
  dataset.rays.status[2] = static_cast<std::uint32_t>(Status::not_finite);
  flatten(dataset);
  EXPECT_EQ(column<std::uint32_t>(flat, "steps"), std::vector<std::uint32_t>{3});
  EXPECT_EQ(column<float>(flat, "error"), std::vector<float>{0});
}

TEST_F(FlatFile, HoldsNoNaN) {
  Dataset dataset = one_pixel();
  add_crossing(dataset, 0, 1, 1, 1);
  dataset.hits.t[0] = dataset.hits.mu[0] = dataset.rays.drift[0] = NAN;
  flatten(dataset);
  EXPECT_EQ(column<float>(flat, "t"), std::vector<float>{0});
  EXPECT_EQ(column<float>(flat, "mu"), std::vector<float>{0});
  EXPECT_EQ(column<float>(flat, "drift"), std::vector<float>{0});
  EXPECT_FALSE(std::isnan(float(column<half>(flat, "R")[0])));
}

TEST_F(FlatFile, KeepsTheWindow) {
  Dataset dataset = sample();
  dataset.manifest.height = 100, dataset.manifest.first_line = 32;
  flatten(dataset);
  const Imf::InputFile file(flat.c_str());
  EXPECT_EQ(file.header().dataWindow(), Imath::Box2i({0, 32}, {5, 35}));
  EXPECT_EQ(file.header().displayWindow(), Imath::Box2i({0, 0}, {5, 99}));
}

TEST_F(FlatFile, RefusesToReplaceItsDataset) {
  write(path, sample());
  const std::string before = slurp(path);
  EXPECT_THROW(write_flat(path, path), InputError);
  EXPECT_EQ(slurp(path), before);
  EXPECT_EQ(listing(), std::vector<std::string>{"a.exr"});
}

}  // namespace
}  // namespace nullcone::test
