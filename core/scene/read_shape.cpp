#include "core/scene/read_shape.h"

#include <algorithm>

#include "core/scene/read_mesh.h"
#include "core/scene/read_placing.h"
#include "core/scene/read_solid.h"

namespace nullcone {

namespace {

void read_sky(JsonObject& shape, const MetricDescription& metric, Shape& out) {
  out.type = ShapeType::sky;
  out.sky = shape.has("side") ? static_cast<unsigned>(shape.integer("side", 1, 2)) : 1;
  if (out.sky > static_cast<unsigned>(std::max(metric.skies, 1)))
    shape.refuse("side", "the spacetime '" + std::string(metric.name) + "' has only one sky");
  if (metric.skies == 0)
    shape.refuse("type", "the spacetime '" + std::string(metric.name) +
                             "' has no infinity to hold a sky; use a sphere with \"dome\": true");
}

void read_edges(JsonObject& shape, std::size_t count, Shape& out) {
  out.type = count == 2 ? ShapeType::quad : ShapeType::box;
  const double least = count == 2 ? 1e-300 : kLeastLength;  // a box is one size, dome or not, alone or joined
  std::ranges::copy(shape.numbers("edges", count, least, kLargest), out.edges.begin());
}

}  // namespace

Shape read_shape(JsonObject shape, const MetricDescription& metric, const std::string& scene,
                 MeshShelf& meshes, MeshHashes& hashes) {
  Shape out;
  const std::string type = shape.word("type", {"sphere", "ellipsoid", "box", "cylinder", "disk", "ring",
                                               "quad", "union", "intersection", "difference", "mesh", "sky"});
  if (type == "sky") {
    read_sky(shape, metric, out);
  } else if (type == "quad") {
    read_edges(shape, 2, out);
  } else {
    if (type != "disk" && type != "ring") out.dome = shape.boolean("dome", false);
    if (type == "sphere") {
      out.radius = read_radius(shape);
    } else if (type == "box" && !out.dome) {
      read_edges(shape, 3, out);
    } else if (type == "mesh") {
      out.type = ShapeType::mesh;
      out.mesh = read_mesh(shape, scene, meshes, hashes);
    } else {
      out.type = ShapeType::solid;
      out.solid = read_solid(shape, type);
    }
    const bool open = (out.solid && !out.solid->closed()) || (out.mesh && !out.mesh->closed);
    if (out.dome && open) shape.refuse("dome", "expected a closed shape");
  }
  shape.finish();
  return out;
}

}  // namespace nullcone
