#include "apps/geodesic_report.h"

#include <charconv>
#include <cmath>
#include <nlohmann/json.hpp>

#include "core/base/status.h"

namespace nullcone {

namespace {

using json = nlohmann::ordered_json;

/// JSON has no NaN and no infinity. (Plus 0: no minus sign before a zero.)
json number(double x) { return std::isfinite(x) ? json(x + 0.0) : json(nullptr); }

json conserved_entry(const Ray& ray, const GeodesicPoint& point) {
  json out = json::object();
  for (const auto& [name, value] : ray.conserved(point)) out[std::string(name)] = number(value);
  return out;
}

json point_entry(const Inquiry& inquiry, const Ray& ray, const GeodesicPoint& point) {
  json out = {{"lambda", number(point.lambda)},
              {"event", json::array()},
              {"tangent", json::array()},
              {"status", status_word(point)}};
  for (std::size_t i = 0; i < 4; ++i) {
    out["event"].push_back(number(point.event[i]));
    out["tangent"].push_back(number(point.tangent[i]));
  }
  if (inquiry.traced) {
    out["H"] = number(0.5 * ray.square(point));  // the camera's frequency is 1
    out["conserved"] = conserved_entry(ray, point);
  } else if (inquiry.integrated()) {
    out["square"] = number(ray.square(point));
  }
  return out;
}

void add_ray(const Inquiry& inquiry, const Ray& ray, json& out) {
  out["points"] = json::array();
  for (const GeodesicPoint& point : ray.at(inquiry.lambda))
    out["points"].push_back(point_entry(inquiry, ray, point));
  out["conserved"] = conserved_entry(ray, ray.at(0.0));
}

json crossings(const TracedPixel& traced) {
  json out = json::array();
  for (const HitRecord& hit : traced.hits)
    out.push_back({{"object", traced.scene.objects[hit.id - 1].name},
                   {"lambda", number(hit.Z)},
                   {"order", hit.order},
                   {"uv", {number(hit.u), number(hit.v)}},
                   {"shift", number(hit.shift)},
                   {"t", number(hit.t)},
                   {"tau", number(hit.tau)},
                   {"mu", number(hit.mu)}});
  return out;
}

/// Shortest text that reads back as the same number.
std::string shortest(double x) {
  if (std::isnan(x)) return "nan";
  std::array<char, 40> text{};
  return {text.data(), std::to_chars(text.data(), text.data() + text.size(), x + 0.0).ptr};
}

struct Column {
  std::string name;
  std::string value;
};
using Row = std::vector<Column>;

Row point_row(const Inquiry& inquiry, const Member& member, const GeodesicPoint& point) {
  static constexpr std::array<const char*, 8> kNames = {"t", "x", "y", "z", "k_t", "k_x", "k_y", "k_z"};
  Row row;
  if (!inquiry.parameter_name.empty()) row.push_back({inquiry.parameter_name, shortest(member.parameter)});
  row.push_back({"lambda", shortest(point.lambda)});
  for (std::size_t i = 0; i < 8; ++i)
    row.push_back({kNames[i], shortest(i < 4 ? point.event[i] : point.tangent[i - 4])});
  const double square = member.ray.square(point);
  row.push_back(inquiry.traced ? Column{"H", shortest(0.5 * square)} : Column{"square", shortest(square)});
  for (const auto& [name, value] : member.ray.conserved(point))
    row.push_back({std::string(name), shortest(value)});
  row.push_back({"status", status_word(point)});
  return row;
}

/// What was recorded where the ray ends; empty in all other rows.
void add_crossing(const TracedPixel& traced, bool last, Row& row) {
  const bool met = last && !traced.hits.empty();
  const HitRecord hit = met ? traced.hits.back() : HitRecord{};
  row.push_back({"object", met ? traced.scene.objects[hit.id - 1].name : ""});
  const auto add = [&](const char* name, double value) { row.push_back({name, met ? shortest(value) : ""}); };
  add("u", hit.u);
  add("v", hit.v);
  add("shift", hit.shift);
  add("hit_t", hit.t);
  add("hit_tau", hit.tau);
  add("mu", hit.mu);
}

void write_line(const Row& row, std::string Column::*what, std::ostream& out) {
  for (std::size_t i = 0; i < row.size(); ++i) out << (i == 0 ? "" : ",") << row[i].*what;
  out << '\n';
}

}  // namespace

void write_json(const Inquiry& inquiry, std::ostream& out) {
  json report = {{"metric", inquiry.spacetime->description().name}};
  if (inquiry.traced) {
    const TracedPixel& traced = *inquiry.traced;
    const RayRecord& record = traced.record;
    report["pixel"] = traced.pixel;
    report["rays"] = {{"status", kStatusNames[record.status]},
                      {"steps", record.steps},
                      {"error", number(static_cast<double>(record.error))},
                      {"drift", number(static_cast<double>(record.drift))}};
    report["crossings"] = crossings(traced);
  }
  if (inquiry.parameter_name.empty()) {
    add_ray(inquiry, inquiry.members[0].ray, report);
  } else {
    report["family"] = inquiry.parameter_name;
    report["members"] = json::array();
    for (const Member& member : inquiry.members) {
      json entry = {{inquiry.parameter_name, member.parameter},
                    {"event", member.ray.event},
                    {"direction", {member.ray.k[1], member.ray.k[2], member.ray.k[3]}}};
      add_ray(inquiry, member.ray, entry);
      report["members"].push_back(entry);
    }
  }
  out << report.dump(2) << '\n';
}

void write_csv(const Inquiry& inquiry, std::ostream& out) {
  bool first = true;
  for (const Member& member : inquiry.members) {
    const auto points = member.ray.at(inquiry.lambda);
    for (std::size_t i = 0; i < points.size(); ++i) {
      Row row = point_row(inquiry, member, points[i]);
      if (inquiry.traced) add_crossing(*inquiry.traced, i + 1 == points.size(), row);
      if (std::exchange(first, false)) write_line(row, &Column::name, out);
      write_line(row, &Column::value, out);
    }
  }
}

}  // namespace nullcone
