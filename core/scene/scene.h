// A scene: what is there. Plain data, in code units (radians, scene units); read and checked by read_scene.
#pragma once

#include <array>
#include <map>
#include <string>
#include <vector>

#include "core/base/camera.h"

namespace nullcone {

using Event = std::array<double, 4>;   ///< (t, x, y, z)
using Triple = std::array<double, 3>;  ///< spatial components

struct Observer {
  Event event = {0, 0, 0, 0};
  Triple velocity = {0, 0, 0};  ///< local velocity in the static tetrad, in units of c
};

enum class ShapeType { sphere, quad, sky };

/// Shapes in their own frame: a sphere about the origin; a quad in the xy plane, centred, normal +z; the sky
/// at infinity, by direction.
struct Shape {
  ShapeType type = ShapeType::sphere;
  double radius = 0;                     ///< sphere
  bool dome = false;                     ///< sphere: seen from inside
  std::array<double, 2> edges = {0, 0};  ///< quad: lengths along x and y
};

enum class PlacingType {
  coordinate,  ///< fixed in the chart
  local,       ///< rigid in the frame of a worldline
};

/// A geodesic; with zero velocity that of an observer at rest.
struct Worldline {
  Event event = {0, 0, 0, 0};
  Triple velocity = {0, 0, 0};  ///< local velocity in the static tetrad at `event`, in units of c

  bool is_static() const { return velocity == Triple{0, 0, 0}; }
};

struct Placing {
  PlacingType type = PlacingType::local;
  Worldline worldline;          ///< local; for coordinate objects only the place of `event` counts
  bool gyroscope_axes = false;  ///< local: parallel-transported axes; otherwise tied to the static tetrad
  /// Rows: the object's x, y and z axes in the rest frame (boosted static axes) at proper time 0;
  /// orthonormal.
  std::array<Triple, 3> axes = {{{1, 0, 0}, {0, 1, 0}, {0, 0, 1}}};
};

struct Object {
  std::string name;
  Shape shape;
  Placing placing;
};

struct Scene {
  std::string metric;
  std::map<std::string, double> metric_parameters;
  Observer observer;
  Camera camera;
  double max_lookback = 0;  ///< in lambda; infinity where rays may escape
  std::vector<Object> objects;
  std::string canonical;  ///< canonical JSON of the whole scene
  std::string sha256;     ///< of the canonical JSON without its look
};

}  // namespace nullcone
