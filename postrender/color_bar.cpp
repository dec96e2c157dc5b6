#include "postrender/color_bar.h"

#include <algorithm>
#include <array>
#include <cmath>
#include <cstdio>

namespace nullcone::postrender {

namespace {

double round_step(double rough) {
  const double power = std::pow(10, std::floor(std::log10(rough)));
  for (const double step : {1.0, 2.0, 5.0})
    if (step * power >= rough * (1 - 1e-9)) return step * power;
  return 10 * power;
}

}  // namespace

std::vector<double> ticks(const ColorScale& scale, int most) {
  const auto [from, to] = scale.range;
  std::vector<double> out;
  const bool logarithmic = scale.kind == ScaleKind::logarithmic || scale.kind == ScaleKind::shift;
  const double decades = logarithmic ? std::log10(to / from) : 0;
  if (decades >= 0.7) {
    // Powers of ten; between them 2 and 5 if there is room.
    const int stride = static_cast<int>(std::ceil((decades + 1) / most));
    const bool finer = 3 * (decades + 1) <= most;
    for (int k = static_cast<int>(std::floor(std::log10(from))); k <= std::log10(to); k += 1)
      for (const double digit : {1.0, 2.0, 5.0}) {
        const double value = digit * std::pow(10, k);
        if ((digit == 1 ? k % stride == 0 : finer) && value >= from && value <= to) out.push_back(value);
      }
    return out;
  }
  const double step = round_step((to - from) / most);
  for (double k = std::ceil(from / step - 1e-9); k * step <= to + 1e-9 * step; ++k) out.push_back(k * step);
  return out;
}

std::string tick_text(double value) {
  std::array<char, 32> text{};
  std::snprintf(text.data(), text.size(), "%.6g", value == 0 ? 0.0 : value);
  std::string out = text.data();
  const std::size_t e = out.find('e');
  if (e == std::string::npos) return out;
  std::string power = out.substr(e + 2);
  power.erase(0, std::min(power.find_first_not_of('0'), power.size() - 1));
  return out.substr(0, e + 1) + (out[e + 1] == '-' ? "-" : "") + power;
}

int bar_height(int scale) { return (kBarDots + 4) * scale + text_height(scale); }

std::vector<double> bar_values(const ColorScale& scale, int width) {
  const auto [from, to] = scale.range;
  std::vector<double> out;
  for (int x = 0; x < width; ++x) {
    const double s = (x + 0.5) / width;
    out.push_back(scale.kind == ScaleKind::linear ? from + s * (to - from) : from * std::pow(to / from, s));
  }
  return out;
}

void draw_bar(Canvas& canvas, const BarPlace& at, const ColorScale& scale, std::span<const Rgb> colors,
              Rgb ink) {
  for (int x = 0; x < at.width; ++x)
    canvas.fill(at.left + x, at.top, 1, kBarDots * at.scale, colors[static_cast<std::size_t>(x)]);
  const int bottom = at.top + kBarDots * at.scale, columns = at.width / text_width("x", at.scale);
  int free = 0;  // from here on no text stands yet
  for (const double tick : ticks(scale, std::max(4, columns / 10))) {
    const int x = at.left + static_cast<int>(std::lround(scale.place(tick) * (at.width - 1)));
    const std::string text = tick_text(tick);
    const int width = text_width(text, at.scale),
              start = std::clamp(x - width / 2, at.scale, std::max(at.scale, canvas.width - width));
    canvas.fill(x, bottom, at.scale, 3 * at.scale, ink);
    if (start < free) continue;
    canvas.write(start, bottom + 4 * at.scale, text, ink, at.scale);
    free = start + width + 4 * at.scale;
  }
}

}  // namespace nullcone::postrender
