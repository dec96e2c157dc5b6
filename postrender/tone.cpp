#include "postrender/tone.h"

#include <bit>
#include <charconv>
#include <fstream>

#include "core/base/error.h"

namespace nullcone::postrender {

namespace {

constexpr int kToneOctaves = 32;

std::int32_t bits_of(float x) { return std::bit_cast<std::int32_t>(x); }

std::string_view trimmed(std::string_view text) {
  constexpr std::string_view kBlank = " \t\r";
  const std::size_t from = text.find_first_not_of(kBlank);
  return from == text.npos ? std::string_view{} : text.substr(from, text.find_last_not_of(kBlank) - from + 1);
}

bool read_number(std::string_view text, double& out) {
  text = trimmed(text);
  const auto [end, error] = std::from_chars(text.data(), text.data() + text.size(), out);
  return error == std::errc{} && end == text.data() + text.size();
}

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
  std::ifstream in(path);
  if (!in) throw InputError(path, "cannot open");
  constexpr std::size_t kMost = 65536;
  std::vector<std::pair<double, double>> out;
  std::string line;
  for (std::size_t number = 1; std::getline(in, line); ++number) {
    const std::string_view text = trimmed(std::string_view(line).substr(0, line.find('#')));
    if (text.empty()) continue;
    const std::size_t comma = text.find(',');
    std::pair<double, double> point;
    if (comma == text.npos || !read_number(text.substr(0, comma), point.first) ||
        !read_number(text.substr(comma + 1), point.second))
      throw InputError(path,
                       "line " + std::to_string(number) + ": expected two numbers, \"luminance,shown\"");
    if (out.size() == kMost) throw InputError(path, "expected at most " + std::to_string(kMost) + " points");
    out.push_back(point);
  }
  return out;
}

}  // namespace nullcone::postrender
