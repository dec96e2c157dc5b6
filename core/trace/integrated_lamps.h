// Lamps among integrated rays: connections by closed forms where the spacetime has them, else by shooting.
#pragma once

#include <atomic>

#include "core/trace/illumination.h"
#include "core/trace/lamp_scan.h"
#include "core/trace/march_object.h"

NULLCONE_KERNEL_BEGIN

/// The worldline of a point of a rigid lamp at rest, in a spacetime without isometries.
template <Metric M>
struct RestLine {
  M metric;
  TangentBody body{};
  Vec3<double> X{};

  template <class S>
  Vec4<S> event(const S& tau) const {
    return body.event(tau, convert<S>(X));
  }
};

/// Lamps whose light is found by shooting.
template <Metric M>
class ScannedLamps {
 public:
  /// Sweeps the light cones of all points of all lamps, near the objects.
  bool place(const M& metric, const Scene& scene, const MarchObject<M>* objects, std::size_t count,
             Unfit& unfit) {
    const Lights& lights = scene.lights;
    lamps_.reset(new PlacedLamp<RestLine<M>>[lights.lamps.size()]);
    scans_.reset(new std::unique_ptr<std::unique_ptr<LampScan<M>>[]>[lights.lamps.size()]);
    for (std::size_t i = 0; i < lights.lamps.size(); ++i) {
      const Lamp& lamp = lights.lamps[i];
      unfit = {
          Unfit::Thing::lamp, i,
          "moves or turns like a gyroscope; in a spacetime without isometries a lamp must be at rest, with "
          "\"axes\": \"static\"",
          0};
      if (!lamp.placing.worldline.is_static() || lamp.placing.gyroscope_axes) return false;
      place_lamp(metric, scene, lamp, lamps_[i]);
      unfit.reason = "stands where nothing can be at rest";
      if (!std::isfinite(lamps_[i].lines[0].event(0.0)[0])) return false;
      const std::unique_ptr<Ball[]> targets(new Ball[count + 1]);
      std::size_t used = 0;
      for (std::size_t k = 0; k < count; ++k)
        if (objects[k].number != lamp.body) targets[used++] = {objects[k].centre, objects[k].chart_ball};
      scans_[i].reset(new std::unique_ptr<LampScan<M>>[lamps_[i].count]);
      for (std::size_t k = 0; k < lamps_[i].count; ++k)
        scans_[i][k].reset(new LampScan<M>(metric, scene.accuracy, lamps_[i].lines[k].event(0.0),
                                           lights.windings, scene.max_lookback, targets.get(), used));
    }
    return true;
  }

  bool is_body(std::size_t lamp, std::uint32_t object) const { return lamps_[lamp].body == object; }
  double tau_origin(std::size_t lamp) const { return lamps_[lamp].clock.at_observation; }
  Vec4<double> event_at_observation(std::size_t lamp) const {
    return lamps_[lamp].lines[0].event(lamps_[lamp].clock.origin);
  }
  /// How often light may have been missed so far.
  std::uint64_t doubts() const { return doubts_.load(); }

  /// All lamps, for a group of crossings with object `own`; see NULLCONE_ISA::illuminate.
  template <class S, class Group, class LetThrough>
  void illuminate(const LightRules& rules, const LitPoint<S>& lit, const Group& group, std::uint32_t own,
                  double t0, const LetThrough& let_through, const HitRoom& to) const {
    const std::unique_ptr<Found<S>> found(new Found<S>);
    for (std::size_t number = 0; number < rules.lamps; ++number) {
      const PlacedLamp<RestLine<M>>& lamp = lamps_[number];
      if (lamp.body == own) continue;
      std::array<PathLight<S>, kMost> sums{};
      std::size_t used = 0;
      for (std::size_t i = 0; i < lamp.count; ++i) {
        const std::size_t count = connect(*scans_[number][i], lit, group, *found);
        for (std::size_t k = 0; k < count; ++k)
          add_light(
              lit, found->rank(k), lamp.weight, rules.cap,
              [&](const Connection<S>& c) { return lamp.emission(lamp.lines[i], c); },
              [&](const Connection<S>& c, const Mask<S>& wanted) {
                return let_through(c, wanted, lamp.body);
              },
              sums[k]);
        used = std::max(used, count);
      }
      for (std::size_t k = 0; k < used; ++k)
        scatter_light(sums[k], group, number, rules, t0, lamp.clock.origin, to);
    }
  }

 private:
  static void place_lamp(const M& metric, const Scene& scene, const Lamp& lamp,
                         PlacedLamp<RestLine<M>>& out) {
    const double observation = scene.observer.event[0];
    out = PlacedLamp<RestLine<M>>(lamp);
    const Placing placing = from_observation<M>(lamp.placing, observation);
    const RestLine<M> line{
        metric, tangent_body(metric, Vec4<double>{placing.worldline.event}, axes_of(placing)), {}};
    const double since = observation - lamp.placing.worldline.event[0];
    out.clock = clock_of<M>(lamp.placing, since / line.body.tetrad.e[0][0]);
    for (std::size_t k = 0; k < out.count; ++k) {
      out.lines[k] = line;
      if (!lamp.is_point()) out.lines[k].X = lamp_point(lamp, k, out.count);
    }
  }

  static constexpr std::size_t kMost = LampScan<M>::kMostConnections;

  /// The connections of a group of events with one point of a lamp.
  template <class S>
  struct Found {
    static constexpr std::size_t kWidth = Lanes<S>::count;
    std::array<Connection<double>, kWidth * kMost> connections;
    std::array<int, kWidth * kMost> winding;
    std::array<std::size_t, kWidth> count{};
    std::array<bool, kWidth> complete{};

    /// Those of rank k in affine length, side by side.
    Connection<S> rank(std::size_t k) const {
      const auto gather = [&](auto&& f) {
        std::array<double, kWidth> values{};
        for (std::size_t i = 0; i < kWidth; ++i)
          if (k < count[i]) values[i] = f(connections[i * kMost + k]);
        return Lanes<S>::load(values.data());
      };
      const auto gather4 = [&](auto&& f) {
        return Vec4<S>::map(
            [&](std::size_t c) { return gather([&](const auto& one) { return f(one)[c]; }); });
      };
      using C = Connection<double>;
      return {gather([](const C&) { return 1.0; }) > S(0.0), gather4([](const C& c) { return c.past; }),
              gather([](const C& c) { return c.lambda; }),   gather([](const C& c) { return c.tau; }),
              gather([](const C& c) { return c.det; }),      gather4([](const C& c) { return c.emitted; }),
              gather4([](const C& c) { return c.tangent; })};
    }
  };

  /// Returns the greatest number of connections of an event.
  template <class S, class Group>
  std::size_t connect(const LampScan<M>& scan, const LitPoint<S>& lit, const Group& group,
                      Found<S>& out) const {
    std::array<Vec4<double>, Lanes<S>::count> events{};
    for (std::size_t i = 0; i < group.filled; ++i) events[i] = lane_of(lit, i).event;
    out.count = {};
    scan.connect(events.data(), group.filled,
                 {out.connections.data(), out.winding.data(), kMost, out.count.data(), out.complete.data()});
    std::size_t most = 0;
    for (std::size_t i = 0; i < group.filled; ++i) {
      most = std::max(most, out.count[i]);
      if (!out.complete[i]) doubts_.fetch_add(1, std::memory_order_relaxed);
    }
    return most;
  }

  std::unique_ptr<PlacedLamp<RestLine<M>>[]> lamps_;
  std::unique_ptr<std::unique_ptr<std::unique_ptr<LampScan<M>>[]>[]> scans_;
  mutable std::atomic<std::uint64_t> doubts_ = 0;
};

/// Lamps whose light is found by closed forms.
template <Metric M>
class ConnectedLamps {
 public:
  bool place(const M& metric, const Scene& scene, const MarchObject<M>*, std::size_t, Unfit& unfit) {
    metric_ = metric;
    lamps_.reset(new PlacedLamp<LampLine<M>>[scene.lights.lamps.size()]);
    return place_lamps(metric, scene.lights, scene.observer.event[0], lamps_.get(), unfit);
  }
  bool is_body(std::size_t lamp, std::uint32_t object) const { return lamps_[lamp].body == object; }
  double tau_origin(std::size_t lamp) const { return lamps_[lamp].clock.at_observation; }
  Vec4<double> event_at_observation(std::size_t lamp) const {
    return lamps_[lamp].lines[0].event(lamps_[lamp].clock.origin);
  }
  std::uint64_t doubts() const { return 0; }

  template <class S, class Group, class LetThrough>
  void illuminate(const LightRules& rules, const LitPoint<S>& lit, const Group& group, std::uint32_t,
                  double t0, const LetThrough& let_through, const HitRoom& to) const {
    NULLCONE_ISA::illuminate(metric_, lamps_.get(), rules, lit, group, t0, let_through, to);
  }

 private:
  M metric_;
  std::unique_ptr<PlacedLamp<LampLine<M>>[]> lamps_;
};

/// Where neither is to be had.
template <Metric M>
class NoLamps {
 public:
  bool place(const M&, const Scene&, const MarchObject<M>*, std::size_t, Unfit& unfit) {
    unfit = {Unfit::Thing::lamp, 0, "cannot shine: light of lamps is found in stationary spacetimes only", 0};
    return false;
  }
  bool is_body(std::size_t, std::uint32_t) const { return false; }
  double tau_origin(std::size_t) const { return 0; }
  Vec4<double> event_at_observation(std::size_t) const { return {}; }
  std::uint64_t doubts() const { return 0; }

  template <class S, class Group, class LetThrough>
  void illuminate(const LightRules&, const LitPoint<S>&, const Group&, std::uint32_t, double,
                  const LetThrough&, const HitRoom&) const {}
};

template <Metric M>
struct LampsOf {
  using Type = NoLamps<M>;
};
template <Metric M>
requires(!HasConnections<M> && is_stationary<M>()) struct LampsOf<M> {
  using Type = ScannedLamps<M>;
};
template <HasConnections M>
requires Metric<M>
struct LampsOf<M> {
  using Type = ConnectedLamps<M>;
};

NULLCONE_KERNEL_END
