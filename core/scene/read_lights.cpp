#include "core/scene/read_lights.h"

#include <algorithm>
#include <set>
#include <string>

#include "core/scene/read_placing.h"

namespace nullcone {

namespace {

constexpr int kMostPaths = 16, kMostPathsOfAll = 64;  // of a lamp, of all lamps: 1 KiB a crossing

/// What shines, and how many points stand for it.
void read_shape(JsonObject shape, Lamp& lamp) {
  const std::string type = shape.word("type", {"point", "sphere", "quad"}, "point");
  if (type == "sphere") {
    lamp.type = ShapeType::sphere;
    lamp.radius = read_radius(shape);
  } else if (type == "quad") {
    lamp.type = ShapeType::quad;
    const auto edges = shape.numbers("edges", 2, 1e-300, kLargest);
    std::ranges::copy(edges, lamp.edges.begin());
  }
  shape.finish();
}

/// The number of the object by that name.
std::uint32_t read_body(JsonObject& lamp, const std::vector<Object>& objects) {
  const std::string name = lamp.text("body");
  const auto found = std::ranges::find(objects, name, &Object::name);
  if (found == objects.end()) lamp.refuse("body", "expected the name of an object of the scene");
  if (found->shape.type == ShapeType::sky)
    lamp.refuse("body", "is the sky; expected an object that a lamp can be in");
  return static_cast<std::uint32_t>(found - objects.begin()) + 1;
}

Lamp read_lamp(JsonObject lamp, const std::vector<Object>& objects, std::set<std::string>& taken) {
  Lamp out;
  out.name = lamp.name("name", taken);
  out.placing.worldline = read_worldline(lamp);
  out.placing.gyroscope_axes = !out.placing.worldline.is_static();
  read_shape(lamp.object_or_empty("shape"), out);
  if (!out.is_point())
    out.samples = lamp.has("samples") ? static_cast<std::uint32_t>(lamp.integer("samples", 1, 4096)) : 16;
  if (out.type == ShapeType::quad) read_axes(lamp, out.placing, !out.placing.worldline.is_static());
  if (lamp.has("body")) out.body = read_body(lamp, objects);
  lamp.finish();
  return out;
}

}  // namespace

Lights read_lights(JsonObject lights, const std::vector<Object>& objects) {
  Lights out;
  if (lights.has("windings")) out.windings = static_cast<int>(lights.integer("windings", 1, 64));
  if (lights.has("paths")) out.paths = static_cast<int>(lights.integer("paths", 1, kMostPaths));
  out.shadows = lights.boolean("shadows", out.shadows);
  out.cap = lights.number_or("cap", out.cap, 1e-30, 1e30);  // floats can hold it
  std::set<std::string> names;
  for (JsonObject& lamp : lights.objects("lamps")) out.lamps.push_back(read_lamp(lamp, objects, names));
  if (out.lamps.empty()) lights.refuse("lamps", "is empty; expected at least one lamp");
  if (out.all_paths() > kMostPathsOfAll)
    lights.refuse("lamps", "expected at most " + std::to_string(kMostPathsOfAll / out.paths) +
                               " lamps with " + std::to_string(out.paths) +
                               " paths each, so that there are at most " + std::to_string(kMostPathsOfAll) +
                               " in all");
  lights.finish();
  return out;
}

}  // namespace nullcone
