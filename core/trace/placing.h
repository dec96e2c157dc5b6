// Placings: an object's frame as the search sees it (fast, over packs) and as the record sees it (exact, one
// lane).
#pragma once

#include "core/trace/local_frame.h"
#include "core/trace/shapes.h"

NULLCONE_KERNEL_BEGIN

/// For the search: an object at rest in the chart, or in the chart that the isometry of its worldline's event
/// makes.
template <Metric M>
struct RestPlacing {
  M metric;
  Vec4<double> place;  ///< event of the worldline, or the place in the chart
  bool local;          ///< whether `place` is carried to the origin
  Matrix3<double> axes;
  double ball;  ///< bounding radius of the shape, or a little more

  template <class S>
  struct Ray {
    using Path = decltype(std::declval<M>().path(Vec4<S>{}, Vec4<S>{}));
    const RestPlacing* placing;
    Path path;
    decltype(make_guard(std::declval<Path>(),
                        0.0)) guard;  ///< for local objects, which stand at the chart's origin

    Ray(const RestPlacing* from, const Path& along) : placing(from), path(along), guard(along, from->ball) {}

    S clearance(const S& lambda) const { return placing->local ? guard.clearance(lambda) : S(0.0); }

    Sight<S> at(const S& lambda) const {
      Sight<S> out;
      out.clearance = clearance(lambda);
      if (all(out.clearance > S(0.0))) return out;
      const PathPoint<S> P = path.at(lambda);
      bound_at_rest(path, P, out);
      out.X = spatial(P.event);
      out.slope = spatial(P.tangent);
      if (!placing->local) {
        out.X = out.X - spatial(convert<S>(placing->place));
        const S distance = norm(out.X);
        out.clearance = select(distance > S(1.5 * placing->ball),
                               min((distance - S(placing->ball)) / out.slope_max, out.valid), S(0.0));
        // What recedes on a straight line never comes back.
        const auto gone =
            (out.bend_max == S(0.0)) & (dot(out.X, out.slope) > S(0.0)) & (out.clearance > S(0.0));
        out.clearance = select(gone, S(kFar), out.clearance);
      }
      const auto rows = convert<S>(placing->axes);
      out.X = rows * out.X;
      out.slope = rows * out.slope;
      return out;
    }
  };
  /// What all rays from one event (or, for packs, from one event a lane) have in common: the event in the
  /// object's chart (where a local object stands at the origin), and how the tetrad turns.
  template <class S>
  struct Launch {
    Vec4<S> start;
    Complex<S> turn;
  };
  template <class S>
  Launch<S> launch(const Vec4<S>& event) const {
    if (!local) return {event, {S(1.0), S(0.0)}};
    const auto at = convert<S>(place);
    return {metric.to_origin(at, event), metric.turn(at, event)};
  }
  /// A quick sieve: false for rays that surely never meet the bounding ball.
  template <class S>
  Mask<S> may_meet(const Launch<double>& launch, const Vec4<S>& k) const {
    if (!local) return k[0] == k[0];
    using Guard = decltype(std::declval<Ray<S>>().guard);
    return Guard::may_meet(metric, launch.start, turned_about_e3(launch.turn, k), ball);
  }
  /// The path with past-directed tangent k (static tetrad) at the event, in the object's chart.
  template <class S, class T>
  auto path(const Launch<T>& launch, const Vec4<S>& k) const {
    return metric.path(convert<S>(launch.start), turned_about_e3(launch.turn, k));
  }
  template <class S, class T>
  Ray<S> ray(const Launch<T>& launch, const Vec4<S>& k) const {
    return {this, path(launch, k)};
  }
  /// The scene's coordinates of an event that is given in the object's chart.
  template <class S>
  Vec4<S> scene_event(const Vec4<S>& event) const {
    return local ? metric.from_origin(convert<S>(place), event) : event;
  }
  /// Components in the static tetrad of the scene's chart, of a vector that is given in that of the object's.
  template <class S>
  Vec4<S> scene_vector(const Vec4<S>& scene_event, const Vec4<S>& v) const {
    return local ? turned_about_e3(conj(metric.turn(convert<S>(place), scene_event)), v) : v;
  }
};

/// For the search: a rigid local object on a geodesic.
template <Metric M>
struct MovingPlacing {
  LocalFrame<M> frame;
  decltype(make_orbit(std::declval<LocalFrame<M>>(), 0.0)) orbit;
  bool isotropic;   ///< the shape does not care how the axes turn
  double ball = 0;  ///< bounding radius of the shape, or a little more; of objects that spin

  template <class S>
  struct Ray {
    const MovingPlacing* placing;
    decltype(std::declval<M>().path(Vec4<S>{}, Vec4<S>{})) path;
    decltype(std::declval<MovingPlacing>().orbit.ray(
        std::declval<MovingPlacing>().orbit.launch(Vec4<double>{}), Vec4<S>{})) around;

    S clearance(const S& lambda) const {
      S tau;
      return around.clearance(lambda, tau);
    }

    Sight<S> at(const S& lambda) const {
      Sight<S> out;
      S tau;
      out.clearance = around.clearance(lambda, tau);
      if (all(out.clearance > S(0.0))) return out;
      const auto& orbit = placing->orbit;
      out.slope_min = around.frequency * S(1 / orbit.stretch);
      out.slope_max = around.frequency * S(orbit.stretch);
      out.bend_max = around.frequency * around.frequency * S(orbit.bend);
      const S tau_slope = locate(lambda, tau, out);
      out.valid = S(kFar);
      if (orbit.farthest < kFar)  // the bounds hold so far around the object
        out.valid = max(S(orbit.farthest) - norm(out.X), S(0.02 * orbit.farthest)) / out.slope_max;
      if (!placing->isotropic && placing->frame.spin.rate != 0) turn(tau, tau_slope, out);
      return out;
    }

    /// Position and slope in the rest frame, but for the spin: Newton's method for the proper time, and
    /// implicit differentiation. Returns the slope of the proper time.
    S locate(const S& lambda, S& tau, Sight<S>& out) const {
      const PathPoint<S> P = path.at(lambda);
      using D1 = Dual<S, 1>;
      for (int i = 0; i < 2; ++i) {
        const D1 late = placing->frame.rest(convert<D1>(P.event), D1::variable(tau, 0))[0];
        tau = tau - late.v / late.d[0];
      }
      using D2 = Dual<S, 2>;  // derivatives along lambda and tau
      const auto event = Vec4<D2>::map([&](std::size_t i) {
        return D2(P.event[i], Vec<S, 2>{{P.tangent[i], S(0.0)}});
      });
      const D2 time(tau, Vec<S, 2>{{S(0.0), S(1.0)}});
      const Vec4<D2> rest = placing->frame.rest(event, time);
      const Vec3<D2> X = placing->isotropic ? spatial(rest) : placing->frame.to_axes(time, spatial(rest));
      const S last_step = -(rest[0].v / rest[0].d[1]), tau_slope = -(rest[0].d[0] / rest[0].d[1]);
      for (std::size_t i = 0; i < 3; ++i) {
        out.X[i] = X[i].v + X[i].d[1] * last_step;
        out.slope[i] = X[i].d[0] + X[i].d[1] * tau_slope;
      }
      tau = tau + last_step;
      return tau_slope;
    }

    /// From how the ray moves along the object's axes to how it moves as the object spins; only within the
    /// bounding ball, and never further than a part of it and of a turn.
    void turn(const S& tau, const S& tau_slope, Sight<S>& sight) const {
      const Precession& spin = placing->frame.spin;
      const S ball(placing->ball), until = Sphere{placing->ball}.safe_step(sight, S(0.0));
      const S enters = max(until, S(1e-9) * ball / sight.slope_max);
      const S reach_now = norm(sight.X);
      sight.clearance = max(sight.clearance, select(reach_now > S(1 + 1e-9) * ball, enters, S(0.0)));
      const Vec3<S> axis = convert<S>(spin.axis);
      sight.X = spin.rotate(tau, sight.X, -1);
      sight.slope = spin.rotate(tau, sight.slope, -1) - (S(spin.rate) * tau_slope) * cross(axis, sight.X);

      const S rate = S(abs(spin.rate)) * max(abs(tau_slope), sight.slope_max);
      sight.valid = min(sight.valid, min(S(0.5) * ball / sight.slope_max, S(0.25) / rate));
      const S reach = reach_now + sight.slope_max * sight.valid, swept = rate * reach;
      sight.bend_max =
          sight.bend_max * (S(1.0) + S(abs(spin.rate)) * reach) + rate * (S(2.0) * sight.slope_max + swept);
      sight.slope_min = max(sight.slope_min - swept, S(0.0));
      sight.slope_max = sight.slope_max + swept;
    }
  };
  template <class S>
  struct Launch {
    Vec4<S> start;
    decltype(std::declval<MovingPlacing>().orbit.launch(Vec4<S>{})) around;
  };
  template <class S>
  Launch<S> launch(const Vec4<S>& event) const {
    return {event, orbit.launch(event)};
  }
  template <class S>
  Mask<S> may_meet(const Launch<double>&, const Vec4<S>& k) const {
    return k[0] == k[0];
  }
  template <class S, class T>
  auto path(const Launch<T>& launch, const Vec4<S>& k) const {
    return frame.metric.path(convert<S>(launch.start), k);
  }
  template <class S, class T>
  Ray<S> ray(const Launch<T>& launch, const Vec4<S>& k) const {
    return {this, path(launch, k), orbit.ray(launch.around, k)};
  }
  template <class S>
  Vec4<S> scene_event(const Vec4<S>& event) const {
    return event;
  }
  template <class S>
  Vec4<S> scene_vector(const Vec4<S>&, const Vec4<S>& v) const {
    return v;
  }
};

/// For the record: lateness T' (zero at the object's proper time tau) and position X of an event, and back.
/// Events are those of the placing's paths: where the object rests, they stand in its own chart.
template <Metric M>
struct LocalBody {
  LocalFrame<M> frame;
  decltype(make_orbit(std::declval<LocalFrame<M>>(), 0.0)) orbit;

  template <class S>
  std::pair<S, Vec3<S>> local(const Vec4<S>& event, const S& tau) const {
    const Vec4<S> rest = frame.rest(event, tau);
    return {rest[0], frame.to_object(tau, spatial(rest))};
  }
  template <class S>
  Vec4<S> event(const S& tau, const Vec3<S>& X) const {
    return frame.event(tau, X);
  }
  template <class S>
  S first_guess(const Vec4<S>& event) const {
    return orbit.proper_time(event);
  }
};

/// The same for an object at rest at the origin of its own chart, with axes tied to the static tetrad.
struct RestBody {
  Matrix3<double> axes;

  template <class S>
  std::pair<S, Vec3<S>> local(const Vec4<S>& event, const S& tau) const {
    return {event[0] - tau, convert<S>(axes) * spatial(event)};
  }
  template <class S>
  Vec4<S> event(const S& tau, const Vec3<S>& X) const {
    const Vec3<S> x = X[0] * convert<S>(axes[0]) + X[1] * convert<S>(axes[1]) + X[2] * convert<S>(axes[2]);
    return {{tau, x[0], x[1], x[2]}};
  }
  template <class S>
  S first_guess(const Vec4<S>& event) const {
    return event[0];
  }
};

/// The same for an object that is fixed in the chart; its clocks are those of static observers.
template <Metric M>
struct ChartBody {
  M metric;
  Vec4<double> place;
  Matrix3<double> axes;

  template <class S>
  std::pair<S, Vec3<S>> local(const Vec4<S>& event, const S& tau) const {
    const Vec4<S> x = event - convert<S>(place);
    const auto rows = convert<S>(axes);
    return {sqrt(metric.g(event)[0][0]) * x[0] - tau, rows * spatial(x)};
  }
  template <class S>
  Vec4<S> event(const S& tau, const Vec3<S>& X) const {
    const Vec3<S> x = X[0] * convert<S>(axes[0]) + X[1] * convert<S>(axes[1]) + X[2] * convert<S>(axes[2]);
    Vec4<S> out = convert<S>(place) + Vec4<S>{{S(0.0), x[0], x[1], x[2]}};
    out[0] = out[0] + tau / sqrt(metric.g(out)[0][0]);
    return out;
  }
  template <class S>
  S first_guess(const Vec4<S>& event) const {
    return event[0] - S(place[0]);
  }
};

NULLCONE_KERNEL_END
