#include "postrender/tone.h"

#include <bit>

#include "core/base/error.h"
#include "postrender/csv.h"

namespace nullcone::postrender {

namespace {

constexpr int kToneOctaves = 32;

std::int32_t bits_of(float x) { return std::bit_cast<std::int32_t>(x); }

}  // namespace

ToneTable::ToneTable(std::vector<double> luminance, std::vector<double> shown, bool smooth) {
  if (luminance.front() > 0) {
    luminance.insert(luminance.begin(), 0.0);
    shown.insert(shown.begin(), 0.0);
  }
  points_.times = std::move(luminance);
  points_.values = std::move(shown);
  if (smooth) points_.slopes = monotone_slopes(points_.times, points_.values);
  highest_ = static_cast<float>(points_.times.back());
  first_ = (bits_of(highest_) >> kToneShift) - (kToneOctaves << kToneNodeBits);
  lowest_ = std::bit_cast<float>(first_ << kToneShift);
  // The last interval ends beyond the last point, where the curve is held: nothing is interpolated across it.
  for (std::int32_t node = first_; node <= (bits_of(highest_) >> kToneShift) + 1; ++node)
    nodes_.push_back(
        static_cast<float>(points_.at(static_cast<double>(std::bit_cast<float>(node << kToneShift)))));
}

FilmicCurve hable_curve(double white) {
  constexpr double A = 0.15, B = 0.50, C = 0.10, D = 0.20, E = 0.02, F = 0.30, W = 11.2;
  constexpr double a1 = A * (1 - E / F), a0 = B * (C - E / F);
  constexpr double h = W * (a1 * W + a0) / ((A * W + B) * W + D * F);
  const double stretch = W / white, scale = stretch / h;
  const auto rounded = [](double x) { return static_cast<float>(x); };
  return {.a1 = rounded(scale * a1),
          .a0 = rounded(scale * a0),
          .b2 = rounded(A),
          .b1 = rounded(B),
          .b0 = rounded(D * F),
          .stretch = rounded(stretch),
          .white = rounded(white)};
}

std::vector<std::pair<double, double>> read_tone_csv(const std::string& path) {
  const TableKind kind = {"a luminance", "what is shown", true, 1e6};
  std::vector<std::pair<double, double>> out;
  for (const std::vector<double>& row : read_table(path, "/tone/file", kind)) {
    if (row.size() != 2) throw InputError(path + ": /tone/file", "expected two columns, luminance and shown");
    out.emplace_back(row[0], row[1]);
  }
  return out;
}

}  // namespace nullcone::postrender
