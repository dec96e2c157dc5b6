// What nullcone-info reckons: quantiles, the order of the worst rays, and what Cryptomatte says of a pixel.
#include <gtest/gtest.h>

#include <bit>
#include <cmath>

#include "apps/cryptomatte.h"
#include "apps/info_quality.h"
#include "core/base/error.h"

namespace nullcone {
namespace {

TEST(Cryptomatte, HashesPublishedVectors) {
  EXPECT_EQ(cryptomatte_hash("hello"), 0x248bfa47U);
  EXPECT_EQ(cryptomatte_hash("hello, world"), 0x149bbb7fU);
  EXPECT_EQ(cryptomatte_hash("The quick brown fox jumps over the lazy dog"), 0x2e4ff723U);
  EXPECT_EQ(cryptomatte_hash(""), 0x00800000U);  // the hash is 0: its exponent too
}

TEST(Cryptomatte, HashesAreNormalFloats) {
  int flipped = 0;
  for (int i = 0; i < 20'000; ++i) {
    const float id = std::bit_cast<float>(cryptomatte_hash("object" + std::to_string(i)));
    EXPECT_TRUE(std::isnormal(id)) << i;
    const std::uint32_t exponent = std::bit_cast<std::uint32_t>(id) >> 23 & 255;
    flipped += exponent == 1 || exponent == 254;
  }
  EXPECT_GT(flipped, 200);  // of 20,000, 4 in 256 are expected: two exponents by nature, two by the flip
}

TEST(Cryptomatte, NamesItsLayer) {
  const auto attributes = cryptomatte_attributes("CryptoObject", {{"hello", 0}});
  const std::vector<std::pair<std::string, std::string>> expected = {
      {"cryptomatte/3ae39a5/name", "CryptoObject"},
      {"cryptomatte/3ae39a5/hash", "MurmurHash3_32"},
      {"cryptomatte/3ae39a5/conversion", "uint32_to_float32"},
      {"cryptomatte/3ae39a5/manifest", R"({"hello":"248bfa47"})"}};
  EXPECT_EQ(attributes, expected);
}

/// Crossings {sample, id, A} of one pixel, nearest first.
struct Crossing {
  std::uint32_t sample, id;
  float A;
};
std::vector<std::pair<std::uint32_t, double>> covered(int samples, const std::vector<Crossing>& crossings) {
  Manifest manifest;
  manifest.samples = samples;
  manifest.channels = manifest.channels | ChannelSet::of("sample");
  manifest.objects = {{"a", 0}, {"b", 0}, {"c", 0}};
  Hits hits;
  for (const Crossing& crossing : crossings) {
    hits.sample.push_back(crossing.sample);
    hits.id.push_back(crossing.id);
    hits.A.push_back(crossing.A);
  }
  hits.offset.push_back(crossings.size());
  std::vector<std::pair<std::uint32_t, double>> out;
  Coverages coverages(manifest, "a.exr");
  for (const Coverage& coverage : coverages.of(hits, 0)) out.emplace_back(coverage.id, coverage.share);
  return out;
}
using Shares = std::vector<std::pair<std::uint32_t, double>>;

TEST(Cryptomatte, FrontHidesBack) {
  EXPECT_EQ(covered(1, {}), Shares());
  EXPECT_EQ(covered(1, {{0, 1, 0.25F}, {0, 2, 0.5F}, {0, 1, 1}, {0, 3, 1}}),
            (Shares{{1, 0.625}, {2, 0.375}}));
}

TEST(Cryptomatte, EveryRayWeighsTheSame) {
  // Ray 0: c; ray 1: a half before b; ray 2: nothing; ray 3: b. The nearest of all does not hide other rays.
  EXPECT_EQ(covered(2, {{1, 1, 0.5F}, {0, 3, 1}, {3, 2, 1}, {1, 2, 1}}),
            (Shares{{2, 0.375}, {3, 0.25}, {1, 0.125}}));
}

TEST(Cryptomatte, SkipsWhatIsNoObject) {
  EXPECT_EQ(covered(1, {{0, 0, 1}, {0, 4, 1}, {1, 1, 1}, {0, 2, NAN}, {0, 3, 7}}), (Shares{{3, 1}}));
}

TEST(Cryptomatte, RefusesRaysThatCannotBeToldApart) {
  Manifest manifest;
  manifest.samples = 2;
  EXPECT_THROW(Coverages(manifest, "a.exr"), InputError);
}

TEST(LogHistogram, IsExactBelow256AndCloseElsewhere) {
  LogHistogram whole, small;
  EXPECT_EQ(whole.quantile(0.5), 0);
  for (int i = 0; i <= 200; ++i) whole.add(i);
  EXPECT_EQ(whole.quantile(0.5), 100);
  EXPECT_EQ(whole.quantile(0.99), 198);
  EXPECT_EQ(whole.max(), 200);
  for (int i = 1; i <= 1000; ++i) small.add(1e-9 * i);
  EXPECT_LE(small.quantile(0.5), 5.00001e-7);  // float rounds by 6e-8 of it
  EXPECT_GE(small.quantile(0.5), 5e-7 * (1 - LogHistogram::kResolution));
}

TEST(LogHistogram, TakesWhatFilesMayHold) {
  LogHistogram of;
  of.add(NAN), of.add(-1);
  EXPECT_EQ(of.max(), 0);
  of.add(-0.0), of.add(0), of.add(INFINITY);
  EXPECT_EQ(of.quantile(0.5), 0);
  EXPECT_EQ(of.quantile(0.99), INFINITY);
}

TEST(Quality, ListsDoubtfulRaysFirst) {
  Manifest manifest;
  manifest.set_size(2, 4);
  manifest.first_line = 32, manifest.lines = 2;
  manifest.samples = 2;
  Quality quality(manifest, 4);
  Rays rays;
  rays.status.assign(16, 0), rays.steps.assign(16, 3), rays.error.assign(16, 0), rays.drift.assign(16, 0);
  rays.error[2] = 1e-3F, rays.error[3] = 1e-5F, rays.error[5] = NAN, rays.error[7] = 1e-4F;
  rays.status[13] = static_cast<std::uint32_t>(Status::step_limit);
  rays.status[15] = static_cast<std::uint32_t>(Status::not_traced), rays.error[15] = 1;
  quality.add(rays);
  const Report report = quality.report();
  EXPECT_EQ(report["doubtful"], 1);
  EXPECT_EQ(report["error"]["max"], 1e-3F);
  EXPECT_EQ(report["worst"].size(), 4U);
  EXPECT_EQ(report["worst"][0]["pixel"].dump() + report["worst"][0]["sample"].dump(), "[0,33]3");
  EXPECT_EQ(report["worst"][0]["status"], "step_limit");
  EXPECT_EQ(report["worst"][1]["pixel"].dump() + report["worst"][1]["sample"].dump(), "[0,32]3");  // NaN
  EXPECT_EQ(report["worst"][2]["pixel"].dump() + report["worst"][2]["sample"].dump(), "[1,32]0");
  EXPECT_EQ(report["worst"][3]["error"], 1e-4F);
}

}  // namespace
}  // namespace nullcone
