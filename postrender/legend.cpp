#include "postrender/legend.h"

#include <algorithm>
#include <cmath>
#include <limits>

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

/// What has no place along the bar but occurs in the picture: all categories, and special values.
std::vector<Entry> entries_of(const ColorScale& scale, const Manifest& manifest,
                              std::span<const float> values) {
  bool missing = false, infinite = false, zero = false;
  for (const float x : values) {
    missing |= std::isnan(x);
    infinite |= std::isinf(x);
    zero |= scale.kind == ScaleKind::logarithmic && x <= 0;
  }
  std::vector<Entry> out;
  const std::set<std::uint32_t> numbers =
      scale.kind == ScaleKind::categories ? categories_in(values) : std::set<std::uint32_t>{};
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

/// Whether a number has a place along the bar.
bool stands_on(const ColorScale& scale, float value) {
  if (scale.kind == ScaleKind::categories || !std::isfinite(value)) return false;
  return scale.kind == ScaleKind::linear || value > 0;
}

}  // namespace

std::set<std::uint32_t> categories_in(std::span<const float> values) {
  std::set<std::uint32_t> out;
  float last = std::numeric_limits<float>::quiet_NaN();  // mostly that of the pixel before
  for (const float x : values) {
    if (std::isfinite(x) && x != last) out.insert(static_cast<std::uint32_t>(x));
    last = x;
  }
  return out;
}

std::string category_name(const std::string& channel, std::uint32_t number, const Manifest& manifest) {
  if (channel == "status" && number < kStatusNames.size()) return std::string(kStatusNames[number]);
  if (channel == "id" && number >= 1 && number <= manifest.objects.size())
    return manifest.objects[number - 1].name;
  return std::to_string(number);
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
      2 * at.margin() + titles + (bar ? bar_height(at.scale) : 0) + draw_entries(nullptr, at, 0, entries);
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
  if (bar) {
    std::vector<Rgb> colors;
    for (const double value : bar_values(scale, at.inner()))
      colors.push_back(scale.color(static_cast<float>(value)));
    draw_bar(canvas, {at.margin(), y, at.inner(), at.scale}, scale, colors, kInk);
    y += bar_height(at.scale);
  }
  draw_entries(&canvas, at, y, entries);
  return {canvas.width, canvas.height, 1, canvas.pixels, canvas.pixels, {}};
}

}  // namespace nullcone::postrender
