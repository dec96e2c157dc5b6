// Where a metric is checked: random events and rays, off the equator, on all scales that the metric has.
#pragma once

#include <random>
#include <sstream>
#include <vector>

#include "core/trace/check_result.h"
#include "core/trace/hamilton.h"

NULLCONE_KERNEL_BEGIN

/// The worst of many comparisons, with all that is needed to look into it.
class Worst {
 public:
  Worst(std::string name, double limit) { result_.name = std::move(name), result_.limit = limit; }

  /// Compares two values; `scale` is what errors count against. `component` is only called for the worst.
  template <class Name>
  void compare(double found, double expected, double scale, const Vec4<double>& event, Name&& component) {
    const double error = found == expected ? 0 : std::fabs(found - expected) / scale;
    if (error <= result_.worst) return;  // not a number: worse than all
    if (result_.worst == kNotANumber) return;
    result_.worst = std::isnan(error) ? kNotANumber : error;
    std::ostringstream out;
    out.precision(15);
    out << component() << " at (" << event[0] << ", " << event[1] << ", " << event[2] << ", " << event[3]
        << "): " << found << " against " << expected;
    result_.where = out.str();
  }
  void count() { ++result_.events; }
  const CheckResult& result() const { return result_; }

 private:
  static constexpr double kNotANumber = std::numeric_limits<double>::infinity();
  CheckResult result_;
};

/// "x" of coordinate 1, and so on.
inline std::string coordinate(std::size_t i) { return std::string(1, "txyz"[i]); }
inline std::string component(const char* name, std::size_t i) { return name + coordinate(i); }
inline std::string component(const char* name, std::size_t i, std::size_t j) {
  return component(name, i) + coordinate(j);
}

/// The largest magnitude in a vector or matrix.
template <class S, std::size_t N>
double largest(const Vec<S, N>& v) {
  double out = 0;
  for (std::size_t i = 0; i < N; ++i) out = std::fmax(out, static_cast<double>(abs(v[i])));
  return out;
}
template <class S>
double largest(const Matrix4<S>& m) {
  return std::fmax(std::fmax(largest(m[0]), largest(m[1])), std::fmax(largest(m[2]), largest(m[3])));
}

inline bool is_finite(const Matrix4<double>& m) {
  for (const Vec4<double>& row : m)
    for (const double entry : row.c)
      if (!std::isfinite(entry)) return false;
  return true;
}

/// How many eigenvalues of a symmetric matrix are positive: the sign changes of its characteristic polynomial
/// (Descartes; exact, as all roots are real), whose coefficients come from Faddeev and LeVerrier. Zeros do
/// not count.
inline int positive_eigenvalues(const Matrix4<double>& g) {
  Matrix4<double> m{};
  double coefficient = 1, last = 1;
  int changes = 0;
  for (int k = 1; k <= 4; ++k) {
    Matrix4<double> next{};
    double trace = 0;
    for (std::size_t i = 0; i < 4; ++i) m[i][i] += coefficient;
    for (std::size_t i = 0; i < 4; ++i)
      for (std::size_t j = 0; j < 4; ++j)
        for (std::size_t l = 0; l < 4; ++l) next[i][j] += g[i][l] * m[l][j];
    for (std::size_t i = 0; i < 4; ++i) trace += next[i][i];
    coefficient = -trace / k;
    m = next;
    if (coefficient == 0) continue;
    changes += coefficient * last < 0;
    last = coefficient;
  }
  return changes;
}

/// The metric's own length: the largest distance from the origin at which g changes by half of itself over
/// that distance; where it never does, by a tenth, or a hundredth; else 1.
template <Metric M>
double characteristic_length(const M& metric) {
  const Vec3<double> n = {{0.48, -0.6, 0.64}};
  const auto change = [&](double r) {
    const Vec4<double> x = {{0, r * n[0], r * n[1], r * n[2]}};
    double d = 0;
    for (const Matrix4<double>& m : metric_derivatives(metric, x)) d = std::fmax(d, largest(m));
    return d * r / largest(metric.g(x));
  };
  for (const double much : {0.5, 0.1, 0.01})
    for (double length = 1e15; length > 1e-12; length /= 1.25)
      if ((change(length) < much) != (change(length / 1.25) < much)) return length;
  return 1;
}

/// An event, and a ray through it: momentum and a unit direction in the frame of an observer there.
struct Sample {
  Phase<double> at;
  Vec4<double> tangent, local;
  bool is_static = false;  ///< the frame is the static tetrad
};

/// Random events and rays. Deterministic in the seed.
template <Metric M>
class Sampler {
 public:
  Sampler(const M& metric, unsigned seed)
      : metric_(metric), random_(seed), length_(characteristic_length(metric)) {}

  double length() const { return length_; }
  /// From a tenth to ten lengths from the origin, evenly in the logarithm.
  Vec4<double> event() {
    const Vec3<double> X = (length_ * std::pow(10.0, uniform(-1, 1))) * direction();
    return {{uniform(-1, 1) * length_, X[0], X[1], X[2]}};
  }
  /// Light, or one time in three a particle, into the past or the future. Nothing where the chart ends.
  bool sample(Sample& out) {
    const Vec4<double> x = event();
    const Matrix4<double> g = metric_.g(x);
    if (!is_finite(g) || positive_eigenvalues(g) != 1) return false;
    out.is_static = g[0][0] > 0;  // else an observer at right angles to the surfaces of equal time
    const auto tetrad =
        out.is_static ? static_tetrad(metric_, x) : gram_schmidt_tetrad(metric_, x, inverse(g)[0]);
    const Vec3<double> n = direction();
    const double speed = uniform(0, 3) < 1 ? 0.7 : 1, time = uniform(0, 2) < 1 ? 1 : -1;
    out.local = {{time, time * speed * n[0], time * speed * n[1], time * speed * n[2]}};
    out.tangent = tetrad.to_chart(out.local);
    out.at = {x, g * out.tangent};
    if (!std::isfinite(largest(out.tangent))) return false;
    const double end = ending(metric_, out.at, rhs(metric_, x, out.at.p), 0.0);
    return end == as_scalar<double>(Ending::none);
  }
  double uniform(double from, double to) { return std::uniform_real_distribution<double>(from, to)(random_); }

 private:
  Vec3<double> direction() {
    std::normal_distribution<double> normal;
    const double x = normal(random_), y = normal(random_), z = normal(random_);
    return normalised(Vec3<double>{{x, y, z}});
  }

  const M& metric_;
  std::mt19937_64 random_;
  double length_;
};

/// One step of the classical Runge-Kutta method.
template <Metric M>
Phase<double> runge_kutta_step(const M& metric, const Phase<double>& from, double step) {
  const auto moved = [&](double by, const Phase<double>& rate) {
    return Phase<double>{from.x + by * rate.x, from.p + by * rate.p};
  };
  const auto rate = [&](const Phase<double>& at) { return rhs(metric, at.x, at.p); };
  const Phase<double> k1 = rate(from), k2 = rate(moved(step / 2, k1)), k3 = rate(moved(step / 2, k2)),
                      k4 = rate(moved(step, k3));
  const double sixth = step / 6, third = step / 3;
  return {moved(sixth, k1).x + third * (k2.x + k3.x) + sixth * k4.x,
          moved(sixth, k1).p + third * (k2.p + k3.p) + sixth * k4.p};
}

/// How fast things change along a ray, in 1/lambda: its position, g, and the momentum.
template <Metric M>
double rate_of_change(const M& metric, const Vec4<double>& x, const Vec4<double>& tangent) {
  const Matrix4<double> g = metric.g(x);
  const auto dg = metric_derivatives(metric, x);
  Matrix4<double> along{};
  double force = 0;
  for (std::size_t k = 0; k < 4; ++k) {
    for (std::size_t i = 0; i < 4; ++i) along[i] = along[i] + tangent[k] * dg[k][i];
    force = std::fmax(force, std::fabs(inner(dg[k], tangent, tangent)) / 2);
  }
  return std::fmax(norm(spatial(tangent)) / norm(spatial(x)),
                   std::fmax(largest(along) / largest(g), force / largest(g * tangent)));
}

/// Follows a ray for 100 steps of 1/200 of what it takes until something changes, each in two halves. False
/// where it ends, and where whole steps come out elsewhere: what steps do not resolve proves nothing.
template <Metric M>
bool follow(const M& metric, Phase<double>& at, double& lambda) {
  Phase<double> coarse = at;
  for (int i = 0; i < 100; ++i) {
    const auto rate = rhs(metric, at.x, at.p);
    const double step = 0.005 / rate_of_change(metric, at.x, rate.x);
    coarse = runge_kutta_step(metric, coarse, step);
    at = runge_kutta_step(metric, runge_kutta_step(metric, at, step / 2), step / 2);
    lambda += step;
    const double end = ending(metric, at, rhs(metric, at.x, at.p), 0.0);
    if (end != as_scalar<double>(Ending::none)) return false;
  }
  const double moved = lambda * largest(rhs(metric, at.x, at.p).x);
  return largest(at.x - coarse.x) < 1e-8 * moved && largest(at.p - coarse.p) < 1e-8 * largest(at.p);
}

NULLCONE_KERNEL_END
