// Scenes that are traced again with other numbers in them.
#include "apps/view/live.h"

#include <cmath>
#include <numbers>

#include "core/record/dataset_file.h"
#include "core/trace/trace_scene.h"
#include "metrics/registry.h"
#include "tests/live_scenes.h"
#include "tests/test_folder.h"

namespace nullcone::view {

namespace {

Dataset traced(const json& scene) {
  const auto metrics = metric_descriptions();
  const Scene read = read_scene(canonical_json(scene), "test", metrics);
  return trace_scene(find_spacetime(read.metric), read, "test");
}

/// The scene that a change amounts to gives the same records, and says that it is that scene.
void expect_same(const json& scene, const json& changes, const json& expected, int scale = 1) {
  Dataset found = live(scene).trace(changes, scale);
  const Dataset wanted = traced(expected);
  fingerprint(found);
  EXPECT_EQ(found.manifest.hits_sha256, wanted.manifest.hits_sha256) << changes;
  EXPECT_EQ(found.manifest.rays_sha256, wanted.manifest.rays_sha256) << changes;
  EXPECT_EQ(found.manifest.scene, wanted.manifest.scene);
  EXPECT_EQ(found.manifest.setting, wanted.manifest.setting);
  EXPECT_GT(wanted.hits.count(), 0u);
}

/// The pixel in the middle of kFlat, which looks straight at the ball.
std::size_t middle(const Dataset& dataset) {
  const auto width = static_cast<std::size_t>(dataset.manifest.width),
             height = static_cast<std::size_t>(dataset.manifest.lines);
  return dataset.hits.offset[height / 2 * width + width / 2];
}

}  // namespace

TEST(LiveScene, TellsWhatHindersIt) {
  EXPECT_EQ(LiveScene::hindrance(manifest_of(kFlat), ""), "");
  EXPECT_EQ(LiveScene::hindrance(manifest_of(kGoedel), ""), "");
  json other = kFlat;
  other["paths"] = "integrated";
  EXPECT_EQ(LiveScene::hindrance(manifest_of(other), ""), "the scene asks for integrated paths");
  other = kFlat;
  other["metric"] = {{"name", "kerr_schild"}};
  EXPECT_EQ(LiveScene::hindrance(manifest_of(other), ""),
            "the spacetime 'kerr_schild' has no closed-form paths");
  other["metric"] = {{"name", "nonsense"}};
  EXPECT_NE(LiveScene::hindrance(manifest_of(other), ""), "");
  EXPECT_NE(LiveScene::hindrance(Manifest{}, ""), "");
  Manifest window = manifest_of(kFlat);
  window.height = 64;
  EXPECT_NE(LiveScene::hindrance(window, "").find("part of a picture"), std::string::npos);
  EXPECT_THROW(LiveScene(window, ""), InputError);
}

TEST(LiveScene, ReplacesNumbersOfTheScene) {
  expect_same(kFlat, {}, kFlat);
  expect_same(kFlat, json::object(), kFlat);
  json expected = kFlat;
  expected["observer"] = {{"event", {1, -0.5, 0.25, 0}}, {"velocity", {0.1, 0.2, 0}}};
  expected["camera"] = {{"type", "perspective"}, {"azimuth_deg", 4}, {"elevation_deg", -3},
                        {"roll_deg", 30},        {"fov_deg", 55},    {"resolution", {24, 16}},
                        {"samples", 2}};
  expected["objects"][0]["shape"]["radius"] = 2;
  expected["objects"][0]["placing"]["worldline"]["event"] = {3, 9, 0, 1};
  expected["objects"][1]["placing"]["centre"] = {8, 1, -1};
  const json camera = {
      {"azimuth_deg", 4}, {"elevation_deg", -3}, {"roll_deg", 30}, {"fov_deg", 55}, {"resolution", {24, 16}}};
  expect_same(kFlat,
              {{"observer", expected["observer"]},
               {"camera", camera},
               {"objects",
                {{"ball", {{"radius", 2}, {"event", {3, 9, 0, 1}}}}, {"box", {{"event", {7, 8, 1, -1}}}}}}},
              expected);
  expected = kGoedel;
  expected["metric"]["a"] = 1.5;
  expected["camera"]["fov_deg"] = {90, 45};
  expect_same(kGoedel, {{"metric", {{"a", 1.5}}}, {"camera", {{"fov_deg", {90, 45}}}}}, expected);
}

TEST(LiveScene, FindsMeshesBesideTheDataset) {
  const test::TestFolder folder;
  const std::string rock = "v 0 0 0\nv 1 0 0\nv 0 1 0\nv 0 0 1\nf 1 3 2\nf 1 2 4\nf 2 3 4\nf 1 4 3\n";
  folder.write("rock.obj", rock);
  json scene = kFlat;
  scene["objects"][0]["shape"] = {{"type", "mesh"}, {"file", "rock.obj"}};
  const Scene read = read_scene(canonical_json(scene), folder.file("scene.json"), metric_descriptions());
  Manifest manifest = manifest_of(kFlat);
  manifest.scene = read.canonical;
  const std::string dataset = folder.file("a.exr");
  EXPECT_EQ(LiveScene::hindrance(manifest, dataset), "");
  EXPECT_EQ(LiveScene::hindrance(manifest, "a.exr"),
            "rock.obj: cannot open the file: No such file or directory");
  const LiveScene traced(manifest, dataset);
  EXPECT_GT(traced.trace(nullptr, 1).hits.count(), 0u);
  EXPECT_EQ(traced.trace(nullptr, 1).manifest.scene_sha256, read.sha256);

  folder.write("rock.obj", rock + "f 1 2 3\n");
  const std::string fault = LiveScene::hindrance(manifest, dataset);
  EXPECT_TRUE(fault.starts_with("scene: /objects/0/shape/sha256: the file 'rock.obj' is another")) << fault;
  EXPECT_THROW(LiveScene(manifest, dataset), InputError);
  EXPECT_THROW(traced.trace(nullptr, 1), InputError);
  folder.write("rock.obj", "v 1 2\n");
  EXPECT_EQ(LiveScene::hindrance(manifest, dataset), "rock.obj: line 1: expected 3 numbers after v")
      << "without the folder's name";
}

Camera camera_of(const Dataset& traced) {
  return read_scene(traced.manifest.scene, "scene", metric_descriptions()).camera;
}

TEST(LiveScene, DirectionsBecomeAnglesWhenTheCameraTurns) {
  const auto read = [](const json& changes, int scale) {
    return camera_of(live(kCube).trace(changes, scale));
  };
  const Camera before = read(nullptr, 1);
  const auto &f = before.forward, &u = before.up, &l = before.left;
  constexpr double kDegrees = 180 / std::numbers::pi;
  const double azimuth = kDegrees * std::atan2(f[1], f[0]), elevation = kDegrees * std::asin(f[2]);
  EXPECT_EQ(read({{"observer", {{"velocity", {0, 0.1, 0}}}}}, 1).forward, f);
  for (const json& same : {json{{"azimuth_deg", azimuth}}, json{{"elevation_deg", elevation}},
                           json{{"azimuth_deg", azimuth},
                                {"elevation_deg", elevation},
                                {"roll_deg", kDegrees * std::atan2(l[2], u[2])}}}) {
    const Camera found = read({{"camera", same}}, 1);
    for (std::size_t i = 0; i < 3; ++i) {
      EXPECT_NEAR(found.forward[i], f[i], 1e-14);
      EXPECT_NEAR(found.up[i], u[i], 1e-14);
    }
  }
  EXPECT_NEAR(read({{"camera", {{"elevation_deg", 10}}}}, 1).forward[2], std::sin(10 / kDegrees), 1e-14);
}

TEST(LiveScene, CoarserMapsKeepTheirShape) {
  for (const int scale : {2, 4, 8}) {
    const Camera coarse = camera_of(live(kCube).trace(nullptr, scale));
    EXPECT_EQ(coarse.width, 6 * coarse.height);
    EXPECT_NEAR(coarse.height, 21.0 / scale, 1);
  }
}

TEST(LiveScene, MovingObjectsKeepTheirAxes) {
  json expected = kGoedel;
  json* placing = &expected["objects"][0]["placing"];
  (*placing)["worldline"] = {{"type", "geodesic"}, {"event", {0, 0.8, 0.1, 0}}, {"velocity", {0.2, 0.1, 0}}};
  (*placing)["axes"] = "static";
  expected["lights"]["lamps"][0]["worldline"] = (*placing)["worldline"];  // whose body it is
  expect_same(kGoedel, {{"objects", {{"still", {{"velocity", {0.2, 0.1, 0}}}}}}}, expected);
  expected = kGoedel;
  placing = &expected["objects"][1]["placing"];
  (*placing)["worldline"]["velocity"] = {0, 0, 0};
  (*placing)["axes"] = "gyroscope";
  expect_same(kGoedel, {{"objects", {{"fast", {{"velocity", {0, 0, 0}}}}}}}, expected);
  expect_same(kGoedel, {{"objects", {{"still", {{"velocity", {0, 0, 0}}}}}}}, kGoedel);
  json chosen = kGoedel;
  chosen["objects"][0]["placing"]["axes"] = "gyroscope";
  EXPECT_EQ(json::parse(
                live(chosen).trace({{"objects", {{"still", {{"velocity", {0.1, 0, 0}}}}}}}, 1).manifest.scene)
                .at("objects")[0]["placing"]["axes"],
            "gyroscope");
  // A lamp that is elsewhere stays there.
  chosen["lights"]["lamps"][0]["worldline"]["event"] = {0, 0.8, 0.1, 0.5};
  EXPECT_EQ(json::parse(
                live(chosen).trace({{"objects", {{"still", {{"event", {0, 0.9, 0, 0}}}}}}}, 1).manifest.scene)
                .at("lights"),
            chosen.at("lights"));
}

TEST(LiveScene, SeesSpecialRelativity) {
  // Light of a ball at rest, straight ahead: blue by sqrt((1 + beta)/(1 - beta)) for who moves towards it. Of
  // one that recedes, seen when it was at the place of its event (t = -9: its near side is 9 away).
  const double beta = 0.6;
  const json one_sample = {{"resolution", {33, 17}}};
  Dataset towards =
      live(kFlat).trace({{"observer", {{"velocity", {beta, 0, 0}}}}, {"camera", one_sample}}, 1);
  EXPECT_NEAR(towards.hits.shift[middle(towards)], 2, 2e-3);  // a quarter of a pixel off the axis
  Dataset away = live(kFlat).trace(
      {{"objects", {{"ball", {{"event", {-9, 10, 0, 0}}, {"velocity", {beta, 0, 0}}}}}}}, 1);
  EXPECT_NEAR(away.hits.shift[middle(away)], 0.5, 2e-3);
  Dataset large = live(kFlat).trace({{"objects", {{"ball", {{"radius", 4}}}}}}, 1);
  EXPECT_NEAR(large.hits.t[middle(large)], -6, 1e-2);
}

TEST(LiveScene, DividesTheResolution) {
  json expected = kFlat;
  expected["camera"]["resolution"] = {16, 8};
  expected["camera"].erase("samples");
  expect_same(kFlat, {}, expected, 2);
  EXPECT_EQ(live(kFlat).trace({}, 1).manifest.samples, 2);
  const Manifest coarse = live(kFlat).trace({{"camera", {{"resolution", {160, 90}}}}}, 4).manifest;
  EXPECT_EQ(coarse.width, 40);
  EXPECT_EQ(coarse.lines, 22);  // pixels 2, 6, ... 86
  EXPECT_EQ(coarse.samples, 1);
  for (const int scale : {0, -1, 9}) EXPECT_EQ(complaint(kFlat, {}, scale).find("scale: "), 0u);
}

TEST(LiveScene, SavesADataset) {
  const postrender::TestFolder folder;
  const std::string path = folder.file("saved.exr");
  const json changes = {{"observer", {{"event", {1, 0.1, 0, 0}}}}}, look = {{"exposure", {{"ev", 1}}}};
  live(kFlat).save(changes, look, path);
  EXPECT_EQ(verify_file(path), std::vector<std::string>{});
  const Manifest manifest = read_manifest(path);
  json expected = kFlat;
  expected["observer"] = changes["observer"];
  expected["look"] = look;
  EXPECT_EQ(manifest.scene, canonical_json(expected));
  EXPECT_EQ(manifest.samples, 2);
  EXPECT_GT(manifest.effort.seconds, 0);
  EXPECT_EQ(manifest.hits_sha256, traced(json::parse(manifest.scene)).manifest.hits_sha256);
  EXPECT_EQ(manifest.rays_sha256, traced(expected).manifest.rays_sha256);
  live(kFlat).save({}, nullptr, path);  // its own look stays, and the old file goes
  EXPECT_EQ(read_manifest(path).scene, canonical_json(kFlat));
  EXPECT_THROW(live(kFlat).save({}, 5, path), InputError);
  EXPECT_THROW(live(kFlat).save({}, nullptr, folder.file("saved.png")), InputError);
  EXPECT_EQ(read_manifest(path).scene, canonical_json(kFlat));
}

}  // namespace nullcone::view
