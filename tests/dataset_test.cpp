// Dataset files that are well, and places where none can be written.
#include <algorithm>
#include <bit>
#include <cstring>
#include <nlohmann/json.hpp>
#include <span>

#include "core/trace/trace_scene.h"
#include "metrics/registry.h"
#include "tests/dataset_fixture.h"

namespace nullcone::test {
namespace {

template <class Table>
void expect_same_bits(const Table& a, const Table& b) {
  for_each_channel(
      [](const ChannelInfo& channel, const auto& column, const auto& other) {
        const auto bits = std::as_bytes(std::span(column)), other_bits = std::as_bytes(std::span(other));
        EXPECT_TRUE(std::ranges::equal(bits, other_bits)) << channel.name;
      },
      a, b);
}

TEST_F(DatasetFile, RoundTripKeepsEveryBit) {
  for (const bool with_hits : {true, false}) {
    const Dataset written = sample(with_hits, with_hits ? kAllChannels : kLeastChannels);
    write(path, written);
    const Dataset read = read_dataset(path);
    EXPECT_EQ(read.hits.offset, written.hits.offset);
    EXPECT_EQ(read.hits.channels, written.hits.channels);
    expect_same_bits(read.hits, written.hits);
    expect_same_bits(read.rays, written.rays);
    EXPECT_EQ(manifest_to_json(read.manifest), manifest_to_json(written.manifest));
    EXPECT_EQ(manifest_to_json(read_manifest(path)), manifest_to_json(written.manifest));
    EXPECT_EQ(read.manifest.objects, written.manifest.objects);
    EXPECT_EQ(verify(read), std::vector<std::string>{});
    EXPECT_EQ(listing(), std::vector<std::string>{"a.exr"});
  }
}

template <class Table>
void expect_every_flip_is_seen(Dataset& dataset, Table& table) {
  const auto flip = [&](const ChannelInfo& channel, auto& column) {
    for (const std::size_t at : {std::size_t{0}, column.size() / 2, column.size() - 1})
      for (const std::size_t bit : {0u, 13u, 31u}) {
        const auto right = column[at];
        column[at] = std::bit_cast<std::remove_cvref_t<decltype(right)>>(std::bit_cast<std::uint32_t>(right) ^
                                                                         1U << bit);
        EXPECT_FALSE(verify(dataset).empty()) << channel.name << ", entry " << at << ", bit " << bit;
        column[at] = right;
      }
    EXPECT_TRUE(verify(dataset).empty()) << channel.name;
  };
  for_each_channel(flip, table);
}

TEST(Verify, SeesAFlippedBitInEveryChannel) {
  Dataset dataset = sample(true, kAllChannels);
  expect_every_flip_is_seen(dataset, dataset.hits);
  expect_every_flip_is_seen(dataset, dataset.rays);
  ++dataset.hits.offset[1];  // a crossing that changed its pixel
  EXPECT_FALSE(verify(dataset).empty());
}

TEST(Verify, SeesAWrongShapeAndAForgedManifest) {
  void (*const changes[])(Dataset&) = {
      [](Dataset& d) { d.manifest.width = 7; },
      [](Dataset& d) { d.hits.mu.pop_back(); },
      [](Dataset& d) { d.rays.steps.push_back(1); },
      [](Dataset& d) { d.hits.offset.clear(); },
      [](Dataset& d) { d.hits.offset[1] = 1U << 30; },
      [](Dataset& d) { std::swap(d.hits.offset[1], d.hits.offset[2]), fingerprint(d); },
      [](Dataset& d) { d.hits.id[0] = 0, fingerprint(d); },
      [](Dataset& d) { d.hits.id[0] = 3, fingerprint(d); },
      [](Dataset& d) { std::swap(d.hits.Z[0], d.hits.Z[1]), fingerprint(d); },
      [](Dataset& d) { d.manifest.scene[5] = 'E'; },
      [](Dataset& d) { d.hits.channels.bits &= ~ChannelSet::of("mu").bits, fingerprint(d); },
      [](Dataset& d) { d.manifest.scene_sha256[0] ^= 1; },
  };
  for (std::size_t i = 0; i < std::size(changes); ++i) {
    Dataset dataset = sample();
    changes[i](dataset);
    EXPECT_FALSE(verify(dataset).empty()) << "change " << i;
  }
}

TEST_F(DatasetFile, WhereNothingCanBeWrittenNothingIsLeft) {
  for (const std::string place : {"/proc/a.exr", "/nonexistent/a.exr", "/dev/full/a.exr"}) {
    EXPECT_THROW(check_place(place), WorkError) << place;
    EXPECT_THROW(write(place, sample()), WorkError) << place;
  }
  EXPECT_NO_THROW(check_place(path));
  fs::create_directories(folder / "folder.exr" / "x");
  EXPECT_THROW(write(folder / "folder.exr", sample()), WorkError);
  EXPECT_EQ(listing(), std::vector<std::string>{"folder.exr"});
}

Dataset trace_dataset(const std::string& text, int threads) {
  const Scene scene = read_scene(text, "scene", metric_descriptions());
  return trace_scene(find_spacetime(scene.metric), scene, "scene", threads);
}

TEST_F(DatasetFile, TracedAgainFromItsHeaderItIsTheSame) {
  nlohmann::json scene = nlohmann::json::parse(std::ifstream(NULLCONE_SOURCE "/scenes/goedel_earth.json"));
  scene["camera"]["resolution"] = {132, 50};  // four bands, the last one short
  const Dataset one = trace_dataset(scene.dump(), 1), two = trace_dataset(scene.dump(), 2);
  EXPECT_GT(one.hits.count(), 100u);
  EXPECT_EQ(one.manifest.hits_sha256, two.manifest.hits_sha256);
  EXPECT_EQ(one.manifest.rays_sha256, two.manifest.rays_sha256);
  write(path, one);
  const Dataset again = trace_dataset(read_manifest(path).scene, 2);
  EXPECT_EQ(again.manifest.hits_sha256, one.manifest.hits_sha256);
  EXPECT_EQ(again.manifest.scene_sha256, one.manifest.scene_sha256);
  EXPECT_EQ(verify(read_dataset(path)), std::vector<std::string>{});
}

}  // namespace
}  // namespace nullcone::test
