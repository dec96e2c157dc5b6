// All null geodesics from a lamp at rest to events near some targets, in any stationary spacetime: guesses
// from the lamp's light cone, which is swept once, and shooting.
#pragma once

#include "core/trace/lamp_sweep.h"
#include "core/trace/shooting.h"

NULLCONE_KERNEL_BEGIN

/// A first guess of a connection.
struct ScanGuess {
  Vec3<double> place;   ///< in the mesh of directions
  double lambda;        ///< affine length with frequency 1 at the lamp
  double inside;        ///< least barycentric coordinate: negative outside its tetrahedron
  Vec3<double> spread;  ///< how much places differ within it,
  double length;        ///< and affine lengths
  bool odd;             ///< the sheet of the light cone is turned round
};

/// Guesses at one point of space.
class GuessFinder {
 public:
  static constexpr std::size_t kMost = 64;

  GuessFinder(const LightCone& cone, const Vec3<double>& x) : cone_(cone), x_(x) {
    bool held = false;
    for (std::size_t k = 0; k < cone.targets && !held; ++k) {
      if (!cone.grids[k].holds(x)) continue;
      held = true;
      cone.grids[k].for_each_at(x, [&](std::uint32_t number) { look_into(cone.prisms[number]); });
    }
    complete = held && complete;
  }

  std::size_t count = 0;
  std::array<ScanGuess, kMost> guesses{};
  bool complete = true;

 private:
  void look_into(const ScanPrism& prism) {
    if (prism.unresolved && cone_.box_of(prism).touches({x_, x_})) complete = false;
    for (const auto& corners : kTetrahedra) {
      std::array<const ScanNode*, 4> corner{};
      for (std::size_t i = 0; i < 4; ++i) corner[i] = &cone_.nodes[prism.node[corners[i]]];
      const Barycentric at(corner, x_);
      if (!(at.least() >= -kInflation)) continue;
      const ScanNode& first = *corner[0];
      ScanGuess guess{first.place, first.lambda, at.least(), {}, 0, (at.volume < 0) != prism.odd};
      for (std::size_t i = 1; i < 4; ++i) {
        const Vec3<double> way = cone_.curve.way(first.place, corner[i]->place);
        const double later = corner[i]->lambda - first.lambda;
        guess.place = guess.place + at.weight[i] * way;
        guess.lambda += at.weight[i] * later;
        for (std::size_t c = 0; c < 3; ++c) guess.spread[c] = max(guess.spread[c], abs(way[c]));
        guess.length = max(guess.length, abs(later));
      }
      if (guess.lambda > 0) add(guess);
    }
  }

  bool are_near(const ScanGuess& a, const ScanGuess& b) const {
    const Vec3<double> way = cone_.curve.way(a.place, b.place);
    bool out = a.odd == b.odd && abs(a.lambda - b.lambda) <= 2 * max(a.length, b.length);
    for (std::size_t c = 0; c < 3; ++c) out = out && abs(way[c]) <= 2 * max(a.spread[c], b.spread[c]);
    return out;
  }

  /// Guesses from outside their tetrahedron are left out where a better one of their kind is near.
  void add(const ScanGuess& guess) {
    std::size_t at = count;
    for (std::size_t i = 0; i < count; ++i) {
      if (!are_near(guess, guesses[i])) continue;
      if (guess.inside < 0 && guesses[i].inside >= guess.inside) return;
      if (guesses[i].inside < 0) at = std::min(at, i);
    }
    complete = complete && at < kMost;
    if (at == kMost) return;
    guesses[at] = guess;
    count += at == count;
  }

  const LightCone& cone_;
  Vec3<double> x_;
};

/// A lamp at rest whose light cone is known near some targets.
template <Metric M>
class LampScan {
  static_assert(is_stationary<M>(), "the light cone of a lamp at rest repeats itself");

 public:
  static constexpr std::size_t kMostConnections = GuessFinder::kMost;

  /// For light that sweeps an angle of less than windings 2 pi about the chart's origin, up to an affine
  /// length of `lookback` (frequency 1 at the lamp), to events within the targets.
  LampScan(const M& metric, const Accuracy& accuracy, const Vec4<double>& place, int windings,
           double lookback, const Ball* targets, std::size_t count)
      : most_turning_(2 * std::numbers::pi * windings),
        cone_(LampSweep<M>(metric, place, most_turning_, lookback, targets, count).take()),
        shooting_(metric, accuracy, place, cone_.curve) {}

  /// All connections at an event, by affine length, and how often each goes round, from 0; returns how many.
  /// `complete` is false where some may have been missed, or there was no room.
  std::size_t connect(const Vec4<double>& event, Connection<double>* out, int* winding, std::size_t room,
                      bool& complete) const {
    const GuessFinder found(cone_, spatial(event));
    std::size_t count = 0;
    complete = found.complete;
    PrinceDormand87<Wide, VariedState<Wide>> stepper;  // whatever the scene's rays are followed with
    for (std::size_t i = 0; i < found.count; i += Lanes<Wide>::count)
      shoot_some(stepper, event, found, i, out, winding, room, count, complete);
    return count;
  }
  const LightCone& cone() const { return cone_; }

 private:
  template <class Stepper>
  void shoot_some(Stepper& stepper, const Vec4<double>& event, const GuessFinder& from, std::size_t first,
                  Connection<double>* out, int* winding, std::size_t room, std::size_t& count,
                  bool& complete) const {
    constexpr std::size_t kWidth = Lanes<Wide>::count;
    const std::size_t filled = std::min(kWidth, from.count - first);
    const auto gather = [&](auto&& f) {
      std::array<double, kWidth> values{};
      for (std::size_t lane = 0; lane < kWidth; ++lane)
        values[lane] = f(from.guesses[first + std::min(lane, filled - 1)]);
      return Lanes<Wide>::load(values.data());
    };
    Aims<Wide> aims;
    for (std::size_t lane = 0; lane < kWidth; ++lane)
      aims.lane[lane] = Aim(cone_.curve, from.guesses[first + std::min(lane, filled - 1)].place);
    const ShotGuess<Wide> guess{convert<Wide>(event), aims, gather([](const auto& g) { return g.lambda; })};
    const ShotResult<Wide> shot = shoot(stepper, shooting_, guess, guess.lambda == guess.lambda);
    for (std::size_t lane = 0; lane < filled; ++lane) {
      const auto result = lane_of(shot, lane);
      if (!result.connection.found) {
        complete = complete && from.guesses[first + lane].inside < 0;
      } else if (result.turning <= most_turning_) {
        keep(result, out, winding, room, count, complete);
      }
    }
  }

  /// Inserts by affine length what is not known yet.
  void keep(const ShotResult<double>& result, Connection<double>* out, int* winding, std::size_t room,
            std::size_t& count, bool& complete) const {
    const double same = max(1e-7, 100 * shooting_.accuracy.rtol);
    const Connection<double>& c = result.connection;
    for (std::size_t i = 0; i < count; ++i)
      if (norm(out[i].past - c.past) < same && abs(out[i].lambda - c.lambda) < same * c.lambda) return;
    std::size_t at = count;
    while (at > 0 && out[at - 1].lambda > c.lambda) --at;
    if (count == room) complete = false;
    if (at == room) return;
    if (count < room) ++count;
    for (std::size_t i = count - 1; i > at; --i) out[i] = out[i - 1], winding[i] = winding[i - 1];
    out[at] = c;
    winding[at] = static_cast<int>(result.turning / (2 * std::numbers::pi));
  }

  double most_turning_;
  LightCone cone_;
  Shooting<M> shooting_;
};

NULLCONE_KERNEL_END
