// The cold side of a kernel: a spacetime by name, one virtual call a band of pixels.
#pragma once

#include <cstdint>
#include <memory>
#include <span>
#include <string_view>
#include <vector>

#include "core/base/status.h"
#include "core/scene/read_scene.h"

namespace nullcone {

/// One crossing, in full precision; files keep floats of it (core/base/channels.h has the meanings).
struct HitRecord {
  std::uint32_t pixel;  ///< within the band
  std::uint32_t id, order;
  double Z, u, v, shift, t, tau, mu;
};

/// What a crossing tells on request: the channels duv, N, K, P.
struct HitDetail {
  std::array<double, 4> duv{};  ///< du/dx, dv/dx, du/dy, dv/dy; x and y in pixels
  Triple N{}, K{}, P{};
};

/// Light that reaches a crossing along one path from a lamp (kLightChannelInfo has the meanings).
struct HitLight {
  double E = 0, shift = 1, t = 0, tau = 0;
};

struct RayRecord {
  std::uint32_t status, steps;
  float error, drift;
};

/// Room for crossings; `details` and `lights` may be null. Of lights there are `paths` entries a crossing:
/// all lamps' paths, lamp by lamp.
struct HitRoom {
  HitRecord* hits;
  HitDetail* details;
  HitLight* lights = nullptr;
  std::size_t paths = 0;
};

/// Takes the crossings of a band: by pixel, those of a pixel by Z. Kernels hold no containers, so memory is
/// the caller's affair.
class HitSink {
 public:
  virtual ~HitSink();
  /// Room for `count` crossings behind those that are kept.
  virtual HitRoom extend(std::size_t count) = 0;
  /// The first `count` crossings of the last room are kept.
  virtual void keep(std::size_t count) = 0;
};

/// Room for the records of a band: one ray a pixel.
struct BandRoom {
  HitSink& hits;
  std::span<RayRecord> rays;
};

/// A scene made ready for one kernel. Immutable: any number of threads may trace bands of it.
class Tracer {
 public:
  virtual ~Tracer();
  /// Traces `lines` (<= kBandLines) scan lines from `first_line` on.
  virtual void trace_band(int first_line, int lines, const BandRoom& room) const = 0;
  /// Proper time that the channel `tau` of object number `object` (from 0) counts from.
  virtual double tau_origin(std::size_t object) const = 0;
  /// By how much lengths within object number `object` (from 0) are off, relatively: its frame is right to
  /// first order where the spacetime has no rigid motions.
  virtual double distortion(std::size_t object) const = 0;
  /// How often, in all bands so far, light of a lamp may have been missed.
  virtual std::uint64_t light_doubts() const = 0;
  /// Number from 1 of an opaque object that holds lamp number `lamp` (from 0) at the time of the observation
  /// and is not its body; 0: none.
  virtual std::uint32_t object_about_lamp(std::size_t lamp) const = 0;
  /// Proper time that the channel `light.*.tau` of lamp number `lamp` (from 0) counts from.
  virtual double lamp_tau_origin(std::size_t lamp) const = 0;
};

/// Why an object, a lamp, or the observer, cannot be traced; `limit` is the bounding radius that would do,
/// where that helps.
struct Unfit {
  enum class Thing { object, lamp, observer };
  Thing thing = Thing::object;
  std::size_t number = 0;  ///< of the object or the lamp, from 0
  const char* reason = nullptr;
  double limit = 0;
};

/// A null geodesic from a lamp at rest to an event, as the observer at rest there sees it.
struct ConnectionReport {
  double lambda, travel_time;  ///< affine length with frequency 1 at the event; difference of chart times
  Triple view;                 ///< direction in which the lamp is seen, in the static tetrad
  double area_distance;        ///< sqrt |det D|, with its vertex at the event
  int parity;                  ///< sign of det D: -1 after an odd number of caustics
  int winding;                 ///< how often the light goes round, from 0
};
struct ConnectionsReport {
  std::vector<ConnectionReport> connections;  ///< by affine length
  bool complete = true;                       ///< false: some may have been missed
};

/// Where a camera's ray starts, and its past-directed tangent there in the tetrad of `frame`; the frequency
/// is 1 for the camera.
struct CameraRayReport {
  Event event, past;
  ObserverFrame frame;
};

struct GeodesicPoint {
  double lambda;
  Event event, tangent;
  Status status = Status::hit;  ///< how an integrated ray ended before it came so far; `hit`: it did not
};
struct NamedValue {
  std::string_view name;
  double value;
};

/// A compiled kernel: stateless; the metric's parameters are given with each call, in the order of
/// parameters().
class Spacetime {
 public:
  virtual ~Spacetime();
  virtual MetricDescription description() const = 0;
  virtual std::string_view isa() const = 0;
  virtual double default_lookback(std::span<const double> parameters) const = 0;

  /// Axes e_0 … e_3 of the static tetrad at an event, in chart components.
  virtual std::array<Event, 4> static_tetrad(std::span<const double> parameters,
                                             const Event& event) const = 0;
  /// The same of the observers of `frame`.
  virtual std::array<Event, 4> observer_tetrad(std::span<const double> parameters, const Event& event,
                                               ObserverFrame frame) const = 0;
  /// The ray through picture coordinates (x, y).
  virtual CameraRayReport camera_ray(std::span<const double> parameters, const Camera& camera,
                                     const Observer& observer, double x, double y) const = 0;
  /// Gamma^mu_ab u^a v^b at an event: what parallel transport along u takes from v.
  virtual Event connection(std::span<const double> parameters, const Event& event, const Event& u,
                           const Event& v) const = 0;
  /// Covariant components of g at an event, rows first.
  virtual std::array<Event, 4> metric(std::span<const double> parameters, const Event& event) const = 0;
  /// The geodesic with tangent k (components in the static tetrad, or in that of `frame` where it is
  /// integrated) at the event, at each affine parameter: by its closed form, or integrated where there is
  /// none or `accuracy` is given.
  virtual std::vector<GeodesicPoint> geodesic(std::span<const double> parameters, const Event& event,
                                              const Event& k, std::span<const double> lambda,
                                              const Accuracy* accuracy = nullptr,
                                              ObserverFrame frame = ObserverFrame::at_rest) const = 0;
  /// All null geodesics that reach the event from a lamp at rest at `source`, of up to `windings` windings:
  /// by closed forms, or by shooting where there are none.
  virtual ConnectionsReport connect(std::span<const double> parameters, const Event& event,
                                    const Triple& source, int windings) const = 0;
  /// Evaluates the closed form (or where there is none, the right-hand side) at `count` affine parameters
  /// `step` apart, as wide as the kernel is, and sums what it finds: the yardstick of benchmarks.
  virtual double walk(std::span<const double> parameters, const Event& event, const Event& k, double step,
                      std::size_t count) const = 0;
  /// Constants of motion of the geodesic through the point.
  virtual std::vector<NamedValue> conserved(std::span<const double> parameters,
                                            const GeodesicPoint& point) const = 0;

  /// Makes a scene ready, or fills `unfit` and returns nothing.
  virtual std::unique_ptr<Tracer> prepare(std::span<const double> parameters, const Scene& scene,
                                          Unfit& unfit) const = 0;
};

}  // namespace nullcone
