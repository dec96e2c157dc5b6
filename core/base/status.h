// How a ray ended: the word that tracing writes and that records keep.
#pragma once

#include <array>
#include <cstdint>
#include <string_view>

namespace nullcone {

/// How a ray ended. The numbers stand in files: never reuse one.
enum class Status : std::uint32_t {
  hit = 0,               ///< met an opaque surface
  sky = 1,               ///< escaped to infinity
  captured = 2,          ///< fell into a horizon
  left_chart = 3,        ///< left the region that the coordinates cover
  lookback_reached = 4,  ///< met nothing within the scene's max_lookback
  step_limit = 5,        ///< the search was given up: doubtful pixel
  not_finite = 6,        ///< numbers broke down: doubtful pixel
  not_traced = 7,        ///< tracing was interrupted before
  outside = 8,           ///< beyond the camera's field of view: there is no ray
};
inline constexpr std::array<std::string_view, 9> kStatusNames = {
    "hit",        "sky",        "captured",   "left_chart", "lookback_reached",
    "step_limit", "not_finite", "not_traced", "outside"};

}  // namespace nullcone
