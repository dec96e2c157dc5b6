// What of the lamps' light falls on surfaces: E = cos(alpha)/|det D| a lamp and path, and when it set out
// (docs/physics.md; Weiskopf, Kraus and Ruder 1999, eqs. 18, 19 and 26).
#pragma once

#include "core/trace/lamps.h"
#include "core/trace/lit_point.h"

NULLCONE_KERNEL_BEGIN

/// Light along one path, summed over the points of a lamp; all but E weighted by E.
template <class S>
struct PathLight {
  S E{S(0.0)}, shift{S(0.0)}, t{S(0.0)}, tau{S(0.0)};
};

/// Adds what one point of a lamp, of this weight, sends along a connection. `emission(connection)` gives the
/// frequency and the cosine of emission there; `let_through(connection, wanted)` how much of the light comes
/// past the objects, for the lanes in which it is asked for.
template <class S, class Emission, class LetThrough>
void add_light(const LitPoint<S>& lit, const Connection<S>& c, double weight, double cap,
               const Emission& emission, const LetThrough& let_through, PathLight<S>& sum) {
  const S frequency = lit.frequency(c.past), steepness = lit.steepness(c.past);
  const auto wanted = c.found & (steepness > S(0.0));
  if (!any(wanted)) return;
  const auto [emitted, cosine] = emission(c);
  // With k.u = 1 at the surface, not in the static frame, |det D| is frequency^2 times as large.
  const S area = frequency * frequency * frequency * abs(c.det);
  const S brightness = S(weight) * cosine * select(area * S(cap) > steepness, steepness / area, S(cap));
  const auto shines = wanted & (brightness > S(0.0));
  if (!any(shines)) return;
  const S E = select(shines, brightness * let_through(c, shines), S(0.0));
  sum.E = sum.E + E;
  const auto add = [&](S& to, const S& value) { to = to + select(E > S(0.0), E * value, S(0.0)); };
  add(sum.shift, frequency / emitted);
  add(sum.t, c.emitted[0]);
  add(sum.tau, c.tau);
}

/// Puts the light of one path among the brightest of its lamp, whose `paths` entries a crossing are sorted.
inline void insert_light(const HitLight& light, HitLight* among, std::size_t paths) {
  if (!(light.E > 0) || !std::isfinite(light.E + light.shift + light.t + light.tau)) return;
  std::size_t place = paths;
  while (place > 0 && among[place - 1].E < light.E) --place;
  if (place == paths) return;
  for (std::size_t i = paths - 1; i > place; --i) among[i] = among[i - 1];
  among[place] = light;
}

/// How far a ray has to go from its own surface before that can be told from meeting it.
template <class S>
S leaving(const LitPoint<S>& lit, const Connection<S>& c) {
  return S(64.0) * lit.rounding / max(lit.steepness(c.past), S(1e-300));
}

/// Where the lamps' light is written down, and how.
struct LightRules {
  std::size_t lamps = 0, paths = 0;  ///< paths: a lamp
  int windings = 1;
  double cap = 0;
  bool shadows = false;

  LightRules() = default;
  explicit LightRules(const Lights& lights)
      : lamps(lights.lamps.size()),
        paths(static_cast<std::size_t>(lights.paths)),
        windings(lights.windings),
        cap(lights.cap),
        shadows(lights.shadows) {}
};

/// What is written down of one path, in one lane of a pack.
template <class S>
HitLight mean_light(const PathLight<S>& sum, double t0, double tau0, std::size_t lane = 0) {
  const double E = Lanes<S>::get(sum.E, lane);
  const auto mean = [&](const S& weighted) { return Lanes<S>::get(weighted, lane) / E; };
  return {E, mean(sum.shift), mean(sum.t) - t0, mean(sum.tau) - tau0};
}

/// Of a group of crossings, for lamp number `number`: the light of one path.
template <class S, class Group>
void scatter_light(const PathLight<S>& sum, const Group& group, std::size_t number, const LightRules& rules,
                   double t0, double tau0, const HitRoom& to) {
  for (std::size_t lane = 0; lane < group.filled; ++lane)
    insert_light(mean_light(sum, t0, tau0, lane),
                 to.lights + group.ray[lane] * to.paths + number * rules.paths, rules.paths);
}

/// All lamps, for a group of crossings. `let_through(connection, wanted, body)` as in add_light; `body`:
/// number of the object that does not stand in the light.
template <class S, HasConnections M, class Group, class LetThrough>
void illuminate(const M& metric, const PlacedLamp<LampLine<M>>* lamps, const LightRules& rules,
                const LitPoint<S>& lit, const Group& group, double t0, const LetThrough& let_through,
                const HitRoom& to) {
  for (std::size_t number = 0; number < rules.lamps; ++number) {
    const PlacedLamp<LampLine<M>>& lamp = lamps[number];
    for (int branch = 0; branch < branches(metric, lamp.lines[0], rules.windings); ++branch) {
      PathLight<S> sum;
      for (std::size_t i = 0; i < lamp.count; ++i) {
        const LampLine<M>& line = lamp.lines[i];
        add_light(
            lit, connect(metric, lit.event, line, branch), lamp.weight, rules.cap,
            [&](const Connection<S>& c) { return lamp.emission(line, c); },
            [&](const Connection<S>& c, const Mask<S>& wanted) { return let_through(c, wanted, lamp.body); },
            sum);
      }
      scatter_light(sum, group, number, rules, t0, lamp.clock.origin, to);
    }
  }
}

NULLCONE_KERNEL_END
