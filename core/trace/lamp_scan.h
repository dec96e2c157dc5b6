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
  double turning;       ///< angle swept about the origin
  bool odd;             ///< the sheet of the light cone is turned round
};

/// Guesses at one point of space.
class GuessFinder {
 public:
  static constexpr std::size_t kMost = 256;
  static constexpr double kTurningError = 0.2;  ///< of guesses, in radians

  /// Of light that turns by less than `most_turning`.
  GuessFinder(const LightCone& cone, const Vec3<double>& x, double most_turning)
      : cone_(cone), x_(x), most_turning_(most_turning) {
    bool held = false;
    for (std::size_t k = 0; k < cone.targets && !held; ++k) {
      if (!cone.grids[k].holds(x)) continue;
      held = true;
      cone.grids[k].for_each_at(x, [&](std::uint32_t number) { look_into(cone.prisms[number]); });
    }
    complete = held && cone.complete && complete;
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
      ScanGuess guess{
          first.place, first.lambda, at.least(), {}, 0, first.turning, (at.volume < 0) != prism.odd};
      for (std::size_t i = 1; i < 4; ++i) {
        const Vec3<double> way = cone_.curve.way(first.place, corner[i]->place);
        const double later = corner[i]->lambda - first.lambda;
        guess.place = guess.place + at.weight[i] * way;
        guess.lambda += at.weight[i] * later;
        guess.turning += at.weight[i] * (corner[i]->turning - first.turning);
        for (std::size_t c = 0; c < 3; ++c) guess.spread[c] = max(guess.spread[c], abs(way[c]));
        guess.length = max(guess.length, abs(later));
      }
      if (guess.lambda > 0 && guess.turning < most_turning_ + kTurningError) add(guess);
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
  double most_turning_;
};

/// Room for the connections at many events: `room` of them each, from out + i room on.
struct ConnectionRoom {
  Connection<double>* out;
  int* winding;  ///< how often each goes round, from 0
  std::size_t room;
  std::size_t* counts;
  bool* complete;  ///< false where some may have been missed, or there was no room
};

/// A lamp at rest whose light cone is known near some targets.
template <Metric M>
class LampScan {
  static_assert(is_stationary<M>(), "the light cone of a lamp at rest repeats itself");

 public:
  static constexpr std::size_t kMostConnections = 64;

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
    std::size_t count = 0;
    const ConnectionRoom to{out, winding, room, &count, &complete};
    connect(&event, 1, to);
    return count;
  }
  /// The same at many events: whole packs of guesses.
  void connect(const Vec4<double>* events, std::size_t count, const ConnectionRoom& to) const {
    Pool<Pending> pending(4 * count);
    for (std::uint32_t i = 0; i < count; ++i) {
      const GuessFinder found(cone_, spatial(events[i]), most_turning_);
      to.counts[i] = 0, to.complete[i] = found.complete;
      for (std::size_t k = 0; k < found.count; ++k) pending.push({i, found.guesses[k]});
    }
    PrinceDormand87<Wide, VariedState<Wide>> stepper;  // each more would take seconds to compile
    for (std::size_t i = 0; i < pending.size(); i += Lanes<Wide>::count)
      shoot_some(stepper, events, pending, i, to);
  }
  const LightCone& cone() const { return cone_; }

 private:
  struct Pending {
    std::uint32_t event;
    ScanGuess guess;
  };

  template <class Stepper>
  void shoot_some(Stepper& stepper, const Vec4<double>* events, const Pool<Pending>& pending,
                  std::size_t first, const ConnectionRoom& to) const {
    constexpr std::size_t kWidth = Lanes<Wide>::count;
    const std::size_t filled = std::min(kWidth, pending.size() - first);
    const auto gather = [&](auto&& f) {
      std::array<double, kWidth> values{};
      for (std::size_t lane = 0; lane < kWidth; ++lane)
        values[lane] = f(pending[first + std::min(lane, filled - 1)]);
      return Lanes<Wide>::load(values.data());
    };
    ShotGuess<Wide> guess;
    guess.event = Vec4<Wide>::map(
        [&](std::size_t c) { return gather([&](const Pending& p) { return events[p.event][c]; }); });
    for (std::size_t lane = 0; lane < kWidth; ++lane)
      guess.aims.lane[lane] = Aim(cone_.curve, pending[first + std::min(lane, filled - 1)].guess.place);
    guess.lambda = gather([](const Pending& p) { return p.guess.lambda; });
    const ShotResult<Wide> shot = shoot(stepper, shooting_, guess, guess.lambda == guess.lambda);
    for (std::size_t lane = 0; lane < filled; ++lane) {
      const ShotResult<double> result = lane_of(shot, lane);
      const auto& [event, from] = pending[first + lane];
      if (result.connection.found) {
        if (result.turning <= most_turning_) keep(result, event, to);
      } else if (from.inside >= 0 && from.turning < most_turning_ - GuessFinder::kTurningError) {
        to.complete[event] = false;
      }
    }
  }

  /// Inserts by affine length what is not known yet.
  void keep(const ShotResult<double>& result, std::size_t event, const ConnectionRoom& to) const {
    const double same = max(1e-7, 100 * shooting_.accuracy.rtol);
    const Connection<double>& c = result.connection;
    Connection<double>* const out = to.out + event * to.room;
    int* const winding = to.winding + event * to.room;
    std::size_t& count = to.counts[event];
    for (std::size_t i = 0; i < count; ++i)
      if (norm(out[i].past - c.past) < same && abs(out[i].lambda - c.lambda) < same * c.lambda) return;
    std::size_t at = count;
    while (at > 0 && out[at - 1].lambda > c.lambda) --at;
    if (count == to.room) to.complete[event] = false;
    if (at == to.room) return;
    if (count < to.room) ++count;
    for (std::size_t i = count - 1; i > at; --i) out[i] = out[i - 1], winding[i] = winding[i - 1];
    out[at] = c;
    winding[at] = static_cast<int>(result.turning / (2 * std::numbers::pi));
  }

  double most_turning_;
  LightCone cone_;
  Shooting<M> shooting_;
};

NULLCONE_KERNEL_END
