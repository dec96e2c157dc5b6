#include "postrender/legend.h"

#include <algorithm>
#include <cmath>
#include <cstdio>
#include <set>

#include "postrender/canvas.h"

namespace nullcone::postrender {

namespace {

constexpr int kLeastWidth = 360, kMostCategories = 40;
constexpr Rgb kPaper = {0.005f, 0.005f, 0.005f}, kInk = {0.8f, 0.8f, 0.8f};

/// A patch of colour and what it means.
struct Entry {
  Rgb color;
  std::string text;
};

/// Where things go below the picture, in pixels; `scale` is the size of a dot of the font.
struct Layout {
  int width, scale;
  int margin() const { return 6 * scale; }
  int inner() const { return width - 2 * margin(); }
  int columns() const { return std::max(1, inner() / text_width("x", scale)); }
};

std::vector<std::string> wrapped(const std::string& text, int columns) {
  std::vector<std::string> out = {""};
  for (std::size_t at = 0; at < text.size();) {
    const std::size_t end = std::min(text.find(' ', at), text.size());
    const std::string word = text.substr(at, end - at);
    if (!out.back().empty() && static_cast<int>(out.back().size() + 1 + word.size()) > columns)
      out.emplace_back();
    out.back() += (out.back().empty() ? "" : " ") + word;
    at = end + 1;
  }
  return out;
}

std::string category_name(const std::string& channel, std::uint32_t number, const Manifest& manifest) {
  if (channel == "status" && number < kStatusNames.size()) return std::string(kStatusNames[number]);
  if (channel == "id" && number >= 1 && number <= manifest.objects.size())
    return manifest.objects[number - 1].name;
  return std::to_string(number);
}

/// What has no place along the bar but occurs in the picture: all categories, and special values.
std::vector<Entry> entries_of(const ColorScale& scale, const Manifest& manifest,
                              std::span<const float> values) {
  std::set<std::uint32_t> numbers;
  bool missing = false, infinite = false, zero = false;
  for (const float x : values) {
    if (scale.kind == ScaleKind::categories && std::isfinite(x))
      numbers.insert(static_cast<std::uint32_t>(x));
    missing |= std::isnan(x);
    infinite |= std::isinf(x);
    zero |= scale.kind == ScaleKind::logarithmic && x <= 0;
  }
  std::vector<Entry> out;
  for (const std::uint32_t number : numbers) {
    if (static_cast<int>(out.size()) == kMostCategories) break;
    out.push_back({scale.color(static_cast<float>(number)), category_name(scale.channel, number, manifest)});
  }
  if (static_cast<int>(numbers.size()) > kMostCategories) out.push_back({kPaper, "..."});
  if (zero) out.push_back({kZero, "0"});
  if (infinite) out.push_back({kInfinite, "infinite"});
  if (missing) out.push_back({kMissing, "none"});
  return out;
}

/// Lays the entries out in lines, or only measures them where there is no canvas. Returns the height.
int draw_entries(Canvas* canvas, const Layout& at, int top, const std::vector<Entry>& entries) {
  if (entries.empty()) return 0;
  const int line = text_height(at.scale), patch = 7 * at.scale, gap = 4 * at.scale;
  int x = at.margin(), y = top;
  for (const Entry& entry : entries) {
    const int width = patch + gap + text_width(entry.text, at.scale);
    if (x > at.margin() && x + width > at.width - at.margin()) x = at.margin(), y += line;
    if (canvas != nullptr) {
      canvas->fill(x - at.scale, y - at.scale, patch + 2 * at.scale, patch + 2 * at.scale, kInk);
      canvas->fill(x, y, patch, patch, entry.color);
      canvas->write(x + patch + gap, y, entry.text, kInk, at.scale);
    }
    x += width + 2 * gap;
  }
  return y + line - top;
}

int bar_height(const Layout& at) { return 14 * at.scale + text_height(at.scale); }

void draw_bar(Canvas& canvas, const Layout& at, int top, const ColorScale& scale) {
  const int height = 10 * at.scale, left = at.margin(), wide = at.inner();
  const auto [from, to] = scale.range;
  const bool logarithmic = scale.kind != ScaleKind::linear;
  for (int x = 0; x < wide; ++x) {
    const double s = (x + 0.5) / wide,
                 value = logarithmic ? from * std::pow(to / from, s) : from + s * (to - from);
    canvas.fill(left + x, top, 1, height, scale.color(static_cast<float>(value)));
  }
  int free = 0;  // from here on no text stands yet
  for (const double tick : ticks(scale, std::max(2, at.columns() / 10))) {
    const int x = left + static_cast<int>(std::lround(scale.place(tick) * (wide - 1)));
    const std::string text = tick_text(tick);
    const int width = text_width(text, at.scale),
              start = std::clamp(x - width / 2, at.scale, std::max(at.scale, at.width - width));
    canvas.fill(x, top + height, at.scale, 3 * at.scale, kInk);
    if (start < free) continue;
    canvas.write(start, top + height + 4 * at.scale, text, kInk, at.scale);
    free = start + width + 4 * at.scale;
  }
}

/// Whether a number has a place along the bar.
bool stands_on(const ColorScale& scale, float value) {
  if (scale.kind == ScaleKind::categories || !std::isfinite(value)) return false;
  return scale.kind == ScaleKind::linear || value > 0;
}

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

Image false_color_picture(const ColorScale& scale, const ChannelInfo& channel, const Manifest& manifest,
                          std::span<const float> values) {
  // Step 1: how much room the legend takes.
  const int width = std::max(manifest.width, kLeastWidth);
  const Layout at{width, std::clamp(width / 600, 1, 6)};
  const std::string unit = channel.unit == "1" ? "" : " [" + std::string(channel.unit) + "]";
  const auto title = wrapped(scale.channel + unit + ": " + std::string(channel.meaning), at.columns());
  const std::vector<Entry> entries = entries_of(scale, manifest, values);
  const bool bar = std::ranges::any_of(values, [&](float x) { return stands_on(scale, x); });
  const int titles = static_cast<int>(title.size()) * text_height(at.scale);
  const int legend =
      2 * at.margin() + titles + (bar ? bar_height(at) : 0) + draw_entries(nullptr, at, 0, entries);
  // Step 2: the picture.
  Canvas canvas(width, manifest.lines + legend, kPaper);
  for (int y = 0; y < manifest.lines; ++y)
    for (int x = 0; x < manifest.width; ++x)
      canvas.set(x, y,
                 scale.color(values[static_cast<std::size_t>(y) * static_cast<std::size_t>(manifest.width) +
                                    static_cast<std::size_t>(x)]));
  // Step 3: the legend.
  int y = manifest.lines + at.margin();
  for (const std::string& line : title) {
    canvas.write(at.margin(), y, line, kInk, at.scale);
    y += text_height(at.scale);
  }
  if (bar) draw_bar(canvas, at, y, scale);
  if (bar) y += bar_height(at);
  draw_entries(&canvas, at, y, entries);
  return {canvas.width, canvas.height, 1, canvas.pixels, canvas.pixels, {}};
}

}  // namespace nullcone::postrender
