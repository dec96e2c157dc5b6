// A scene: what is there. Plain data, in code units (radians, scene units); read and checked by read_scene.
#pragma once

#include <array>
#include <limits>
#include <map>
#include <memory>
#include <string>
#include <string_view>
#include <vector>

#include "core/base/camera.h"
#include "core/base/channels.h"
#include "core/scene/mesh.h"
#include "core/scene/solid.h"

namespace nullcone {

using Event = std::array<double, 4>;   ///< (t, x, y, z)
using Triple = std::array<double, 3>;  ///< spatial components

/// In which frame an observer's directions and velocity are given.
enum class ObserverFrame {
  at_rest,  ///< the static tetrad
  normal,  ///< of the observers at right angles to the surfaces of equal chart time: exist in black holes too
};

/// How an observer or an object moves, from an event on.
struct Motion {
  enum class Type {
    geodesic,
    accelerated,  ///< by a constant acceleration along its own axes
    circular,     ///< round the chart's z axis at a constant rate
    piecewise,    ///< one geodesic after the other; the first and the last without end
    tabulated     ///< through given events, smoothly; only between the first and the last
  };
  /// Circular: with `speed` in the static tetrad, as a geodesic, or so that chart time stands still.
  enum class Pace { speed, free, closed };

  Type type = Type::geodesic;
  Event event = {0, 0, 0, 0};
  Triple velocity = {0, 0, 0}, acceleration = {0, 0, 0};
  Pace pace = Pace::speed;
  double speed = 0;
  bool clockwise = false;

  /// Piecewise: a local velocity in the static tetrad where the piece begins, and how long it takes, in
  /// proper time.
  struct Piece {
    Triple velocity = {0, 0, 0};
    double duration = 0;
  };
  std::vector<Piece> pieces = {};
  std::vector<Event> events = {};  ///< tabulated
};

struct Observer {
  Event event = {0, 0, 0, 0};
  Triple velocity = {0, 0, 0};  ///< local velocity in the frame, in units of c
  ObserverFrame frame = ObserverFrame::at_rest;
  bool moves = false;  ///< event and velocity, and the camera's axes, follow from the motion
  Motion motion;
  double proper_time = 0;  ///< since the motion's event
};

/// The Runge-Kutta pairs that integrate rays (core/trace/steppers.h).
enum class Integrator { dopri5, verner65, prince_dormand87, fehlberg78 };
inline constexpr std::array<std::string_view, 4> kIntegratorNames = {"dopri5", "verner65", "prince_dormand87",
                                                                     "fehlberg78"};

/// How carefully rays are integrated: a step's error stays below rtol of the spacetime's local length scale
/// (and of the momentum), plus atol in scene units.
struct Accuracy {
  double rtol = 1e-8, atol = 0;
  Integrator integrator = Integrator::prince_dormand87;
};
/// What scenes may name; set by the study in docs/accuracy.md.
inline constexpr Accuracy kDraft{1e-4, 0, Integrator::verner65}, kBalanced{}, kReference{1e-12};

enum class ShapeType { sphere, quad, box, solid, mesh, sky };

/// Shapes in their own frame: a sphere or a box about the origin; a quad in the xy plane, centred, normal +z;
/// the sky at infinity, by direction.
struct Shape {
  ShapeType type = ShapeType::sphere;
  double radius = 0;                        ///< sphere
  bool dome = false;                        ///< sphere, solid or mesh: seen from inside
  std::array<double, 3> edges = {0, 0, 0};  ///< box: lengths along x, y and z; quad: along x and y
  std::shared_ptr<const Solid> solid;       ///< any other body, and what is made of several
  std::shared_ptr<const Mesh> mesh;
  unsigned sky = 1;  ///< sky: of which infinity, from 1
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
  /// Local: it turns about an axis of its own, from these axes at proper time 0.
  Triple spin_axis = {0, 0, 1};
  double spin = 0;  ///< radians a unit of proper time
};

struct Course;  // core/trace/course.h

struct Object {
  std::string name;
  Shape shape;
  Placing placing;
  /// Where the worldline is no geodesic: its event stands in the placing, too.
  std::shared_ptr<const Motion> motion;
  std::shared_ptr<const Course> course;  ///< made of the motion when the scene is prepared
  double opacity = 1;                    ///< channel A
  bool transparent = false;              ///< what stands behind it is recorded too
};

/// A lamp: a point on a worldline, or a small rigid shape about it whose surface shines evenly.
struct Lamp {
  std::string name;
  Placing placing;                  ///< local; the axes are those of a quad
  ShapeType type = ShapeType::sky;  ///< sphere or quad; anything else: a point
  double radius = 0;                ///< sphere
  std::array<double, 2> edges{};    ///< quad: lengths along x and y; it shines to both sides
  std::uint32_t samples = 1;        ///< points on the shape that stand for it
  std::uint32_t body = 0;  ///< number from 1 of the object that casts no shadow in its light; 0: none

  bool is_point() const { return type != ShapeType::sphere && type != ShapeType::quad; }
};

/// What shines on surfaces, and which light is written down.
struct Lights {
  std::vector<Lamp> lamps;
  int windings = 1;     ///< how often light may go round on its way
  int paths = 2;        ///< written down a lamp and crossing: the brightest
  bool shadows = true;  ///< whether objects stand in the way
  double cap = 1e12;    ///< E is at most this: on caustics the light of points is infinite

  /// Of all lamps together.
  std::size_t all_paths() const { return lamps.size() * static_cast<std::size_t>(paths); }
};

/// What is written down of a ray.
struct Records {
  std::uint32_t max_hits = 0;  ///< crossings a ray, also behind opaque surfaces; 0: all up to an opaque one
  std::uint32_t max_order = kAnyOrder;  ///< most caustics that a ray may have passed
  ChannelSet channels = kDefaultChannels;

  static constexpr std::uint32_t kAnyOrder = UINT32_MAX;
};

struct Scene {
  std::string metric;
  std::map<std::string, double> metric_parameters;
  Observer observer;
  Camera camera;
  double max_lookback = 0;  ///< in lambda; infinity where rays may escape
  /// In coordinate time: rays end where they first are so much earlier than the observation.
  double max_lookback_t = std::numeric_limits<double>::infinity();
  bool integrated = false;  ///< rays are integrated, not taken from closed forms
  Accuracy accuracy = kBalanced;
  std::vector<Object> objects;
  Lights lights;
  Records records;
  std::string canonical;  ///< canonical JSON of the whole scene
  std::string sha256;     ///< of the canonical JSON without its look
};

}  // namespace nullcone
