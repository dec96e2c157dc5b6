// Numbers that change with time: {"keyframes": [[time, value], ...], "interpolation": "linear" | "smooth",
// "by": "frame" | "t" | "tau"}.
#pragma once

#include <nlohmann/json_fwd.hpp>
#include <string>
#include <vector>

namespace nullcone::postrender {

/// A number by time: held before the first and after the last key, and between keys linear, or smooth: cubic,
/// through the keys with the slopes of the chords between their neighbours, which never leave the range of
/// the two keys (monotone, Fritsch and Carlson 1980).
struct Keyframes {
  enum class Clock { frame, t, tau } clock = Clock::frame;
  std::vector<double> times, values;  ///< times increase strictly
  std::vector<double> slopes;         ///< smooth: at the keys; else empty

  double at(double time) const;
  bool operator==(const Keyframes&) const = default;
};

/// Slopes at the points (x, y) for a cubic that keeps between them (Fritsch and Carlson 1980, with the
/// harmonic mean); 0 at both ends.
std::vector<double> monotone_slopes(const std::vector<double>& x, const std::vector<double>& y);

/// Whether a value of a look is one that changes with time.
bool is_keyframes(const nlohmann::json& value);
/// Throws InputError "place: pointer: ...".
Keyframes parse_keyframes(const nlohmann::json& value, const std::string& place, const std::string& pointer);

/// The document with every number that changes by `frame` replaced by its value there. What changes by the
/// time of emission (t, tau) stays.
nlohmann::json at_frame(nlohmann::json document, double frame, const std::string& place,
                        const std::string& pointer);

}  // namespace nullcone::postrender
