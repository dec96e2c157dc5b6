// Light of lamps on its way from tracers through bands, manifests and files.
#include <nlohmann/json.hpp>

#include "core/trace/trace_scene.h"
#include "metrics/registry.h"
#include "tests/dataset_fixture.h"

namespace nullcone::test {
namespace {

using nlohmann::json;

/// 5 x 20 pixels of 2 x 2 rays in two bands, with two lamps of three paths each.
Scene lit_scene() {
  const char* text = R"({"metric": {"name": "minkowski"}, "observer": {"event": [7, 0, 0, 0]},
    "camera": {"type": "sphere", "resolution": [5, 20], "samples": 2}, "records": {"channels": ["uv"]},
    "objects": [{"name": "ball", "shape": {"type": "sphere", "radius": 1},
                 "placing": {"type": "coordinate", "centre": [3, 0, 0]}}],
    "lights": {"paths": 3, "windings": 2, "shadows": false, "cap": 4,
               "lamps": [{"name": "sun", "worldline": {"type": "static", "event": [0, 1, 2, 3]}},
                         {"name": "moon", "worldline": {"type": "static", "event": [0, 1, 2, 3]}}]}})";
  return read_scene(text, "s", metric_descriptions());
}

/// What stands in the light of a crossing that is known by its `key`.
HitLight light_of(double key, std::size_t path) {
  const double p = static_cast<double>(path);
  return {key + 0.0625 * p, 1 + key * (p + 1), -key - p, key - 2 * p};
}

/// Gives every ray up to three crossings, whose u tells them apart, and takes room for one more.
class KeyTracer final : public Tracer {
 public:
  void trace_band(int first_line, int lines, const BandRoom& room) const override {
    constexpr int kWidth = 10;
    std::fill(room.rays.begin(), room.rays.end(), RayRecord{0, 1, 0, 0});
    for (int ray = 0; ray < kWidth * lines; ++ray) {
      const int line = first_line + ray / kWidth, column = ray % kWidth, count = (line + column) % 4;
      const HitRoom to = room.hits.extend(static_cast<std::size_t>(count) + 1);
      ASSERT_EQ(to.paths, 6u);
      for (int n = 0; n < count; ++n) {
        const double key = ((line * kWidth + column) * 4 + n) / 2048.0;
        to.hits[n] = {
            static_cast<std::uint32_t>(ray), 1, 0, n + (7 * line + 3 * column) % 5 * 0.5, key, 0, 1, 0, 0, 1};
        for (std::size_t path = 0; path < to.paths; ++path)
          to.lights[static_cast<std::size_t>(n) * to.paths + path] = light_of(key, path);
      }
      room.hits.keep(static_cast<std::size_t>(count));
    }
  }
  double tau_origin(std::size_t) const override { return 0; }
  double distortion(std::size_t) const override { return 0; }
  std::uint64_t light_doubts() const override { return 0; }
  std::uint32_t object_about_lamp(std::size_t) const override { return 0; }
  double lamp_tau_origin(std::size_t lamp) const override { return 0.5 + static_cast<double>(lamp); }
};

/// All that the tracer finds, as a dataset.
Dataset lit_dataset() {
  const Scene scene = lit_scene();
  const KeyTracer tracer;
  Dataset out;
  out.manifest = describe(find_spacetime(scene.metric), scene, tracer);
  out.hits = empty_hits(out.manifest);
  trace_bands(tracer, scene, {0, 20}, 2, {}, [&](const Band& band) { out.append(band); });
  fingerprint(out);
  return out;
}

TEST(Light, FollowsItsCrossingThroughSamplesAndBands) {
  const Dataset dataset = lit_dataset();
  EXPECT_EQ(verify(dataset), std::vector<std::string>{});
  const Hits& hits = dataset.hits;
  EXPECT_EQ(hits.count(), 600u);  // 400 rays with 0 to 3
  ASSERT_EQ(hits.light.size(), 6u);
  EXPECT_EQ(hits.light[4].prefix, "light.moon.1.");
  bool mixed = false;
  for (std::size_t k = 0; k < hits.count(); ++k) {
    mixed = mixed || (k > 0 && hits.sample[k] < hits.sample[k - 1] && hits.Z[k] > hits.Z[k - 1]);
    for (std::size_t path = 0; path < 6; ++path) {
      const LightPath& found = hits.light[path];
      const HitLight expected = light_of(static_cast<double>(hits.u[k]), path);
      EXPECT_EQ(found.E[k], static_cast<float>(expected.E));
      EXPECT_EQ(found.shift[k], static_cast<float>(expected.shift));
      EXPECT_EQ(found.t[k], static_cast<float>(expected.t));
      EXPECT_EQ(found.tau[k], static_cast<float>(expected.tau));
    }
  }
  EXPECT_TRUE(mixed) << "no crossing of one sample stands between those of another";
}

TEST(Light, IsTracedInFullPrecision) {
  const std::vector<TracedBand> bands = trace_exactly(KeyTracer(), lit_scene(), 1);
  ASSERT_EQ(bands.size(), 2u);
  for (const TracedBand& band : bands) {
    ASSERT_EQ(band.lights.size(), 6 * band.hits.size());
    for (std::size_t i = 0; i < band.lights.size(); ++i)
      EXPECT_EQ(band.lights[i].tau, light_of(band.hits[i / 6].u, i % 6).tau);
  }
}

TEST(Light, IsToldOfInTheManifest) {
  const Manifest m = lit_dataset().manifest;
  EXPECT_EQ(m.format, 3);
  EXPECT_EQ(m.light_paths, 3);
  EXPECT_EQ(m.lights, (std::vector<ObjectEntry>{{"sun", 0.5}, {"moon", 1.5}}));
  EXPECT_TRUE(m.channels.has("light"));
  EXPECT_EQ(json::parse(m.setting)["lights"],
            json::parse(R"({"windings": 2, "paths": 3, "shadows": false, "cap": 4.0})"));
  const json written = json::parse(manifest_to_json(m));
  EXPECT_EQ(written["channels"].size(), 6u + 6 * 4);
  EXPECT_EQ(written["channels"][6], "light.sun.0.E");
  EXPECT_EQ(written["channels"][29], "light.moon.2.tau");
  const Manifest read = manifest_from_json(written.dump(), "m");
  EXPECT_EQ(read.lights, m.lights);
  EXPECT_EQ(read.light_paths, 3);
  EXPECT_EQ(read.channels, m.channels);
}

TEST(Light, IsAbsentWhereThereAreNoLamps) {
  const json plain = json::parse(manifest_to_json(sample().manifest));
  EXPECT_EQ(plain["format"], 2);
  EXPECT_FALSE(plain.contains("lights"));
  EXPECT_FALSE(plain.contains("light_paths"));

  Dataset later = sample();  // from format 4 on it is said that there are none
  later.manifest.format = 4;
  json told = json::parse(manifest_to_json(later.manifest));
  EXPECT_EQ(told["lights"], json::array());
  EXPECT_EQ(told["light_paths"], 0);
  const Manifest read = manifest_from_json(told.dump(), "m");
  EXPECT_EQ(read.format, 4);
  EXPECT_TRUE(read.lights.empty());
  EXPECT_FALSE(read.channels.has("light"));
  told["light_paths"] = 1;
  EXPECT_THROW(manifest_from_json(told.dump(), "m"), InputError);
}

/// A manifest that says of light what is not so.
TEST(Light, MustFitTheManifest) {
  const json right = json::parse(manifest_to_json(sample(true, kAllChannels).manifest));
  const auto complaint = [&](const char* patch) {
    try {
      json changed = right;
      const json changes = json::parse(patch);
      for (const auto& [pointer, value] : changes.items()) changed[json::json_pointer(pointer)] = value;
      manifest_from_json(changed.dump(), "m");
    } catch (const InputError& error) {
      return std::string(error.what());
    }
    return std::string();
  };
  EXPECT_EQ(complaint("{}"), "");
  const std::pair<const char*, const char*> cases[] = {
      {R"({"/lights": []})", "m: /lights: expected 1 to 64 lamps"},
      {R"({"/lights/0/name": "sol"})", "m: /channels: expected E, shift, t and tau of every lamp"},
      {R"({"/lights/1/name": "sun"})", "m: /lights/1/name"},
      {R"({"/lights/1/tau_origin": "x"})", "m: /lights/1/tau_origin"},
      {R"({"/lights/1/colour": 1})", "m: /lights/1/colour"},
      {R"({"/light_paths": 1})", "m: /channels: expected E, shift, t and tau of every lamp"},
      {R"({"/light_paths": 3})", "m: /channels: expected E, shift, t and tau of every lamp"},
      {R"({"/light_paths": 0})", "m: /light_paths"},
      {R"({"/light_paths": 33})", "m: /light_paths"},
      {R"({"/channels/24": "light.sun.0.F"})", "m: /channels: expected E, shift"},
      {R"({"/channels/24": "mu"})", "m: /channels: expected E, shift"},
      {R"({"/channels/25": "mu"})", "m: /channels: expected those of light behind the others"},
      {R"({"/channels/24": "lights"})", "m: /channels: names a channel"},
      {R"({"/channels": ["Z", "A", "id"]})", "m: /channels: expected E, shift"},
      {R"({"/format": 2})", "m: /channels: names a channel"},
  };
  for (const auto& [patch, expected] : cases)
    EXPECT_EQ(complaint(patch).substr(0, std::string(expected).size()), expected) << patch;
}

TEST_F(DatasetFile, LightIsReadWhereItIsWanted) {
  const Dataset written = lit_dataset();
  write(path, written);
  EXPECT_EQ(verify_file(path), std::vector<std::string>{});
  EXPECT_TRUE(read_dataset(path, ChannelSet::of("uv")).hits.light.empty());
  const Hits alone = read_dataset(path, ChannelSet::of("light"), false).hits;
  EXPECT_TRUE(alone.Z.empty());
  ASSERT_EQ(alone.light.size(), 6u);
  for (std::size_t i = 0; i < 6; ++i) {
    EXPECT_EQ(alone.light[i].prefix, written.hits.light[i].prefix);
    EXPECT_EQ(alone.light[i].E, written.hits.light[i].E);
    EXPECT_EQ(alone.light[i].tau, written.hits.light[i].tau);
  }
}

TEST(Verify, SeesLightThatCannotBe) {
  void (*const changes[])(Dataset&) = {
      [](Dataset& d) { d.hits.light[0].E[1] = -1; },
      [](Dataset& d) { d.hits.light[1].E[1] = INFINITY; },
      [](Dataset& d) { d.hits.light[2].E[1] = NAN; },
      [](Dataset& d) { d.hits.light[0].shift[1] = 0; },
      [](Dataset& d) { d.hits.light[3].shift[1] = INFINITY; },
      [](Dataset& d) { d.hits.light[0].t[1] = -INFINITY; },
      [](Dataset& d) { d.hits.light[3].tau[1] = NAN; },
      [](Dataset& d) { d.hits.light.pop_back(); },
      [](Dataset& d) { std::swap(d.hits.light[0], d.hits.light[1]); },
      [](Dataset& d) { d.hits.light.clear(); },
  };
  for (std::size_t i = 0; i < std::size(changes); ++i) {
    Dataset dataset = sample(true, kAllChannels);
    EXPECT_EQ(verify(dataset), std::vector<std::string>{});
    changes[i](dataset);
    fingerprint(dataset);
    EXPECT_FALSE(verify(dataset).empty()) << "change " << i;
  }
  Dataset shorter = sample(true, kAllChannels);
  shorter.hits.light[2].t.pop_back();
  EXPECT_FALSE(verify(shorter).empty());
}

TEST_F(DatasetFile, BandsWithOtherLampsAreNotWritten) {
  Dataset dataset = sample(true, kAllChannels);
  dataset.hits.light[3].prefix = "light.other.1.";
  EXPECT_THROW(write(path, dataset), WorkError);
  dataset.hits.light.pop_back();
  EXPECT_THROW(write(path, dataset), WorkError);
  EXPECT_EQ(listing(), std::vector<std::string>{});
}

}  // namespace
}  // namespace nullcone::test
