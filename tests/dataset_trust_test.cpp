// Files that vouch for themselves: every flipped bit is seen, old formats stay readable, windows and partial
// files.
#include <algorithm>
#include <random>

#include "core/base/json.h"
#include "tests/dataset_fixture.h"

namespace nullcone::test {
namespace {

/// What is wrong with the file; empty if it is whole and true.
std::string fault_of_file(const std::string& path) {
  try {
    const auto faults = verify_file(path);
    return faults.empty() ? "" : faults.front();
  } catch (const InputError& error) {
    return error.what();
  }
}

TEST_F(DatasetFile, EveryFlippedBitIsSeen) {
  const std::string bytes = whole_file(kAllChannels);
  EXPECT_EQ(fault_of_file(path), "");
  std::mt19937_64 random(5);
  const std::string place = folder / "b.exr";
  std::size_t header = bytes.find("nullconeSha256"), seen = 0;
  for (int i = 0; i < 1000; ++i) {
    // Some in the first header, where the hash itself stands; most anywhere.
    const std::size_t at = i % 4 == 0 ? (header + random() % 128) : random() % bytes.size();
    std::string wrong = bytes;
    wrong[at] = static_cast<char>(wrong[at] ^ (1 << random() % 8));
    fs::remove(place);
    std::ofstream(place, std::ios::binary) << wrong;
    const bool found = !fault_of_file(place).empty();
    EXPECT_TRUE(found) << "byte " << at << " of " << bytes.size();
    seen += found;
  }
  EXPECT_EQ(seen, 1000u);
}

TEST_F(DatasetFile, WhatStandsBehindTheEndIsSeen) {
  const std::string bytes = whole_file();
  std::ofstream(path, std::ios::binary | std::ios::app) << '\0';
  EXPECT_NE(fault_of_file(path), "");
  std::ofstream(path, std::ios::binary) << bytes;
  EXPECT_EQ(fault_of_file(path), "");
}

TEST(Format1, StaysReadable) {
  const std::string path = std::string(NULLCONE_TEST_DATA) + "/format1.exr";
  EXPECT_EQ(verify_file(path), std::vector<std::string>{});
  const Dataset dataset = read_dataset(path);
  const Manifest& m = dataset.manifest;
  EXPECT_EQ(m.format, 1);
  EXPECT_EQ(m.width, 66);
  EXPECT_EQ(m.height, 20);
  EXPECT_EQ(m.lines, 20);
  EXPECT_EQ(m.traced_lines, 20);
  EXPECT_EQ(m.channels, kDefaultChannels);
  ASSERT_EQ(dataset.hits.count(), 121u);
  EXPECT_EQ(m.hits_sha256, "e51caea9c800dcf3eb929a77f7ec1602bcef238c3aa51f4474d626d1664e5053");
  EXPECT_EQ(m.rays_sha256, "e5154f353f61504d300a4e3034eb77773e5dbef3497c188cf680998c7a4f4b35");
  EXPECT_EQ(*std::ranges::min_element(dataset.hits.shift), 0.4282614588737488F);
  EXPECT_EQ(*std::ranges::max_element(dataset.hits.Z), 7.57723331451416F);
  Dataset damaged = dataset;
  damaged.hits.tau[60] += 1e-6F;
  EXPECT_FALSE(verify(damaged).empty());
}

TEST(Format2, StaysReadableAndIsWrittenWhereThereAreNoLamps) {
  const std::string path = std::string(NULLCONE_TEST_DATA) + "/format2.exr";
  EXPECT_EQ(verify_file(path), std::vector<std::string>{});
  const Dataset dataset = read_dataset(path);
  EXPECT_EQ(dataset.manifest.format, 2);
  EXPECT_EQ(dataset.hits.count(), 22u);
  EXPECT_EQ(dataset.manifest.hits_sha256, "9c0218ebe538fff3229fb4b2a89e49502c588df949c2bf9986f6e253a7a5cf39");
  EXPECT_EQ(dataset.manifest.rays_sha256, "9d97c146dae72d976023d2f4d75abed4e2357645fc36347e9b4b56dcf746f6ff");
  EXPECT_EQ(*std::ranges::max_element(dataset.hits.P[0]), 2.3816463947296143F);
  // What it was written from is written the same way again.
  EXPECT_NE(slurp(path).find(manifest_to_json(dataset.manifest)), std::string::npos);
  EXPECT_EQ(sample().manifest.format, 2);
}

/// The lines from `first` on as a window of their own.
Dataset window(const Dataset& whole, int first, int lines) {
  Dataset out;
  out.manifest = whole.manifest;
  out.manifest.first_line = first;
  out.manifest.lines = out.manifest.traced_lines = lines;
  out.hits = empty_like(whole.hits);
  out.append(whole.band(first, lines));
  fingerprint(out);
  return out;
}

/// `sample()` on top of itself, so that there is more than one band.
Dataset tall_sample() {
  const Dataset once = sample(true, kAllChannels);
  Dataset out = once;
  for (int i = 1; i < 10; ++i) out.append(once.band(0, once.manifest.lines));
  out.manifest.set_size(6, 40);
  fingerprint(out);
  return out;
}

TEST_F(DatasetFile, AWindowIsADatasetOfItsOwn) {
  const Dataset whole = tall_sample();
  const Dataset lower = window(whole, 16, 24);
  write(path, lower);
  EXPECT_EQ(fault_of_file(path), "");
  DatasetReader reader(path);
  EXPECT_EQ(reader.manifest().first_line, 16);
  const Band last = reader.band(16, 8);
  EXPECT_EQ(last.hits.offset, whole.band(32, 8).hits.offset);
  EXPECT_EQ(last.rays.steps, whole.band(32, 8).rays.steps);
  EXPECT_EQ(last.hits.id, whole.band(32, 8).hits.id);
  EXPECT_EQ(last.hits.light.at(3).tau, whole.band(32, 8).hits.light.at(3).tau);
}

TEST_F(DatasetFile, OnlyTheChannelsThatAreWantedAreRead) {
  const Dataset whole = tall_sample();
  write(path, whole);
  const Dataset some = read_dataset(path, ChannelSet::of("shift") | ChannelSet::of("id"));
  EXPECT_EQ(some.hits.shift, whole.hits.shift);
  EXPECT_EQ(some.hits.id, whole.hits.id);
  EXPECT_EQ(some.hits.offset, whole.hits.offset);
  EXPECT_TRUE(some.hits.Z.empty());
  EXPECT_TRUE(some.hits.light.empty());
  EXPECT_FALSE(some.hits.channels.has("t"));
}

TEST_F(DatasetFile, APartialFileIsWholeAndSaysWhatIsMissing) {
  const Dataset whole = tall_sample();
  {
    DatasetWriter writer(path, whole.manifest);
    writer.add(whole.band(0, 16), Preview(4 * 6 * 16));
    writer.finish_partial(folder / "a.partial.exr", {1, 2});
  }
  EXPECT_EQ(listing(), std::vector<std::string>{"a.partial.exr"});
  const std::string place = folder / "a.partial.exr";
  EXPECT_EQ(fault_of_file(place), "");
  const Dataset found = read_dataset(place);
  EXPECT_TRUE(found.manifest.partial());
  EXPECT_EQ(found.manifest.traced_lines, 16);
  EXPECT_EQ(found.hits.count(), whole.band(0, 16).hits.count());
  EXPECT_EQ(found.hits.light.at(1).E, whole.band(0, 16).hits.light.at(1).E);
  EXPECT_EQ(found.rays.status[6 * 16 - 1], whole.rays.status[6 * 16 - 1]);
  EXPECT_EQ(found.rays.status[6 * 16], static_cast<std::uint32_t>(Status::not_traced));
}

TEST_F(DatasetFile, AWriterThatIsGivenUpLeavesNothing) {
  const Dataset whole = tall_sample();
  {
    DatasetWriter writer(path, whole.manifest);
    writer.add(whole.band(0, 16), Preview(4 * 6 * 16));
    EXPECT_THROW(writer.finish({}), WorkError);
    EXPECT_THROW(writer.add(whole.band(0, 24), Preview(4 * 6 * 24)), WorkError);
  }
  EXPECT_EQ(listing(), std::vector<std::string>{});
}

TEST_F(DatasetFile, FingerprintsDoNotDependOnHowAPictureIsCut) {
  const Dataset whole = tall_sample();
  PayloadHash hash;
  for (const int first : {0, 16}) {
    const Dataset part = window(whole, first, first == 0 ? 16 : 24);
    for_each_band(part.manifest.lines, [&](int line, int lines) { hash.add(part.band(line, lines)); });
  }
  EXPECT_EQ(hash.hits(), whole.manifest.hits_sha256);
  EXPECT_EQ(hash.rays(), whole.manifest.rays_sha256);
}

TEST_F(DatasetFile, SamplesStandInAGridOfTheirOwn) {
  Dataset sampled = sample(true, kDefaultChannels | ChannelSet::of("sample"));
  sampled.manifest.samples = 2;
  for_each_channel([](const ChannelInfo&, auto& column) { column.resize(4 * column.size(), column[3]); },
                   sampled.rays);
  for (std::size_t i = 0; i < sampled.hits.count(); ++i)
    sampled.hits.sample[i] = static_cast<std::uint32_t>(i % 4);
  fingerprint(sampled);
  write(path, sampled);
  EXPECT_EQ(fault_of_file(path), "");
  EXPECT_EQ(read_dataset(path).hits.sample, sampled.hits.sample);
  sampled.hits.sample[1] = 4;
  fingerprint(sampled);
  EXPECT_FALSE(verify(sampled).empty());
}

}  // namespace
}  // namespace nullcone::test
