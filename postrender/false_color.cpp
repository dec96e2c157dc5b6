#include "postrender/false_color.h"

#include <algorithm>
#include <array>
#include <charconv>
#include <cmath>

#include "core/base/error.h"
#include "postrender/color.h"

namespace nullcone::postrender {

namespace {

using Srgb = std::array<double, 3>;

/// Between control points in sRGB, which is near enough to even steps for the eye.
template <std::size_t N>
Rgb between(const std::array<Srgb, N>& points, double x) {
  const double at = std::clamp(x, 0.0, 1.0) * (N - 1);
  const std::size_t i = std::min(static_cast<std::size_t>(at), N - 2);
  const double s = at - static_cast<double>(i);
  const auto mixed = [&](std::size_t c) {
    return static_cast<float>(srgb_decoded((1 - s) * points[i][c] + s * points[i + 1][c]));
  };
  return {mixed(0), mixed(1), mixed(2)};
}

/// For Status: how a ray ended. Doubtful ones stand out.
constexpr std::array<Srgb, kStatusNames.size()> kStatusColors = {{{0.93, 0.90, 0.80},
                                                                  {0.40, 0.65, 0.90},
                                                                  {0.10, 0.20, 0.40},
                                                                  {0.85, 0.60, 0.20},
                                                                  {0.45, 0.35, 0.65},
                                                                  {0.90, 0.10, 0.10},
                                                                  {1.00, 0.20, 0.85},
                                                                  {0.30, 0.30, 0.30},
                                                                  {0.05, 0.05, 0.05}}};

Rgb category_color(const std::string& channel, float value) {
  const auto number = static_cast<std::uint32_t>(value);
  if (channel != "status") return default_color(channel == "id" ? number : number + 1);
  const Srgb& c = kStatusColors[std::min<std::size_t>(number, kStatusColors.size() - 1)];
  return {static_cast<float>(srgb_decoded(c[0])), static_cast<float>(srgb_decoded(c[1])),
          static_cast<float>(srgb_decoded(c[2]))};
}

bool is_logarithmic(ScaleKind kind) { return kind == ScaleKind::logarithmic || kind == ScaleKind::shift; }

/// The given fractions of the values in order; they are reordered.
Range percentiles(std::vector<float>& values, double low, double high) {
  const auto at = [&](double fraction) {
    const auto place =
        values.begin() + static_cast<std::ptrdiff_t>(std::lround(fraction * double(values.size() - 1)));
    std::nth_element(values.begin(), place, values.end());
    return static_cast<double>(*place);
  };
  const double first = at(low);
  return {first, at(high)};
}

/// A range of some width around equal ends.
Range widened(Range range, ScaleKind kind) {
  if (range.first < range.second) return range;
  const double x = range.first;
  if (is_logarithmic(kind)) return {x / 1.1, x * 1.1};
  return {x - 0.5 * std::max(1.0, 1e-6 * std::abs(x)), x + 0.5 * std::max(1.0, 1e-6 * std::abs(x))};
}

Range automatic_range(const ChannelInfo& channel, ScaleKind kind, std::span<const float> values) {
  std::vector<float> found;
  for (const float x : values)
    if (std::isfinite(x) && (x > 0 || !is_logarithmic(kind))) found.push_back(x);
  if (found.empty()) return widened({1, 1}, kind);
  const bool trimmed = is_logarithmic(kind) || channel.group() == "duv";
  Range range = percentiles(found, trimmed ? 0.01 : 0, trimmed ? 0.99 : 1);
  if (kind == ScaleKind::shift) range = {std::min(range.first, 1.0), std::max(range.second, 1.0)};
  if (range.first == range.second && channel.range == "0 to 1") return {0, 1};
  return widened(range, kind);
}

}  // namespace

Rgb sequential_color(double x) {
  // Nine points of "viridis" (S. van der Walt and N. Smith, 2015, public domain), rounded.
  static constexpr std::array<Srgb, 9> kPoints = {{{0.267, 0.005, 0.329},
                                                   {0.279, 0.175, 0.483},
                                                   {0.230, 0.322, 0.546},
                                                   {0.173, 0.449, 0.558},
                                                   {0.128, 0.567, 0.551},
                                                   {0.158, 0.684, 0.502},
                                                   {0.369, 0.789, 0.383},
                                                   {0.678, 0.864, 0.190},
                                                   {0.993, 0.906, 0.144}}};
  return between(kPoints, x);
}

Rgb diverging_color(double x) {
  static constexpr std::array<Srgb, 7> kPoints = {{{0.40, 0.00, 0.10},
                                                   {0.77, 0.20, 0.20},
                                                   {0.96, 0.66, 0.55},
                                                   {1.00, 1.00, 1.00},
                                                   {0.58, 0.75, 0.95},
                                                   {0.18, 0.42, 0.80},
                                                   {0.03, 0.13, 0.42}}};
  return between(kPoints, 0.5 + 0.5 * x);
}

Rgb ColorScale::color(float value) const {
  if (std::isnan(value)) return kMissing;
  if (kind == ScaleKind::categories) return category_color(channel, value);
  if (std::isinf(value)) return kInfinite;
  if (kind == ScaleKind::logarithmic && value <= 0) return kZero;
  const auto x = static_cast<double>(value);
  if (kind != ScaleKind::shift) return sequential_color(place(x));
  // Both sides alike, so that equal distances from white are equal factors.
  const double farthest = std::max(std::abs(std::log(range.first)), std::abs(std::log(range.second)));
  return diverging_color(x > 0 ? std::log(x) / farthest : -1);
}

double ColorScale::place(double value) const {
  const auto [from, to] = range;
  if (is_logarithmic(kind)) return std::log(value / from) / std::log(to / from);
  return (value - from) / (to - from);
}

ScaleKind scale_kind(const ChannelInfo& channel) {
  if (channel.name == "status" || channel.name == "id" || channel.name == "order")
    return ScaleKind::categories;
  if (channel.name == "error" || channel.name == "drift" || channel.name == "E")
    return ScaleKind::logarithmic;
  return channel.name == "shift" ? ScaleKind::shift : ScaleKind::linear;
}

ColorScale choose_scale(const ChannelInfo& channel, std::span<const float> values,
                        const std::optional<Range>& range) {
  ColorScale scale{scale_kind(channel), {0, 1}, std::string(channel.name)};
  if (range && scale.kind == ScaleKind::categories)
    throw InputError("--range", "channel '" + scale.channel + "' has a colour for each number, no range");
  if (range && is_logarithmic(scale.kind) && range->first <= 0)
    throw InputError("--range",
                     "channel '" + scale.channel + "' is shown by its logarithm; expected 0 < a < b");
  if (scale.kind != ScaleKind::categories)
    scale.range = range ? *range : automatic_range(channel, scale.kind, values);
  return scale;
}

Range parse_range(const std::string& text) {
  std::array<double, 2> ends{};
  const char *at = text.data(), *const end = text.data() + text.size();
  bool right = true;
  for (std::size_t i = 0; i < 2 && right; ++i) {
    const auto [next, error] = std::from_chars(at, end, ends[i]);
    right = error == std::errc() && std::isfinite(ends[i]) &&
            (i == 0 ? next != end && *next == ',' : next == end);
    at = next + 1;
  }
  if (!right || !(ends[0] < ends[1]))
    throw InputError("--range " + printable(text, 40), "expected two numbers a,b with a < b");
  return {ends[0], ends[1]};
}

}  // namespace nullcone::postrender
