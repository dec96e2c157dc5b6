// How things move that do not rest: where one is at each proper time, how fast, and how its axes stand.
#pragma once

#include <memory>
#include <string>

#include "core/trace/spacetime.h"

namespace nullcone {

/// One spacetime with the values of its parameters.
struct Ground {
  const Spacetime& spacetime;
  std::span<const double> parameters;
};

/// Whether spacetime is flat and the chart Cartesian, as far as the connection tells at some events near x.
bool is_flat(const Ground& ground, const Event& x);

/// Somebody at one of his events, chart components.
struct Followed {
  Event event{};
  std::array<Event, 4> axes{};  ///< the 4-velocity, then the axes: orthonormal
};

/// Somebody with 4-velocity u at x whose axes are the boosted ones of the tetrad `frame`.
Followed boosted(const Ground& ground, const Event& x, const Event& u, ObserverFrame frame);

/// Somebody on the way, at proper time 0 first; the axes are Fermi-Walker transported (on geodesics:
/// parallel).
class Traveller {
 public:
  virtual ~Traveller() = default;
  virtual std::unique_ptr<Traveller> copy() const = 0;
  /// Goes on, or back, to a proper time. Throws InputError where there is no way.
  virtual void go(double tau) = 0;
  virtual Followed now() const = 0;
  /// The next proper time before or behind `tau` at which the way is not smooth, or ends: infinite if none.
  virtual double kink(double tau, bool ahead) const;
  /// Whether there is no way ahead of `tau`, or behind it.
  virtual bool ends_at(double tau, bool ahead) const;
};

/// The start of a motion, with the boosted axes of the tetrad `frame`. Relative errors are some 1e-13 of what
/// is passed through; in flat spacetime acceleration is followed by its closed form. Throws InputError,
/// placed at `place`, where the motion is none of an observer. The spacetime and its parameters must live as
/// long as the traveller.
std::unique_ptr<Traveller> set_out(const Ground& ground, const Motion& motion, ObserverFrame frame,
                                   const std::string& place);

}  // namespace nullcone
