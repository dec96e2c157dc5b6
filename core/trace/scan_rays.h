// The rays of a lamp's light cone, future-directed, that a scan follows from slice to slice of common affine
// length.
#pragma once

#include "core/trace/direction_mesh.h"
#include "core/trace/varied_ray.h"

NULLCONE_KERNEL_BEGIN

enum class ScanFate : std::uint8_t {
  goes_on,
  stands,  ///< ended within the region of interest, as at a horizon: it stays where it is
  left,    ///< beyond what is asked for
};

struct ScanRay {
  State<double> y{}, before{};  ///< at the end of the slice and at its beginning
  Vec3<double> V{}, V_before{};
  double h = 0, growth = kGrowth, turning = 0, turning_before = 0;
  double end = 0;  ///< an Ending
  ScanFate fate = ScanFate::goes_on, fate_before = ScanFate::goes_on;
  std::uint32_t node = UINT32_MAX, node_before = UINT32_MAX;  ///< in a scan's list
  std::uint32_t slice = 0;                                    ///< for which it was last wanted

  double rate = 1;  ///< dt/dlambda over p_t: how much slower clocks of the chart's time go here

  Vec3<double> X() const { return spatial(to_phase(y).x); }
  void begin_slice() {
    before = y, V_before = V, turning_before = turning, fate_before = fate;
    node_before = std::exchange(node, UINT32_MAX);
  }
};

/// What a scan's rays need to know.
template <Metric M>
struct ScanSetting {
  HamiltonSystem<M> system;
  Accuracy accuracy;
  double reach, inside;  ///< distances from the origin between which rays are of interest
  double most_turning;   ///< angle about the origin, in radians
};

/// The rays of a pack, on their way.
template <class S>
struct ScanPack {
  Flight<S> flight;
  S turning, end = S(0.0);
  Mask<S> stuck;
};

template <class Stepper, Metric M, class S>
void advance_pack(Stepper& stepper, const ScanSetting<M>& setting, ScanPack<S>& pack, const S& target) {
  constexpr double kMostSteps = 400;  // in one slice
  const M& metric = setting.system.metric;
  Flight<S>& flight = pack.flight;
  auto active = flight.lambda < target;
  pack.stuck = active & !active;
  while (any(active)) {
    const S rest = target - flight.lambda, wish = flight.h;
    const Attempt<S> a =
        attempt(stepper, setting.system, setting.accuracy, flight, next_step(metric, flight, rest));
    learn(flight, a, active);
    const auto moves = active & a.accepted, last = moves & (a.h == rest);
    const S angle = angle_between(spatial(to_phase(flight.y).x), spatial(to_phase(a.y1).x));
    pack.turning = select(moves, pack.turning + angle, pack.turning);
    flight.y = select(moves, a.y1, flight.y);
    flight.dy = select(moves, a.dy1, flight.dy);
    flight.lambda = select(moves, select(a.h == rest, target, flight.lambda + a.h), flight.lambda);
    flight.h = select(last, max(wish, flight.h), flight.h);  // cut short by the target, not by its error
    const S end = ending(metric, to_phase(flight.y), to_phase(flight.dy), setting.accuracy.rtol);
    pack.end = select(moves, end, pack.end);
    const auto fallen = (pack.end > S(0.0)) & (pack.end < as_scalar<S>(Ending::sky));
    const Mask<S> refused = !a.accepted, tiny = !(a.h > S(1e-14) * target);
    const auto no_way = (refused & tiny) | (flight.steps >= S(kMostSteps));
    pack.stuck = pack.stuck | (active & no_way);
    active = active & !fallen & !pack.stuck & (flight.lambda < target);
  }
}

/// Close to a horizon that lies ahead in infinite chart time rays creep, and with spin are dragged round and
/// round. From the first rate on nothing is asked of them, at the second they stand.
inline constexpr double kFastRate = 8, kMostRate = 40;

template <Metric M>
ScanFate fate_of(const ScanSetting<M>& setting, const ScanRay& ray, bool stuck) {
  const double end = ray.end;
  const double far = norm(ray.X());
  if constexpr (is_central<M>())
    if (ray.rate > kMostRate) return ScanFate::stands;
  if (stuck || (end != 0 && end < as_scalar<double>(Ending::sky))) return ScanFate::stands;
  const bool escaped = (end == as_scalar<double>(Ending::sky) && far > setting.reach) ||
                       (end == as_scalar<double>(Ending::second_sky) && far < setting.inside);
  return escaped || ray.turning > setting.most_turning ? ScanFate::left : ScanFate::goes_on;
}

/// Takes the listed rays from lambda = `from` to `target`.
template <class S, class Stepper, Metric M>
void advance_rays(Stepper& stepper, const ScanSetting<M>& setting, Pool<ScanRay>& rays,
                  const Pool<std::uint32_t>& list, double from, double target) {
  constexpr std::size_t kWidth = Lanes<S>::count;
  for (std::size_t i = 0; i < list.size(); i += kWidth) {
    const std::size_t filled = std::min(kWidth, list.size() - i);
    const auto gather = [&](auto&& f) {
      std::array<double, kWidth> values{};
      for (std::size_t lane = 0; lane < kWidth; ++lane)
        values[lane] = f(rays[list[i + std::min(lane, filled - 1)]]);
      return Lanes<S>::load(values.data());
    };
    ScanPack<S> pack;
    pack.flight.y =
        State<S>::map([&](std::size_t c) { return gather([&](const ScanRay& r) { return r.y[c]; }); });
    pack.flight.dy = setting.system.rate(pack.flight.y);
    pack.flight.lambda = S(from);
    pack.flight.h = gather([](const ScanRay& r) { return r.h; });
    pack.flight.growth = gather([](const ScanRay& r) { return r.growth; });
    pack.turning = gather([](const ScanRay& r) { return r.turning; });
    advance_pack(stepper, setting, pack, S(target));
    std::array<bool, kWidth> stuck{};
    Lanes<S>::store(pack.stuck, stuck.data());
    for (std::size_t lane = 0; lane < filled; ++lane) {
      ScanRay& ray = rays[list[i + lane]];
      const auto get = [&](const S& x) { return Lanes<S>::get(x, lane); };
      ray.y = State<double>::map([&](std::size_t c) { return get(pack.flight.y[c]); });
      ray.V = Vec3<double>::map([&](std::size_t c) { return get(pack.flight.dy[c + 1]); });
      ray.h = get(pack.flight.h), ray.growth = get(pack.flight.growth), ray.turning = get(pack.turning);
      ray.rate = get(pack.flight.dy[0]) / ray.y[4];
      ray.end = get(pack.end);
      ray.fate = fate_of(setting, ray, stuck[lane]);
    }
  }
}

/// Rays from one place.
template <Metric M>
struct ScanStart {
  Vec4<double> place;
  Tetrad<double> tetrad;  ///< static

  ScanStart(const M& metric, const Vec4<double>& from) : place(from), tetrad(static_tetrad(metric, from)) {}

  /// In a direction of the static tetrad, with frequency 1.
  template <class Stepper>
  ScanRay ray(const Stepper&, const ScanSetting<M>& setting, const Vec3<double>& n) const {
    const M& metric = setting.system.metric;
    const Vec4<double> k = tetrad.to_chart({{1, n[0], n[1], n[2]}});
    ScanRay out;
    out.y = to_state(Phase<double>{place, metric.g(place) * k});
    out.V = spatial(k);
    out.h = first_step<Stepper::kRoots>(metric, out.y, setting.system.rate(out.y), setting.accuracy.rtol);
    return out;
  }
};

/// The Endings of rays.
template <class S, class Stepper, Metric M>
void find_endings(Stepper& stepper, ScanSetting<M> setting, Pool<ScanRay>& rays) {
  setting.reach = 0, setting.inside = kFar, setting.most_turning = kFar;
  double lambda = 0, next = length_scale(setting.system.metric, to_phase(rays[0].y).x) / norm(rays[0].V);
  for (int i = 0; i < 60; ++i) {
    Pool<std::uint32_t> going(rays.size());
    for (std::uint32_t k = 0; k < rays.size(); ++k)
      if (rays[k].fate == ScanFate::goes_on) going.push(k);
    if (going.size() == 0) break;
    advance_rays<S>(stepper, setting, rays, going, lambda, next);
    lambda = std::exchange(next, 1.5 * next);
  }
}

/// The critical curve about the chart's origin, by bisection; none where all rays end alike.
template <class S, class Stepper, Metric M>
CriticalCurve find_critical_curve(Stepper& stepper, const ScanSetting<M>& setting,
                                  const ScanStart<M>& start) {
  constexpr int kBisections = 50;
  CriticalCurve out;
  if constexpr (!is_central<M>()) return out;
  const Vec3<double> X = spatial(start.place);
  const Vec4<double> inwards = {{0, -X[0], -X[1], -X[2]}};
  const Matrix4<double> g = setting.system.metric.g(start.place);
  out.centre =
      normalised(Vec3<double>::map([&](std::size_t i) { return -inner(g, inwards, start.tetrad.e[i + 1]); }));
  const Vec3<double> side = abs(out.centre[2]) < 0.9 ? Vec3<double>{{0, 0, 1}} : Vec3<double>{{1, 0, 0}};
  out.a = normalised(cross(side, out.centre)), out.b = cross(out.centre, out.a);
  const auto endings_at = [&](auto&& psi_of) {
    Pool<ScanRay> rays(CriticalCurve::kAngles);
    for (std::size_t j = 0; j < CriticalCurve::kAngles; ++j)
      rays.push(start.ray(stepper, setting, out.direction_at(psi_of(j), CriticalCurve::phi_of(j))));
    find_endings<S>(stepper, setting, rays);
    return rays;
  };
  const auto poles = endings_at([](std::size_t j) { return j % 2 == 0 ? 0.0 : std::numbers::pi; });
  const auto kind = [](const ScanRay& ray) { return ray.fate == ScanFate::stands ? -1 : ray.end; };
  if (kind(poles[0]) == kind(poles[1])) return out;
  std::array<double, CriticalCurve::kAngles> low{}, high{};
  for (double& angle : high) angle = std::numbers::pi;
  for (int i = 0; i < kBisections; ++i) {
    const auto rays = endings_at([&](std::size_t j) { return 0.5 * (low[j] + high[j]); });
    for (std::size_t j = 0; j < CriticalCurve::kAngles; ++j)
      (kind(rays[j]) == kind(poles[0]) ? low[j] : high[j]) = 0.5 * (low[j] + high[j]);
  }
  out.exists = true;
  for (std::size_t j = 0; j < CriticalCurve::kAngles; ++j) out.psi[j] = 0.5 * (low[j] + high[j]);
  return out;
}

NULLCONE_KERNEL_END
