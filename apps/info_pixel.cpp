#include "apps/info.h"
#include "core/base/error.h"

namespace nullcone {

namespace {

/// Number of the scan line in the file's window. Throws InputError.
int line_in_window(const Manifest& m, int x, int y) {
  const auto size = std::to_string(m.width) + " x " + std::to_string(m.height) + " pixels";
  if (x < 0 || x >= m.width || y < 0 || y >= m.height)
    throw InputError("--pixel", "lies outside the picture of " + size);
  if (y < m.first_line || y >= m.first_line + m.lines)
    throw InputError("--pixel", "lies outside the window: scan lines " + std::to_string(m.first_line) +
                                    " to " + std::to_string(m.first_line + m.lines - 1) +
                                    " of a picture of " + size);
  return y - m.first_line;
}

Report ray_record(const Rays& rays, std::size_t i) {
  return {{"status", status_name(rays.status[i])},
          {"steps", rays.steps[i]},
          {"error", number(rays.error[i])},
          {"drift", number(rays.drift[i])}};
}

/// A pixel of scan lines that are in memory.
struct PixelPlace {
  std::size_t row, column;
};

/// One record, or with samples a list of them; null where rays were left out.
Report ray_records(const Manifest& m, const Rays& rays, PixelPlace at) {
  if (rays.status.empty()) return nullptr;
  const auto n = static_cast<std::size_t>(m.samples), wide = n * static_cast<std::size_t>(m.width);
  const std::size_t first = at.row * n * wide + at.column * n;
  if (n == 1) return ray_record(rays, first);
  Report out = Report::array();
  for (std::size_t row = 0; row < n; ++row)
    for (std::size_t column = 0; column < n; ++column) {
      Report ray = {{"sample", row * n + column}};
      ray.update(ray_record(rays, first + row * wide + column));
      out.push_back(ray);
    }
  return out;
}

/// By lamp the paths along which light comes.
Report light_record(const Manifest& m, const Hits& hits, std::uint64_t k) {
  Report out = Report::object();
  auto path = hits.light.begin();
  for (const ObjectEntry& lamp : m.lights) {
    Report& paths = out[lamp.name] = Report::array();
    for (int i = 0; i < m.light_paths; ++i, ++path)
      if (path->E[k] != 0)
        paths.push_back({{"E", number(path->E[k])},
                         {"shift", number(path->shift[k])},
                         {"t", number(path->t[k])},
                         {"tau", number(path->tau[k])}});
  }
  return out;
}

/// Channels of a group with more than one become a list under its name; `id` becomes the object's name.
Report hit_record(const Manifest& m, const Hits& hits, std::uint64_t k) {
  Report out;
  for_each_channel(
      [&](const ChannelInfo& channel, const auto& column) {
        const std::string group(channel.group());
        if (group == "light") return;  // below
        if (channel.name == "id") {
          const std::size_t id = hits.id[k];
          out["object"] =
              id >= 1 && id <= m.objects.size() ? Report(m.objects[id - 1].name) : Report(nullptr);
        } else if (channel.name == channel.group()) {
          out[group] = number(column[k]);
        } else {
          out[group].push_back(number(column[k]));
        }
      },
      hits);
  if (!hits.light.empty()) out["lights"] = light_record(m, hits, k);
  return out;
}

Report hit_records(const Manifest& m, const Hits& hits, PixelPlace at) {
  const std::size_t pixel = at.row * static_cast<std::size_t>(m.width) + at.column;
  Report out = Report::array();
  for (std::uint64_t k = hits.offset[pixel]; k < hits.offset[pixel + 1]; ++k)
    out.push_back(hit_record(m, hits, k));
  return out;
}

}  // namespace

Report pixel_records(DatasetReader& reader, int x, int y) {
  const Manifest& m = reader.manifest();
  const Band line = reader.band(line_in_window(m, x, y), 1);
  const PixelPlace at{0, static_cast<std::size_t>(x)};
  return {
      {"pixel", {x, y}}, {"rays", ray_records(m, line.rays, at)}, {"hits", hit_records(m, line.hits, at)}};
}

Report pixel_records(const Dataset& dataset, int x, int y) {
  const Manifest& m = dataset.manifest;
  const PixelPlace at{static_cast<std::size_t>(line_in_window(m, x, y)), static_cast<std::size_t>(x)};
  return {{"pixel", {x, y}},
          {"rays", ray_records(m, dataset.rays, at)},
          {"hits", hit_records(m, dataset.hits, at)}};
}

}  // namespace nullcone
