// A ray's numbers depend on nothing but the ray: not on instruction set, lanes, threads or bands.
#include <algorithm>
#include <bit>
#include <fstream>
#include <iostream>
#include <tuple>

#include "tests/reference_cases.h"
#include "tests/sanitized.h"
#include "tests/traced.h"

namespace nullcone::test {
namespace {

/// The same scene with everything transparent, all crossings and all their details.
json in_full(json scene, int width, int height) {
  for (json& object : scene["objects"])
    if (object["shape"]["type"] != "sky") object["transparent"] = true;
  scene["camera"]["resolution"] = {width, height};
  scene["records"] = {{"differentials", true},
                      {"channels", {"order", "uv", "shift", "t", "tau", "mu", "N", "K", "P"}}};
  return scene;
}

/// Objects on courses: circles and what spins, tables, pieces and accelerations, and an observer on one.
std::vector<json> scenes_with_courses() {
  const json round = json::parse(R"({"type": "circular", "event": [0, 1.4, 0, 0.1], "speed": 0.6})"),
             pushed = json::parse(R"({"type": "accelerated", "event": [0, 0.2, -1, 0.2],
               "velocity": [0.1, 0, 0.2], "acceleration": [0.1, 0.3, 0]})"),
             pieces = json::parse(R"({"type": "piecewise", "event": [-1, -1, 0.3, 0], "pieces": [
               {"velocity": [0.5, 0, 0], "duration": 1}, {"velocity": [0, 0.4, 0.2], "duration": 1}]})"),
             table = json::parse(R"({"type": "tabulated", "events": [[-4, -0.2, -0.6, 0.9],
               [-2, 0.1, -0.2, 0.9], [0, 0.2, 0.3, 0.8], [3, 0, 0.5, 0.7]]})"),
             ball = {{"type", "sphere"}, {"radius", 0.2}},
             house = {{"type", "box"}, {"edges", {0.4, 0.3, 0.2}}},
             spin = {{"axis", {1, 2, 3}}, {"rate_deg", 40}};
  const auto object = [](const char* name, const json& shape, const json& line) {
    return json{{"name", name}, {"shape", shape}, {"placing", {{"type", "local"}, {"worldline", line}}}};
  };
  json flat = json::parse(R"({"metric": {"name": "minkowski"}, "observer": {"event": [1, 0.2, 0.1, -0.4]},
    "camera": {"type": "sphere", "resolution": [120, 60]}, "max_lookback": 9})");
  flat["objects"] = {object("round", house, round), object("pushed", ball, pushed),
                     object("pieces", ball, pieces), object("table", house, table)};
  flat["objects"][0]["placing"]["spin"] = spin;
  json goedel = flat, integrated = flat, hole = flat;
  goedel["metric"] = {{"name", "goedel"}, {"a", 3}};
  goedel["observer"] = {
      {"worldline", {{"type", "circular"}, {"event", {1, 0.3, 0.1, -0.4}}, {"speed", 0.3}}}};
  integrated["metric"] = goedel["metric"];
  integrated["paths"] = "integrated", integrated["accuracy"] = "draft";
  hole["metric"] = {{"name", "kerr_schild"}, {"spin", 0.7}};
  hole["observer"] = {{"event", {0, 6, 4, 1}}};
  hole["accuracy"] = "draft", hole["max_lookback"] = 60;
  hole["objects"] = json::array();
  for (const auto& [name, x, y] : {std::tuple{"first", 8, 0}, {"second", -7, 2}, {"third", 1, 9}}) {
    json orbit = round;
    orbit["event"] = {-30, x, y, 0}, orbit["speed"] = "free";
    hole["objects"].push_back(object(name, {{"type", "box"}, {"edges", {3, 2.5, 2}}}, orbit));
  }
  hole["objects"][0]["placing"]["spin"] = {{"axis", {1, 2, 3}}, {"rate_deg", 10}};
  integrated["camera"]["resolution"] = {60, 30};
  hole["camera"]["resolution"] = {80, 40};
  if (kSanitized) return {hole};
  return {flat, goedel, integrated, hole};
}

/// Scenes that use every placing and shape, smaller than life.
std::vector<std::string> scenes() {
  json earth = json::parse(std::ifstream(NULLCONE_SOURCE "/scenes/goedel_earth.json"));
  earth["camera"]["resolution"] = {kSanitized ? 220 : 1320, 150};
  const std::string moving = R"({"metric": {"name": "minkowski"}, "observer": {"event": [5, 0, 0, 0],
    "velocity": [0.3, 0.1, -0.2]}, "camera": {"type": "perspective", "fov_deg": 110, "resolution": [321, 203]}, "objects": [
    {"name": "ball", "shape": {"type": "sphere", "radius": 1}, "placing": {"type": "local", "worldline":
      {"type": "geodesic", "event": [0, 4, 0, 0], "velocity": [0, 0.9, 0.1]}}},
    {"name": "card", "shape": {"type": "quad", "edges": [3, 2]}, "placing": {"type": "local", "worldline":
      {"type": "geodesic", "event": [0, 5, 1, 1], "velocity": [-0.2, 0, 0.5]}, "z_axis": [-1, 0.2, 0.1]}},
    {"name": "train", "shape": {"type": "box", "edges": [3, 1, 2]}, "placing": {"type": "local", "worldline":
      {"type": "geodesic", "event": [0, 5, -2, 1], "velocity": [0.6, 0.3, 0]}, "z_axis": [0.3, 0.2, 1]}},
    {"name": "heaven", "shape": {"type": "sky"}}]})";
  const std::string resting = R"({"metric": {"name": "minkowski"}, "observer": {"event": [0, 0, 0, 0]},
    "camera": {"type": "sphere", "resolution": [360, 181]}, "max_lookback": 50, "objects": [
    {"name": "dome", "shape": {"type": "sphere", "radius": 30, "dome": true}, "placing": {"type": "coordinate",
      "centre": [1, 2, 3]}},
    {"name": "ball", "shape": {"type": "sphere", "radius": 0.5}, "placing": {"type": "local", "worldline":
      {"type": "static", "event": [0, 2, 1, 0.5]}}},
    {"name": "wall", "shape": {"type": "quad", "edges": [2, 2]}, "placing": {"type": "coordinate", "centre": [-3, 0, 0],
      "z_axis": [1, 0, 0]}},
    {"name": "house", "shape": {"type": "box", "edges": [1, 2, 0.5]}, "placing": {"type": "local", "worldline":
      {"type": "static", "event": [0, 0.5, -2, 1]}, "z_axis": [1, 1, 1]}}]})";
  // Integrated: some lanes of a pack fall into the hole, some escape, some meet objects.
  const std::string hole =
      R"({"metric": {"name": "kerr_schild", "spin": 0.9}, "observer": {"event": [0, 9, 0, 2]},
    "camera": {"type": "perspective", "azimuth_deg": 180, "elevation_deg": -12, "fov_deg": 80, "resolution": [83, 61]},
    "objects": [{"name": "ball", "shape": {"type": "sphere", "radius": 1}, "placing": {"type": "local", "worldline":
      {"type": "static", "event": [0, -5, 2, 1]}}},
    {"name": "plate", "shape": {"type": "quad", "edges": [9, 9]}, "placing": {"type": "coordinate", "centre": [0, 0, -3]}},
    {"name": "house", "shape": {"type": "box", "edges": [2, 3, 1]}, "placing": {"type": "coordinate", "centre": [-4, -4, 1]}},
    {"name": "heaven", "shape": {"type": "sky"}}]})";
  const std::string wormhole = R"({"metric": {"name": "ellis_wormhole"}, "observer": {"event": [0, 5, 0, 0]},
    "camera": {"type": "perspective", "azimuth_deg": 180, "fov_deg": 60, "resolution": [61, 47]}, "accuracy": "draft",
    "objects": [{"name": "here", "shape": {"type": "sky"}}, {"name": "there", "shape": {"type": "sky", "side": 2}}]})";
  json spheres = json::parse(resting);
  spheres["metric"]["name"] = "goedel";
  spheres["paths"] = "integrated";
  spheres["accuracy"] = {{"rtol", 1e-7}, {"integrator", "dopri5"}};
  spheres["camera"]["resolution"] = {90, 45};
  spheres["max_lookback"] = 8;
  spheres["objects"][0]["shape"]["radius"] = 5;
  spheres["objects"][0]["placing"]["centre"] = {0.5, 0.2, 0.3};
  const auto smaller = [](const std::string& scene, int width, int height) {
    json out = json::parse(scene);
    if (kSanitized) out["camera"]["resolution"] = {width, height};
    return out.dump();
  };
  std::vector<std::string> out = {earth.dump(),
                                  moving,
                                  resting,
                                  smaller(hole, 27, 21),
                                  smaller(wormhole, 19, 15),
                                  smaller(spheres.dump(), 24, 13)};
  // Maps of the sky: lanes of a pack on different faces, and such without a ray.
  json cube = json::parse(resting), tetrahedron = cube, fisheye = json::parse(hole);
  cube["camera"] = {{"type", "cube_map"}, {"resolution", {246, 41}}};
  tetrahedron["camera"] = {{"type", "tetrahedron_map"}, {"resolution", {142, 71}}};
  fisheye["camera"].update(
      {{"type", "fisheye"}, {"fov_deg", 150}, {"resolution", {kSanitized ? 21 : 61, 19}}});
  // Films, which pierce objects; some of their rays start where there is no observer.
  json film = json::parse(moving), cut = json::parse(resting), thrown = earth, pierced = spheres;
  film["camera"] = {{"type", "orthographic"}, {"extent", 7}, {"resolution", {83, 51}}};
  cut["camera"] = {{"type", "orthographic"}, {"extent", 70}, {"resolution", {181, 90}}, {"azimuth_deg", 20}};
  thrown["camera"] = {
      {"type", "orthographic"}, {"extent", 1.5}, {"resolution", {151, 73}}, {"azimuth_deg", 24}};
  pierced["camera"] = {{"type", "orthographic"}, {"extent", 6}, {"resolution", {45, 22}}};
  json through = json::parse(hole);
  through["camera"] = {
      {"type", "orthographic"}, {"extent", 30}, {"resolution", {41, 23}}, {"azimuth_deg", 100}};
  for (json& scene : std::array{cube, tetrahedron, fisheye, film, cut, thrown, pierced, through}) {
    scene["records"] = {{"differentials", true}};
    out.push_back(scene.dump());
  }
  for (const json& scene : {earth, json::parse(moving), json::parse(resting), json::parse(hole), spheres,
                            film, cut, thrown, pierced, through})
    out.push_back(smaller(in_full(scene, 60, 41).dump(), 24, 16));
  for (const json& scene : scenes_with_courses()) {
    out.push_back(smaller(scene.dump(), 48, 24));
    out.push_back(smaller(in_full(scene, 60, 41).dump(), 44, 30));
  }
  return out;
}

/// All channels of hits and rays, in full precision, of a picture that is traced in bands of `lines` scan
/// lines.
std::vector<double> numbers(const std::string& text, std::string_view isa, int lines) {
  const auto metrics = metric_descriptions();
  Scene scene = read_scene(text, "test", metrics);
  const auto tracer = prepare_scene(find_spacetime(scene.metric, isa), scene, "test");
  std::vector<double> of_hits, of_details, of_rays;
  const auto width = static_cast<std::size_t>(scene.camera.width);
  for (int line = 0; line < scene.camera.height; line += lines) {
    const int count = std::min(lines, scene.camera.height - line);
    Gathering sink;
    sink.with_details = (scene.records.channels & kDetailChannels).bits != 0;
    std::vector<RayRecord> rays(width * static_cast<std::size_t>(count));
    tracer->trace_band(line, count, {sink, rays});
    for (const HitRecord& h : sink.hits) {
      const auto pixel = static_cast<double>(h.pixel + static_cast<std::size_t>(line) * width);
      of_hits.insert(of_hits.end(), {pixel, static_cast<double>(h.id), static_cast<double>(h.order), h.Z, h.u,
                                     h.v, h.shift, h.t, h.tau, h.mu});
    }
    for (const HitDetail& d : sink.details) {
      of_details.insert(of_details.end(), d.duv.begin(), d.duv.end());
      for (const Triple& X : {d.N, d.K, d.P}) of_details.insert(of_details.end(), X.begin(), X.end());
    }
    for (const RayRecord& r : rays)
      of_rays.insert(of_rays.end(), {static_cast<double>(r.status), static_cast<double>(r.steps),
                                     double(r.error), double(r.drift)});
  }
  of_hits.insert(of_hits.end(), of_details.begin(), of_details.end());
  of_hits.insert(of_hits.end(), of_rays.begin(), of_rays.end());
  return of_hits;
}

TEST(SameBits, OnEveryInstructionSetAndBandSize) {
  for (const std::string& scene : scenes()) {
    const std::vector<double> expected = numbers(scene, "sse2", kBandLines);
    for (const std::string_view isa : instruction_sets())
      for (const int lines : {kBandLines, 1, 7}) {
        const std::vector<double> found = numbers(scene, isa, lines);
        ASSERT_EQ(found.size(), expected.size());
        const auto differs = std::ranges::mismatch(found, expected, [](double a, double b) {
          return std::bit_cast<std::uint64_t>(a) == std::bit_cast<std::uint64_t>(b);
        });
        EXPECT_TRUE(differs.in1 == found.end())
            << isa << ", bands of " << lines << ": number " << differs.in1 - found.begin() << " is "
            << *differs.in1 << ", not " << *differs.in2;
      }
  }
  const auto present = instruction_sets();
  for (const std::string_view isa : {"avx2", "avx512"})
    if (std::ranges::find(present, isa) == present.end())
      std::cout << "[  NOTE    ] " << isa << " is not there (machine or build): its column is left out\n";
}

TEST(SameBits, OnOneAndTwoThreads) {
  for (const std::string& scene : scenes()) {
    const auto metrics = metric_descriptions();
    const Scene read = read_scene(scene, "test", metrics);
    const Spacetime& spacetime = find_spacetime(read.metric);
    const Dataset one = trace_scene(spacetime, read, "test", 1),
                  two = trace_scene(spacetime, read, "test", 2);
    EXPECT_EQ(one.manifest.hits_sha256, two.manifest.hits_sha256);
    EXPECT_EQ(one.manifest.rays_sha256, two.manifest.rays_sha256);
    EXPECT_GT(one.hits.count(), kSanitized ? 20U : 100U) << scene;
  }
}

}  // namespace
}  // namespace nullcone::test
