// Boost.Odeint's error steppers over packs: every lane has a step size of its own. The one place that knows
// Odeint.
#pragma once

#include <boost/numeric/odeint/algebra/array_algebra.hpp>
#include <boost/numeric/odeint/algebra/default_operations.hpp>
#include <boost/numeric/odeint/stepper/explicit_error_generic_rk.hpp>
#include <boost/numeric/odeint/stepper/runge_kutta_dopri5.hpp>
#include <boost/numeric/odeint/stepper/runge_kutta_fehlberg78.hpp>
#include <boost/numeric/odeint/util/resizer.hpp>

#include "core/base/vector.h"
#include "core/trace/tableaus.h"

// Odeint adds up error estimates for 1 to 6 and 13 stages only; this is the missing one for 8.
namespace boost::numeric::odeint::detail {
template <class Operations, class Fac, class Time>
struct generic_rk_scale_sum_err<8, Operations, Fac, Time> : public Operations::template scale_sum8<Time> {
  generic_rk_scale_sum_err(const boost::array<Fac, 8>& a, Time dt)
      : Operations::template scale_sum8<Time>(a[0] * dt, a[1] * dt, a[2] * dt, a[3] * dt, a[4] * dt,
                                              a[5] * dt, a[6] * dt, a[7] * dt) {}
  using result_type = void;
};
}  // namespace boost::numeric::odeint::detail

NULLCONE_KERNEL_BEGIN

/// (x^mu, p_mu) as Odeint's steppers see it.
template <class S>
using State = Vec<S, 8>;

/// A tableau as Odeint's generic stepper takes it: a fusion vector of the rows of a, and the weights.
template <class S, class Y, const auto& kTableau>
struct GenericPair {
  static constexpr int kStages = kTableau.stages;
  using Stepper = boost::numeric::odeint::explicit_error_generic_rk<
      kStages, kTableau.order, kTableau.order, kTableau.embedded_order, Y, S, Y, S,
      boost::numeric::odeint::array_algebra, boost::numeric::odeint::default_operations,
      boost::numeric::odeint::never_resizer>;
  template <int kRow>
  static auto row() {
    boost::array<S, kRow> out;
    for (std::size_t j = 0; j < kRow; ++j) out[j] = S(kTableau.a[kRow - 1][j]);
    return out;
  }
  template <std::size_t... kRow>
  static auto rows(std::index_sequence<kRow...>) {
    return typename Stepper::coef_a_type(row<static_cast<int>(kRow) + 1>()...);
  }
  static boost::array<S, kStages> weights(const double* from, const double* minus = nullptr) {
    boost::array<S, kStages> out;
    for (std::size_t i = 0; i < kStages; ++i) out[i] = S(minus ? from[i] - minus[i] : from[i]);
    return out;
  }
  static Stepper make() {
    return Stepper(rows(std::make_index_sequence<kStages - 1>()), weights(kTableau.b),
                   weights(kTableau.b, kTableau.b_embedded), weights(kTableau.c));
  }
};

// Each stepper takes one step, of a state Y (rays: State<S>), of a pair of order kOrder. kRoots is how many
// square roots of the error
// estimate make the factor of the next step: about 1/(embedded order + 1), by roots alone, so that the bits
// are the same everywhere. kEstimate is how many times the estimate exceeds the error that is left at a ray's
// end, as measured (docs/accuracy.md): so one tolerance means about one error, whatever the stepper.
template <class S, class Y = State<S>>
struct DormandPrince5 {
  static constexpr int kOrder = 5, kRoots = 2;
  static constexpr double kEstimate = 1;
  boost::numeric::odeint::runge_kutta_dopri5<Y, S, Y, S, boost::numeric::odeint::array_algebra,
                                             boost::numeric::odeint::default_operations,
                                             boost::numeric::odeint::never_resizer>
      stepper;

  /// From y with rate dy over h to y1 with rate dy1; `error` is the estimated local error.
  template <class System>
  void step(const System& system, const Y& y, const Y& dy, const S& h, Y& y1, Y& dy1, Y& error) {
    stepper.do_step(system, y, dy, S(0.0), y1, dy1, h, error);
  }
  /// The same without the error and the rate at the end.
  template <class System>
  Y move(const System& system, const Y& y, const Y& dy, const S& h) {
    Y y1, dy1;
    stepper.do_step(system, y, dy, S(0.0), y1, dy1, h);
    return y1;
  }
};

template <class S, class Y, class Stepper, int kOrder_, int kRoots_>
struct OdeintPair {
  static constexpr int kOrder = kOrder_, kRoots = kRoots_;
  Stepper stepper;

  template <class System>
  void step(const System& system, const Y& y, const Y& dy, const S& h, Y& y1, Y& dy1, Y& error) {
    stepper.do_step(system, y, dy, S(0.0), y1, h, error);
    system(y1, dy1, S(0.0));
  }
  template <class System>
  Y move(const System& system, const Y& y, const Y& dy, const S& h) {
    Y y1;
    stepper.do_step(system, y, dy, S(0.0), y1, h);
    return y1;
  }
};

template <class S, class Y>
using Fehlberg78Stepper =
    boost::numeric::odeint::runge_kutta_fehlberg78<Y, S, Y, S, boost::numeric::odeint::array_algebra,
                                                   boost::numeric::odeint::default_operations,
                                                   boost::numeric::odeint::never_resizer>;
template <class S, class Y = State<S>>
struct Fehlberg78 : OdeintPair<S, Y, Fehlberg78Stepper<S, Y>, 8, 3> {
  static constexpr double kEstimate = 1;
};
template <class S, class Y = State<S>>
struct Verner65 : OdeintPair<S, Y, typename GenericPair<S, Y, kVerner65>::Stepper, 6, 3> {
  static constexpr double kEstimate = 0.4;
  Verner65() : Verner65::OdeintPair{GenericPair<S, Y, kVerner65>::make()} {}
};
template <class S, class Y = State<S>>
struct PrinceDormand87 : OdeintPair<S, Y, typename GenericPair<S, Y, kPrinceDormand87>::Stepper, 8, 3> {
  static constexpr double kEstimate = 16;
  PrinceDormand87() : PrinceDormand87::OdeintPair{GenericPair<S, Y, kPrinceDormand87>::make()} {}
};

NULLCONE_KERNEL_END
