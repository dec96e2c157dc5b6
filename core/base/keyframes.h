// Numbers that change with time: {"keyframes": [[time, value], ...], "interpolation": "linear" | "smooth",
// "by": CLOCK}, in looks and in scenes.
#pragma once

#include <functional>
#include <nlohmann/json_fwd.hpp>
#include <string>
#include <vector>

namespace nullcone {

/// A number by time: held before the first and after the last key, and between keys linear, or smooth: cubic,
/// through the keys with the slopes of the chords between their neighbours, which never leave the range of
/// the two keys (monotone, Fritsch and Carlson 1980).
struct Keyframes {
  enum class Clock { frame, t, tau, time } clock = Clock::frame;
  std::vector<double> times, values;  ///< times increase strictly
  std::vector<double> slopes;         ///< smooth: at the keys; else empty

  double at(double time) const;
  bool operator==(const Keyframes&) const = default;
};

/// Slopes at the points (x, y) for a cubic that keeps between them (Fritsch and Carlson 1980, with the
/// harmonic mean); 0 at both ends.
std::vector<double> monotone_slopes(const std::vector<double>& x, const std::vector<double>& y);

/// Clocks by which numbers of a look may go: the number of the frame, and the times of emission.
inline const std::vector<Keyframes::Clock> kLookClocks = {Keyframes::Clock::frame, Keyframes::Clock::t,
                                                          Keyframes::Clock::tau};

/// Whether a value of a look or a scene is one that changes with time.
bool is_keyframes(const nlohmann::json& value);
/// `clocks`: what `by` may say; the first of them where it is left out. Throws InputError
/// "place: pointer: ...".
Keyframes parse_keyframes(const nlohmann::json& value, const std::string& place, const std::string& pointer,
                          const std::vector<Keyframes::Clock>& clocks = kLookClocks);

/// The document with all keyframes in it replaced by what `by` makes of them and their JSON pointer;
/// `pointer` is that of the document.
nlohmann::json replace_keyframes(
    nlohmann::json document, const std::string& pointer,
    const std::function<nlohmann::json(const nlohmann::json& keyframes, const std::string& pointer)>& by);

/// The document with every number that changes by `frame` replaced by its value there. What changes by the
/// time of emission (t, tau) stays.
nlohmann::json at_frame(nlohmann::json document, double frame, const std::string& place,
                        const std::string& pointer);

}  // namespace nullcone
