// What live tracing refuses, and that nothing makes it fall or work for long.
#include <cmath>
#include <limits>
#include <random>
#include <tuple>

#include "tests/live_scenes.h"

namespace nullcone::view {

TEST(LiveScene, RefusesWhatIsNoChange) {
  const double nan = std::numeric_limits<double>::quiet_NaN();
  const std::vector<std::tuple<const json*, json, std::string>> cases = {
      {&kFlat, json::array(), "scene: /: expected an object"},
      {&kFlat, {{"look", 1}}, "scene: /look: unknown key"},
      {&kFlat, {{"max_lookback", 1}}, "scene: /max_lookback: unknown key"},
      {&kFlat, {{"metric", {{"name", "goedel"}}}}, "scene: /metric/name: unknown key"},
      {&kGoedel, {{"metric", {{"a", "x"}}}}, "scene: /metric/a: expected a number"},
      {&kGoedel, {{"metric", {{"a", 1e300}}}}, "scene: /metric/a: is 1e+300"},
      {&kGoedel, {{"metric", {{"a", 0}}}}, "scene: /metric/a: is 0"},
      {&kFlat, {{"observer", {{"frame", "normal"}}}}, "scene: /observer/frame: unknown key"},
      {&kFlat, {{"observer", {{"event", {0, "x", 0, 0}}}}}, "scene: /observer/event/1: expected a number"},
      {&kFlat,
       {{"observer", {{"event", {0, nullptr, 0, 0}}}}},
       "scene: /observer/event/1: expected a number"},
      {&kFlat, {{"observer", {{"event", {0, 0, nan, 0}}}}}, "scene: /observer/event/2: expected a finite"},
      {&kFlat, {{"observer", {{"event", {0, 0, 0}}}}}, "scene: /observer/event: expected a list of 4"},
      {&kFlat, {{"observer", {{"event", {0, 0, 0, 1e300}}}}}, "scene: /observer/event/3: is 1e+300"},
      {&kFlat, {{"observer", {{"velocity", {0.8, 0.6, 0}}}}}, "scene: /observer/velocity: is not slower"},
      {&kFlat, {{"observer", {{"event", {0, 10, 0.5, 0}}}}}, "scene: /objects/0: 'ball' holds the observer"},
      {&kFlat, {{"camera", {{"fov_deg", {40, 20}}}}}, "scene: /camera/fov_deg: expected a number"},
      {&kGoedel, {{"camera", {{"fov_deg", 40}}}}, "scene: /camera/fov_deg: expected a list of 2"},
      {&kCube, {{"camera", {{"fov_deg", 40}}}}, "scene: /camera/fov_deg: unknown key"},
      {&kCube, {{"camera", {{"resolution", {90, 16}}}}}, "scene: /camera/resolution: expected a width of 6"},
      {&kFlat, {{"camera", {{"samples", 16}}}}, "scene: /camera/samples: unknown key"},
      {&kFlat, {{"camera", {{"elevation_deg", 91}}}}, "scene: /camera/elevation_deg: is 91"},
      {&kFlat, {{"camera", {{"resolution", {15, 100}}}}}, "scene: /camera/resolution/0: is 15"},
      {&kFlat, {{"camera", {{"resolution", {100, 4097}}}}}, "scene: /camera/resolution/1: is 4097"},
      {&kFlat,
       {{"camera", {{"resolution", {4096, 1025}}}}},
       "scene: /camera/resolution: asks for more than 4194304"},
      {&kFlat, {{"camera", {{"resolution", {16.5, 16}}}}}, "scene: /camera/resolution: expected two whole"},
      {&kFlat,
       {{"objects", {{"moon", json::object()}}}},
       "scene: /objects/moon: unknown key; expected one of ball, box"},
      {&kFlat, {{"objects", {{"ball", {{"name", "x"}}}}}}, "scene: /objects/ball/name: unknown key"},
      {&kFlat, {{"objects", {{"ball", {{"radius", 0}}}}}}, "scene: /objects/ball/radius: is 0"},
      {&kFlat,
       {{"objects", {{"ball", {{"velocity", {1, 0, 0}}}}}}},
       "scene: /objects/ball/velocity: is not slower"},
      {&kFlat,
       {{"objects", {{"box", {{"radius", 1}}}}}},
       "scene: /objects/box/radius: the object is not a sphere"},
      {&kFlat,
       {{"objects", {{"box", {{"velocity", {0.1, 0, 0}}}}}}},
       "scene: /objects/box/velocity: the object is fixed"},
      {&kGoedel,
       {{"objects", {{"still", {{"velocity", {0.99, 0, 0}}}}}}},
       "scene: /objects/0: 'still' is too large"}};
  for (const auto& [scene, changes, expected] : cases)
    EXPECT_EQ(complaint(*scene, changes).substr(0, expected.size()), expected);
  json sky = kFlat;
  sky["objects"].push_back({{"name", "sky"}, {"shape", {{"type", "sky"}}}});
  EXPECT_EQ(complaint(sky, {{"objects", {{"sky", {{"event", {0, 0, 0, 0}}}}}}}),
            "scene: /objects/sky/event: the object has no place; expected none");
}

TEST(LiveScene, BoundsTheWork) {
  const json large = {{"camera", {{"resolution", {2048, 2048}}}}};  // four rays each
  EXPECT_EQ(complaint(kFlat, large).find("scene: /camera/resolution: asks for 16777216 rays"), 0u);
  EXPECT_THROW(live(kGoedel, {.paths = 2 * 800}).trace({}, 1), InputError);  // and two paths of light each
  EXPECT_NO_THROW(live(kGoedel, {.paths = 3 * 800}).trace({}, 1));
  EXPECT_THROW(live(kGoedel, {.seconds = 0}).trace({}, 1), InputError);
  const postrender::TestFolder folder;
  const std::string path = folder.file("slow.exr");
  EXPECT_THROW(live(kGoedel, {.saved_seconds = 0}).save({}, nullptr, path), InputError);
  EXPECT_THROW(live(kGoedel, {.saved_paths = 1000}).save({}, nullptr, path), InputError);
  EXPECT_FALSE(std::filesystem::exists(path));
}

TEST(LiveScene, AnyNumbersAreTracedOrRefused) {
  std::mt19937 random(7);
  const auto number = [&]() -> json {
    const double mantissa = std::uniform_real_distribution<>(-10, 10)(random);
    const int kind = std::uniform_int_distribution<>(0, 9)(random);
    if (kind == 0) return nullptr;
    return mantissa * std::pow(10.0, kind < 6 ? 0 : std::uniform_int_distribution<>(-300, 300)(random));
  };
  const auto numbers = [&](int count, double scale) {
    json out = json::array();
    for (int i = 0; i < count; ++i) {
      const json one = number();
      out.push_back(one.is_null() ? one : json(scale * one.get<double>()));
    }
    return out;
  };
  int fine = 0;
  for (int i = 0; i < 1500; ++i) {
    const bool curved = i % 2 == 0;
    json changes = {{"observer", {{"event", numbers(4, 1)}, {"velocity", numbers(3, 0.1)}}},
                    {"camera", {{"azimuth_deg", number()}, {"fov_deg", curved ? numbers(2, 5) : number()}}},
                    {"objects",
                     {{curved ? "fast" : "ball",
                       {{"event", numbers(4, 1)}, {"velocity", numbers(3, 0.1)}, {"radius", number()}}}}}};
    if (curved) changes["metric"] = {{"a", number()}};
    // Fewer at a time, so that some of them make a scene.
    for (const char* key : {"observer", "camera", "objects", "metric"})
      if (i % 7 > 1 && random() % 2 == 0) changes.erase(key);
    fine += complaint(curved ? kGoedel : kFlat, changes, 2).empty();
  }
  EXPECT_GT(fine, 50);
}

}  // namespace nullcone::view
