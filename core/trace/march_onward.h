// Integrated rays that go on behind what they meet: all crossings within a step.
#pragma once

#include "core/trace/crossings.h"
#include "core/trace/march_object.h"
#include "core/trace/steps.h"

NULLCONE_KERNEL_BEGIN

/// Where a ray met an object: `delta` behind the start of a step, which is the state y at `lambda`.
struct StepCrossing {
  std::uint32_t ray, number;
  double lambda, delta;
  double turns;  ///< at the start of the step
  std::array<double, 8> y;

  /// Of a ray whose step begins where it stands now.
  StepCrossing(const Flights& flights, std::size_t of, std::uint32_t object, double behind)
      : ray(static_cast<std::uint32_t>(of)),
        number(object),
        lambda(flights.lambda[of]),
        delta(behind),
        turns(flights.turns[of]) {
    for (std::size_t c = 0; c < 8; ++c) y[c] = flights.y[c][of];
  }
  StepCrossing() = default;
};

/// What rays that go on remember from step to step, object by object.
struct Trails {
  static constexpr double kMost = 4096;  ///< crossings of a ray; beyond it the pixel is marked doubtful

  std::size_t rays;
  std::unique_ptr<double[]> side;   ///< -1 inside the object, else 1
  std::unique_ptr<double[]> after;  ///< lambda behind the last crossing with it: from here on it may be met
  std::unique_ptr<double[]> hits;   ///< crossings of the ray
  Pool<StepCrossing> found;

  template <Metric M>
  Trails(const MarchSetting<M>& setting, const Flights& flights, std::size_t count)
      : rays(count),
        side(new double[setting.count * count]),
        after(new double[setting.count * count]()),
        hits(new double[count]()),
        found(count) {
    for (std::size_t i = 0; i < setting.count; ++i)
      for (std::size_t ray = 0; ray < count; ++ray)
        side[i * count + ray] = starts_inside(setting.objects[i], flights, i, ray) ? -1 : 1;
  }
  template <class Object>
  static bool starts_inside(const Object& object, const Flights& flights, std::size_t i, std::size_t ray) {
    return flights.inside ? flights.inside[i * flights.count + ray] > 0 : object.starts_inside();
  }
  template <class S>
  void add(const Group<S>& group, const Flights& flights, const Mask<S>& met, std::uint32_t number,
           const S& delta) {
    std::array<bool, Group<S>::kWidth> is_met{};
    Lanes<S>::store(met, is_met.data());
    for (std::size_t lane = 0; lane < group.filled; ++lane) {
      if (!is_met[lane]) continue;
      found.push({flights, group.ray[lane], number, Lanes<S>::get(delta, lane)});
      ++hits[group.ray[lane]];
    }
  }
};

/// On which side of an object rays are, -1 inside, and from which lambda on they may meet it again.
template <class S>
struct Alongside {
  S side, after;

  /// The next crossing within a step that begins at lambda = start, of the lanes that are `wanted`.
  template <class Curve, class Shape>
  Search<S> cross(const Curve& curve, const Shape& shape, const S& start, const S& limit, const S& resolution,
                  const Mask<S>& wanted) {
    Search<S> search(limit);
    search.lambda = max(after - start, S(0.0));
    search.active = wanted & (search.lambda < limit);
    advance(curve, Onward<S, Shape>{shape, side < S(0.0)}, limit, resolution, kSearchLimit, search);
    const S rounding = resolution + S(4e-15) * search.lambda;
    const S past = start + (search.lambda + shape.skip(curve.at(search.lambda), rounding));
    after = select(search.met, past, after);
    side = select(search.met, -side, side);
    return search;
  }
};
inline constexpr int kMostInAStep = 256;  ///< crossings with an object

/// All crossings of a step with object number i, in the order of the list, before `limit`; lanes that give
/// up are added to `lost`.
template <class S, class Curve, class Shape>
void cross_onward(const Curve& curve, const Shape& shape, const Group<S>& group, const Flights& flights,
                  std::size_t i, std::uint32_t number, const S& limit, const S& resolution, Trails& trails,
                  Mask<S>& lost) {
  double* const sides = trails.side.get() + i * trails.rays;
  double* const afters = trails.after.get() + i * trails.rays;
  const S start = group.load(flights.lambda);
  Alongside<S> alongside{group.load(sides), group.load(afters)};
  auto goes_on = start == start;
  for (int n = 0; any(goes_on); ++n) {
    const Search<S> search = alongside.cross(curve, shape, start, limit, resolution, goes_on);
    lost = lost | search.given_up;
    goes_on = search.met;
    if (!any(goes_on)) break;
    trails.add(group, flights, search.met, number, search.lambda);
    if (n == kMostInAStep) lost = lost | search.met, goes_on = goes_on & !goes_on;
  }
  group.store(alongside.side, sides);
  group.store(alongside.after, afters);
}

/// What the coordinates' own rounding leaves of a length of lambda, and what the curve of a step does.
template <class S, std::size_t n>
S resolution_of(const StepStates<S, n>& step, const S& length) {
  const S speed = max(norm(spatial(step.rate[0].x)), S(1e-300));
  return S(1e-13) * length + S(4e-15) * norm(spatial(step.at[0].x)) / speed;
}

/// Finds all crossings within a step, up to that with an object at which rays end: `look` knows it already.
template <Metric M, class S, std::size_t n>
void look_onward(const MarchSetting<M>& setting, const StepStates<S, n>& step, const Group<S>& group,
                 const Flights& flights, const S& length, Trails& trails, Look<S>& look) {
  const S resolution = resolution_of(step, length);
  for (std::size_t i = 0; i < setting.count; ++i) {
    const MarchObject<M>& object = setting.objects[i];
    if (object.ends_rays) {
      const auto here = look.met & (look.number == S(static_cast<double>(i)));
      trails.add(group, flights, here, object.number, look.delta);
      continue;
    }
    object.with_curve(step.at, step.rate, length, [&](const auto& curve, const auto& shape) {
      cross_onward(curve, shape, group, flights, i, object.number, look.delta, resolution, trails, look.lost);
    });
  }
  const S hits = group.load(trails.hits.get());
  if (setting.max_hits > 0) look.met = look.met | (hits >= S(static_cast<double>(setting.max_hits)));
  look.lost = look.lost | (hits >= S(Trails::kMost));
}

NULLCONE_KERNEL_END
