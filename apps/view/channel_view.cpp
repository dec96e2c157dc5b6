#include "apps/view/channel_view.h"

#include <tbb/parallel_for.h>

#include <algorithm>
#include <array>
#include <cmath>
#include <cstdio>

#include "core/base/error.h"
#include "postrender/channel_values.h"
#include "postrender/color.h"
#include "postrender/color_bar.h"
#include "postrender/legend.h"

namespace nullcone::view {

namespace {

namespace pr = postrender;
using nlohmann::ordered_json;

constexpr int kBarColors = 64, kMostTicks = 6;
constexpr std::size_t kMostCategories = 256;

/// Calls f(of, info) for every channel that there is; the name in `info` ends with the call.
template <class F>
void for_each_shown(const Manifest& manifest, F&& f) {
  for (const ChannelInfo& info : kRayChannelInfo) f("rays", info);
  const Hits hits = empty_hits(manifest);
  for_each_channel([&](const ChannelInfo& info, const auto&) { f("hits", info); }, hits);
}

pr::ChannelChoice choose(const Manifest& manifest, const std::string& name) {
  std::string all;
  bool found = false;
  for_each_shown(manifest, [&](const char*, const ChannelInfo& info) {
    found |= info.name == name;
    all += (all.empty() ? "" : ", ") + std::string(info.name);
  });
  if (!found)
    throw InputError("channel", "there is no '" + printable(name, 40) + "'; expected one of " + all);
  return pr::find_channel(name, manifest, "dataset");
}

void check_range(const pr::Range& range, const ChannelInfo& channel) {
  const auto [from, to] = range;
  const pr::ScaleKind kind = pr::scale_kind(channel);
  if (kind == pr::ScaleKind::categories)
    throw InputError("from", "this channel has a colour for each number, no range");
  if (!(std::isfinite(from) && std::isfinite(to) && from < to))
    throw InputError("from", "expected two finite numbers, from less than to");
  if (kind != pr::ScaleKind::linear && from <= 0)
    throw InputError("from", "this channel is shown by its logarithm; expected a number above 0");
}

std::string kind_name(pr::ScaleKind kind) {
  switch (kind) {
    case pr::ScaleKind::logarithmic:
      return "logarithmic";
    case pr::ScaleKind::shift:
      return "shift";
    case pr::ScaleKind::categories:
      return "categories";
    case pr::ScaleKind::linear:
      break;
  }
  return "linear";
}

std::string hex(pr::Rgb color) {
  const pr::Srgb8Table& encode = pr::Srgb8Table::instance();
  std::array<char, 8> out{};
  std::snprintf(out.data(), out.size(), "#%02x%02x%02x", encode(color.r), encode(color.g), encode(color.b));
  return out.data();
}

void add_bar(ordered_json& legend, const pr::ColorScale& scale) {
  legend["from"] = scale.range.first;
  legend["to"] = scale.range.second;
  for (const double value : pr::ticks(scale, kMostTicks))
    legend["ticks"].push_back(
        {{"value", value}, {"text", pr::tick_text(value)}, {"place", scale.place(value)}});
  for (const double value : pr::bar_values(scale, kBarColors))
    legend["colors"].push_back(hex(scale.color(static_cast<float>(value))));
  if (scale.kind == pr::ScaleKind::logarithmic) legend["zero"] = hex(pr::kZero);
}

void add_categories(ordered_json& legend, const pr::ColorScale& scale, const Manifest& manifest,
                    std::span<const float> values) {
  for (const std::uint32_t number : pr::categories_in(values)) {
    if (legend["categories"].size() == kMostCategories) break;
    legend["categories"].push_back({{"value", number},
                                    {"text", pr::category_name(scale.channel, number, manifest)},
                                    {"color", hex(scale.color(static_cast<float>(number)))}});
  }
}

ordered_json legend_of(const pr::ChannelChoice& choice, const pr::ColorScale& scale, const Manifest& manifest,
                       std::span<const float> values) {
  ordered_json out = {{"name", choice.name},
                      {"unit", std::string(choice.info.unit)},
                      {"meaning", std::string(choice.info.meaning)},
                      {"kind", kind_name(scale.kind)}};
  for (const char* list : {"ticks", "colors", "categories"}) out[list] = ordered_json::array();
  if (scale.kind == pr::ScaleKind::categories)
    add_categories(out, scale, manifest, values);
  else
    add_bar(out, scale);
  out["missing"] = hex(pr::kMissing);
  out["infinite"] = hex(pr::kInfinite);
  return out;
}

std::vector<std::uint8_t> colored(const pr::ColorScale& scale, std::span<const float> values) {
  const pr::Srgb8Table& encode = pr::Srgb8Table::instance();
  std::vector<std::uint8_t> out(3 * values.size());
  tbb::parallel_for(tbb::blocked_range<std::size_t>(0, values.size(), 4096), [&](const auto& part) {
    std::array<std::uint8_t, 3> code{};
    for (std::size_t i = part.begin(); i < part.end(); ++i) {
      if (i == part.begin() || values[i] != values[i - 1]) {
        const pr::Rgb color = scale.color(values[i]);
        code = {encode(color.r), encode(color.g), encode(color.b)};
      }
      std::ranges::copy(code, &out[3 * i]);
    }
  });
  return out;
}

}  // namespace

ChannelView view_channel(const Dataset& dataset, const std::string& name,
                         const std::optional<std::pair<double, double>>& range) {
  const Manifest& manifest = dataset.manifest;
  const pr::ChannelChoice choice = choose(manifest, name);
  if (range) check_range(*range, choice.info);
  const bool has_rays = dataset.rays.status.size() == manifest.rays();
  const auto values =
      choice.of_rays && !has_rays ? std::vector<float>{} : pr::channel_values(choice, dataset);
  if (values.size() != dataset.pixels())
    throw InputError("channel", "'" + choice.name + "' was not read of this dataset");
  const pr::ColorScale scale = pr::choose_scale(choice.info, values, range);
  return {manifest.width, manifest.lines, colored(scale, values), legend_of(choice, scale, manifest, values)};
}

ordered_json channel_list(const Manifest& manifest) {
  ordered_json out = ordered_json::array();
  for_each_shown(manifest, [&](const char* of, const ChannelInfo& info) {
    out.push_back({{"name", std::string(info.name)},
                   {"of", of},
                   {"unit", std::string(info.unit)},
                   {"meaning", std::string(info.meaning)}});
  });
  return out;
}

}  // namespace nullcone::view
