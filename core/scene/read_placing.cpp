#include "core/scene/read_placing.h"

#include <algorithm>
#include <cmath>
#include <numbers>
#include <string>

#include "core/scene/read_motion.h"

namespace nullcone {

namespace {

template <std::size_t N>
std::array<double, N> to_array(const std::vector<double>& values) {
  std::array<double, N> out{};
  std::copy_n(values.begin(), N, out.begin());
  return out;
}

double dot(const Triple& a, const Triple& b) { return a[0] * b[0] + a[1] * b[1] + a[2] * b[2]; }

}  // namespace

std::array<Triple, 3> read_directions(JsonObject& object) {
  const Triple z = read_direction(object, "z_axis", {0, 0, 1}),
               wish = read_direction(object, "y_axis", {0, 1, 0});
  Triple x = cross(wish, z);
  const double length = std::sqrt(dot(x, x));
  if (!(length > 1e-9)) object.refuse("y_axis", "expected a direction that is not parallel to z_axis");
  for (double& component : x) component /= length;
  return {x, cross(z, x), z};
}

double read_radius(JsonObject& shape) {
  const double out = shape.positive("radius");
  if (out > kLargest) shape.refuse("radius", "expected at most 1e15");
  return out;
}

Triple read_direction(JsonObject& object, std::string_view key, const std::vector<double>& fallback) {
  const auto v = to_array<3>(object.numbers_or(key, fallback, -kLargest, kLargest));
  const double length = std::sqrt(dot(v, v));
  if (!(length > 1e-100)) object.refuse(key, "expected a direction, found (almost) zero");
  return {v[0] / length, v[1] / length, v[2] / length};
}

Event read_event(JsonObject& object, std::string_view key) {
  return to_array<4>(object.numbers(key, 4, -kLargest, kLargest));
}

Triple read_velocity(JsonObject& object, std::string_view key) {
  const auto v = to_array<3>(object.numbers_or(key, {0, 0, 0}, -1, 1));
  if (!(dot(v, v) < 1)) object.refuse(key, "is not slower than light; expected a length below 1");
  return v;
}

Worldline read_worldline(JsonObject& object) {
  JsonObject worldline = object.object("worldline");
  Worldline out;
  const std::string type = worldline.word("type", {"static", "geodesic"});
  out.event = read_event(worldline, "event");
  if (type == "geodesic") out.velocity = read_velocity(worldline, "velocity");
  worldline.finish();
  return out;
}

void read_axes(JsonObject& object, Placing& placing, bool moves) {
  if (placing.type == PlacingType::local)
    placing.gyroscope_axes =
        object.word("axes", {"gyroscope", "static"}, moves ? "gyroscope" : "static") == "gyroscope";
  placing.axes = read_directions(object);
}

void read_spin(JsonObject& object, Placing& placing) {
  if (!object.has("spin")) return;
  JsonObject spin = object.object("spin");
  placing.spin_axis = read_direction(spin, "axis", {0, 0, 1});
  placing.spin = spin.number("rate_deg", -kLargest, kLargest) * std::numbers::pi / 180;
  spin.finish();
}

void read_placing(JsonObject placing, Object& object) {
  Placing& out = object.placing;
  if (placing.word("type", {"coordinate", "local"}) == "coordinate") {
    out.type = PlacingType::coordinate;
    const auto centre = placing.numbers("centre", 3, -kLargest, kLargest);
    out.worldline.event = {0, centre[0], centre[1], centre[2]};
  } else {
    out.type = PlacingType::local;
    std::vector<std::string> types = motion_types();
    types.insert(types.begin(), "static");
    const std::string type = placing.object("worldline").word("type", types);
    if (type == "static" || type == "geodesic") {
      out.worldline = read_worldline(placing);
    } else {
      object.motion = std::make_shared<const Motion>(read_motion(placing.object("worldline")));
      out.worldline.event = object.motion->event;
    }
    read_spin(placing, out);
  }
  read_axes(placing, out, object.motion != nullptr || !out.worldline.is_static());
  placing.finish();
}

}  // namespace nullcone
