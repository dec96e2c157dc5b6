// Crossings of several times, for the tests of what changes with them.
#pragma once

#include "tests/postrender_fixture.h"

namespace nullcone::postrender {

using nlohmann::json;

/// One line of crossings: t as given, and a clock that runs otherwise: tau = 2 t + 3 + 1000 (the origin).
inline Dataset line_of_times(const std::vector<float>& times) {
  return make_dataset(static_cast<int>(times.size()), 1, {{"earth", 1000}}, [&](int column, int) {
    TestHit hit;
    hit.t = times[static_cast<std::size_t>(column)];
    hit.tau = 2 * hit.t + 3;
    hit.u = 0.3f;
    return std::vector{hit};
  });
}

inline const std::vector<float> kTimes = {-5, -3, -2.5f, -2.25f, -2, -1.75f, -1.5f, -1, -0.25f, 0, 1, 7};

/// The light of each crossing under what a look says of the object.
inline std::vector<Rgb> light(const std::vector<float>& times, const json& earth,
                              const json& rest = json::object()) {
  json look = {{"objects", {{"earth", earth}}}};
  look.update(rest);
  return picture(line_of_times(times), look.dump()).exposed;
}

inline json color(double r, double g, double b) { return {{"type", "color"}, {"rgb", {r, g, b}}}; }

inline json by(const char* clock, const json& keys) { return {{"keyframes", keys}, {"by", clock}}; }

}  // namespace nullcone::postrender
