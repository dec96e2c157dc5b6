// Tone curves that are tabulated: from points to the nodes that pixel loops read.
#pragma once

#include <string>
#include <utility>
#include <vector>

#include "core/base/keyframes.h"
#include "postrender/kernel.h"

namespace nullcone::postrender {

/// What luminance is shown for which: straight from (0, 0) to the first point, through the points, and held
/// after the last. Nodes stand 2^kToneNodeBits an octave over the 32 octaves up to the last point; between
/// them it is straight, which cuts a corner of the curve by at most L/2048 times the change of slope there.
class ToneTable {
 public:
  ToneTable() = default;
  /// `luminance` increases strictly from 0 or more to within [1e-20, 1e20]; as many `shown`.
  ToneTable(std::vector<double> luminance, std::vector<double> shown, bool smooth);

  ToneTableView view() const { return {nodes_.data(), first_, lowest_, highest_}; }
  const Keyframes& points() const { return points_; }
  bool operator==(const ToneTable& other) const { return points_ == other.points_; }

 private:
  Keyframes points_;
  std::vector<float> nodes_;
  std::int32_t first_ = 0;
  float lowest_ = 0, highest_ = 0;
};

/// The filmic curve of J. Hable, "Uncharted 2: HDR lighting" (Game Developers Conference 2010), h(x) with his
/// constants and his white 11.2, stretched so that h(11.2 Y / white) / h(11.2) shows `white` as 1. Written
/// without the difference of nearly equal numbers that h is for small x.
FilmicCurve hable_curve(double white);

/// Pairs of numbers from a CSV file: "L,shown" a line; empty lines and those from # on say nothing. Throws
/// InputError with the line.
std::vector<std::pair<double, double>> read_tone_csv(const std::string& path);

}  // namespace nullcone::postrender
