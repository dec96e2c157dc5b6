#include <cstdio>
#include <iostream>

#include "apps/info.h"
#include "core/base/error.h"

namespace nullcone {

namespace {

using Row = std::vector<std::string>;

std::string digits(double x) {
  std::array<char, 40> text{};
  std::snprintf(text.data(), text.size(), "%.7g", x + 0.0);  // no -0
  return text.data();
}

/// A value in words: "(1, 2)", "type perspective, fov_rad (1, 2)"; `infinite` stands for what JSON cannot
/// say.
std::string words(const Report& value, const std::string& infinite = "none", bool outermost = true) {
  if (value.is_null()) return infinite;
  if (value.is_string()) return printable(value.get<std::string>(), 200);
  if (value.is_number_float()) return digits(value.get<double>());
  if (!value.is_structured()) return value.dump();
  std::string out;
  for (const auto& [key, entry] : value.items())
    out += (out.empty() ? "" : ", ") + (value.is_object() ? printable(key, 60) + " " : "") +
           words(entry, infinite, false);
  return value.is_array() || !outermost ? "(" + out + ")" : out;
}

/// Columns below each other.
void print_table(const std::vector<Row>& rows, const std::string& indent) {
  std::vector<std::size_t> widths;
  for (const Row& row : rows)
    for (std::size_t i = 0; i < row.size(); ++i) {
      if (i == widths.size()) widths.push_back(0);
      widths[i] = std::max(widths[i], row[i].size());
    }
  for (const Row& row : rows) {
    std::string line = indent;
    for (std::size_t i = 0; i < row.size(); ++i)
      line += row[i] + std::string(i + 1 < row.size() ? widths[i] - row[i].size() + 2 : 0, ' ');
    line.erase(line.find_last_not_of(' ') + 1);
    std::cout << line << '\n';
  }
}

/// The entries of a list of objects with equal keys, below their keys.
void print_records(const Report& records, const std::string& indent, const std::string& infinite) {
  std::vector<Row> rows;
  for (const Report& record : records) {
    if (rows.empty()) {
      rows.emplace_back();
      for (const auto& [key, value] : record.items()) rows[0].push_back(key);
    }
    rows.emplace_back();
    for (const auto& [key, value] : record.items()) rows.back().push_back(words(value, infinite));
  }
  print_table(rows, indent);
}

void heading(const std::string& title) { std::cout << '\n' << title << '\n'; }

std::string window_text(const Report& report) {
  const Report& window = report["window"];
  const int first = window["first_line"], lines = window["lines"], height = report["height"];
  std::string out = "all scan lines";
  if (lines < height)
    out = "scan lines " + std::to_string(first) + " to " + std::to_string(first + lines - 1) + " of " +
          std::to_string(height);
  if (report["partial"])
    out += "; INTERRUPTED after " + words(window["traced_lines"]) + " of " + std::to_string(lines) +
           ": nullcone-trace --resume goes on";
  return out;
}

std::string status_text(const Report& statuses) {
  std::uint64_t all = 0;
  for (const auto& [name, count] : statuses.items()) all += count.get<std::uint64_t>();
  std::string out;
  for (const auto& [name, count] : statuses.items()) {
    const auto n = count.get<std::uint64_t>();
    if (n == 0) continue;
    std::array<char, 40> share{};
    std::snprintf(share.data(), share.size(), " (%.3g %%)",
                  100 * static_cast<double>(n) / static_cast<double>(all));
    out += (out.empty() ? "" : ", ") + std::to_string(n) + " " + name + share.data();
  }
  return out;
}

void print_header(const Report& report) {
  const std::string n = words(report["samples"]),
                    rays = n == "1" ? "a ray each" : n + " x " + n + " rays each";
  std::vector<Row> rows = {
      {"picture", words(report["width"]) + " x " + words(report["height"]) + " pixels, " + rays},
      {"window", window_text(report)},
      {"rays", status_text(report["status"])},
      {"crossings",
       words(report["hits"]["count"]) + ", at most " + words(report["hits"]["max_per_pixel"]) + " a pixel"},
      {"metric", words(report["metric"])}};
  if (report["setting"].is_object())
    for (const auto& [key, value] : report["setting"].items())
      if (!value.empty())
        rows.push_back({key == "metric_parameters" ? "parameters" : printable(key, 40), words(value)});
  rows.push_back({"made by", words(report["version"]) + " (" + words(report["isa"]) + ") on " +
                                 words(report["host"]) + ", " + words(report["core_seconds"]) +
                                 " core-seconds in " + words(report["seconds"]) + " s"});
  rows.push_back({"format", words(report["format"])});
  rows.push_back({"scene", "sha256 " + words(report["scene_sha256"])});
  rows.push_back({"hits", "sha256 " + words(report["payload"]["hits"])});
  rows.push_back({"rays", "sha256 " + words(report["payload"]["rays"])});
  print_table(rows, "  ");
}

/// Empty for pure numbers.
std::string unit_of(const std::string& channel) {
  const auto in = [](const auto& table, const std::string& name) {
    const auto found = std::ranges::find(table, name, &ChannelInfo::name);
    return found == table.end() || found->unit == "1" ? "" : std::string(found->unit);
  };
  return channel.starts_with("light.") ? in(kLightChannelInfo, channel.substr(channel.rfind('.') + 1))
                                       : in(kHitChannelInfo, channel);
}

void print_channels(const Report& report) {
  std::vector<Row> rows = {{"name", "least", "greatest", "unit"}};
  const Report& ranges = report["hits"]["ranges"];
  for (const std::string name : report["channels"]) {
    const bool any = ranges.contains(name);
    rows.push_back(
        {name, any ? words(ranges[name][0]) : "none", any ? words(ranges[name][1]) : "none", unit_of(name)});
  }
  heading(std::string("channels of the crossings, finite values") +
          (report["lights"].empty() ? "" : "; shift, t and tau of light where any arrives"));
  print_table(rows, "  ");
}

void print_quality(const Report& quality) {
  heading("quality of the rays");
  std::vector<Row> rows = {{"", "median", "99 % below", "greatest"}};
  for (const char* key : {"steps", "error", "drift"})
    rows.push_back({key, words(quality[key]["median"], "inf"),
                    quality[key].contains("p99") ? words(quality[key]["p99"], "inf") : "",
                    words(quality[key]["max"], "inf")});
  rows.push_back({"doubtful", words(quality["doubtful"])});
  print_table(rows, "  ");
  if (quality["worst"].empty()) return;
  heading("worst rays");
  print_records(quality["worst"], "  ", "inf");
}

/// Crossings without their light, and light with the number of its crossing.
std::pair<Report, Report> apart(Report hits) {
  Report light = Report::array();
  for (std::size_t i = 0; i < hits.size(); ++i) {
    if (!hits[i].contains("lights")) continue;
    for (const auto& [lamp, paths] : hits[i]["lights"].items())
      for (std::size_t path = 0; path < paths.size(); ++path) {
        Report row = {{"crossing", i}, {"lamp", lamp}, {"path", path}};
        row.update(paths[path]);
        light.push_back(row);
      }
    hits[i].erase("lights");
  }
  return {hits, light};
}

}  // namespace

void print_summary(const std::string& path, const Report& report) {
  std::cout << printable(path, 1000) << '\n';
  print_header(report);
  heading("objects");
  print_records(report["objects"], "  ", "none");
  if (!report["lights"].empty()) {
    heading("lamps, " + words(report["light_paths"]) +
            " paths each; lit: paths with light, capped: as bright as a caustic may be");
    print_records(report["lights"], "  ", "none");
  }
  print_channels(report);
  print_quality(report["quality"]);
}

void print_pixel(const Report& report) {
  std::cout << "pixel " << words(report["pixel"][0]) << "," << words(report["pixel"][1]) << '\n';
  print_records(report["rays"].is_array() ? report["rays"] : Report::array({report["rays"]}), "  ", "inf");
  heading(report["hits"].empty() ? "no crossings" : "crossings, nearest first");
  const auto [hits, light] = apart(report["hits"]);
  print_records(hits, "  ", "inf");
  if (light.empty()) return;
  heading("light, by the number of the crossing from 0");
  print_records(light, "  ", "inf");
}

}  // namespace nullcone
