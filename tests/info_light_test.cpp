// What nullcone-info tells of the light of lamps, and the flat companion with it.
#include <ImfChannelList.h>
#include <ImfFrameBuffer.h>
#include <ImfHeader.h>
#include <ImfInputFile.h>

#include "apps/flat.h"
#include "apps/info.h"
#include "tests/dataset_fixture.h"

namespace nullcone::test {
namespace {

/// Two pixels with a crossing each; in the first light comes from "sun" along two paths and from "moon" along
/// one, in the second along none.
Dataset lit() {
  Dataset out = sample(false, kLeastChannels);
  Manifest& m = out.manifest;
  m.set_size(2, 1);
  m.set_lights({{"sun", 0.25}, {"moon", -3}}, 2);
  out.hits = empty_hits(m);
  out.hits.offset = {0, 1, 2};
  out.hits.Z = {1, 2}, out.hits.A = {1, 1}, out.hits.id = {1, 2};
  out.hits.light[0] = {out.hits.light[0].prefix, {8, 0}, {2, 1}, {-1, 0}, {-1.5F, 0}};
  out.hits.light[1] = {out.hits.light[1].prefix, {4, 0}, {3, 1}, {-2, 0}, {-2.5F, 0}};
  out.hits.light[2] = {out.hits.light[2].prefix, {0.5F, 0}, {0.25F, 1}, {-5, 0}, {7, 0}};
  out.hits.light[3] = {out.hits.light[3].prefix, {0, 0}, {1, 1}, {0, 0}, {0, 0}};
  out.rays = {{0, 0}, {1, 1}, {0, 0}, {0, 0}};
  fingerprint(out);
  return out;
}

TEST_F(DatasetFile, InfoListsLampsAndTheRangesOfTheirLight) {
  write(path, lit());
  EXPECT_EQ(verify_file(path), std::vector<std::string>{});
  DatasetReader reader(path);
  const Report report = summary(reader, 0);
  EXPECT_EQ(
      report["lights"].dump(),
      R"([{"name":"sun","tau_origin":0.25,"lit":2,"capped":0},{"name":"moon","tau_origin":-3.0,"lit":1,"capped":0}])");
  EXPECT_EQ(report["light_paths"], 2);
  EXPECT_EQ(report["format"], 3);
  EXPECT_EQ(report["channels"].size(), 3u + 16);
  const Report& ranges = report["hits"]["ranges"];
  EXPECT_EQ(ranges["light.sun.1.E"].dump(), "[0.0,4.0]");
  EXPECT_EQ(ranges["light.sun.1.shift"].dump(), "[3.0,3.0]");
  EXPECT_EQ(ranges["light.sun.0.t"].dump(), "[-1.0,-1.0]");
  EXPECT_EQ(ranges["light.moon.0.tau"].dump(), "[7.0,7.0]");
  EXPECT_EQ(ranges["light.moon.1.E"].dump(), "[0.0,0.0]");
  EXPECT_FALSE(ranges.contains("light.moon.1.shift"));  // of no light
}

TEST_F(DatasetFile, InfoShowsTheLightOfAPixelsCrossings) {
  write(path, lit());
  DatasetReader reader(path);
  EXPECT_EQ(
      pixel_records(reader, 0, 0)["hits"].dump(),
      R"([{"Z":1.0,"A":1.0,"object":"earth","lights":{"sun":[{"E":8.0,"shift":2.0,"t":-1.0,"tau":-1.5},)"
      R"({"E":4.0,"shift":3.0,"t":-2.0,"tau":-2.5}],"moon":[{"E":0.5,"shift":0.25,"t":-5.0,"tau":7.0}]}}])");
  EXPECT_EQ(pixel_records(reader, 1, 0)["hits"].dump(),
            R"([{"Z":2.0,"A":1.0,"object":"moon","lights":{"sun":[],"moon":[]}}])");
}

TEST_F(DatasetFile, InfoSaysNothingOfLightWithoutLamps) {
  write(path, sample());
  DatasetReader reader(path);
  EXPECT_EQ(summary(reader, 0)["lights"].dump(), "[]");
  EXPECT_FALSE(pixel_records(reader, 1, 0)["hits"].dump().find("lights") != std::string::npos);
}

TEST_F(DatasetFile, TheFlatCompanionHasTheLight) {
  const std::string flat = folder / "flat.exr";
  write(path, lit());
  write_flat(path, flat);
  Imf::InputFile file(flat.c_str());
  float found[2] = {};
  EXPECT_NE(file.header().channels().findChannel("light.moon.1.tau"), nullptr);
  Imf::FrameBuffer buffer;
  buffer.insert("light.sun.1.E", Imf::Slice(Imf::FLOAT, reinterpret_cast<char*>(found), 4, 8));
  file.setFrameBuffer(buffer);
  file.readPixels(0, 0);
  EXPECT_EQ(found[0], 4);
  EXPECT_EQ(found[1], 0);
}

}  // namespace
}  // namespace nullcone::test
