// Checks of a metric: g, its derivatives, Hamilton's equations and constants of motion, all against g alone.
#pragma once

#include "core/trace/check_sample.h"

NULLCONE_KERNEL_BEGIN

using Checks = std::vector<CheckResult>;

/// The constants of motion at a phase point; the tangent comes from g, so that only `conserved` is on trial.
template <Metric M, class S>
auto conserved_at(const M& metric, const Vec4<S>& x, const Vec4<S>& p) {
  return metric.conserved(x, inverse(metric.g(x)) * p);
}

template <class M>
concept HasConserved = requires(const M m, Vec4<double> x) {
  m.conserved(x, x).size();
};

/// g itself: symmetric, with one time and three spaces, invertible. Rounding alone may spoil symmetry; the
/// inverse loses what its minors cancel.
template <Metric M>
void check_components(const M& metric, const std::vector<Vec4<double>>& events, Checks& out) {
  Worst symmetry("g is symmetric", 1e-14), inverted("g times its inverse", 1e-9);
  Worst signature("signature (+,-,-,-): positive eigenvalues", 0);
  for (const Vec4<double>& x : events) {
    const Matrix4<double> g = metric.g(x);
    if (!is_finite(g)) continue;
    symmetry.count(), inverted.count(), signature.count();
    signature.compare(positive_eigenvalues(g), 1, 1, x, [] { return "their number"; });
    const Matrix4<double> over = inverse(g);
    for (std::size_t i = 0; i < 4; ++i)
      for (std::size_t j = 0; j < 4; ++j) {
        symmetry.compare(g[i][j], g[j][i], largest(g), x, [&] { return component("g_", i, j); });
        double product = 0, scale = 1;
        for (std::size_t k = 0; k < 4; ++k)
          product += g[i][k] * over[k][j], scale += std::fabs(g[i][k] * over[k][j]);
        inverted.compare(product, i == j, scale, x, [&] { return component("(g g^-1)_", i, j); });
      }
  }
  for (const Worst* w : {&signature, &symmetry, &inverted}) out.push_back(w->result());
}

/// d_k g_ij by central differences, extrapolated twice (Richardson): the error is of order (step/length)^6.
struct Difference {
  Matrix4<long double> value;
  double change;  ///< from one step size to the next
};
template <Metric M>
Difference finite_difference(const M& metric, const Vec4<double>& x, std::size_t k, double length) {
  using L = long double;
  const auto central = [&](L step) {
    Vec4<L> ahead = convert<L>(x), behind = ahead;
    ahead[k] += step, behind[k] -= step;
    Matrix4<L> a = metric.g(ahead);
    const Matrix4<L> b = metric.g(behind);
    for (std::size_t i = 0; i < 4; ++i) a[i] = (L(1) / (ahead[k] - behind[k])) * (a[i] - b[i]);
    return a;
  };
  const L h = L(length) / 1000;
  const Matrix4<L> coarse = central(h), middle = central(h / 2), fine = central(h / 4);
  Difference out{};
  for (std::size_t i = 0; i < 4; ++i) {
    out.value[i] = (L(1) / 45) * (L(64) * fine[i] - L(20) * middle[i] + coarse[i]);
    out.change =
        std::fmax(out.change, std::fmax(largest(fine[i] - middle[i]), largest(middle[i] - coarse[i])));
  }
  return out;
}

/// What duals differentiate is the g that floating point numbers see. Where differences have not settled (at
/// the edge of a chart) they prove nothing.
template <Metric M>
void check_derivatives(const M& metric, const std::vector<Vec4<double>>& events, Checks& out) {
  Worst worst("dual numbers against finite differences", 1e-9);
  for (const Vec4<double>& x : events) {
    const Matrix4<double> g = metric.g(x);
    if (!is_finite(g)) continue;
    const auto dg = metric_derivatives(metric, x);
    double scale = largest(g) / norm(spatial(x));
    for (const auto& d : dg) scale = std::fmax(scale, largest(d));
    const double length = largest(g) / scale;
    bool settled = false;
    for (std::size_t k = 0; k < 4; ++k) {
      const Difference difference = finite_difference(metric, x, k, length);
      if (difference.change > 1e-5 * scale) continue;
      settled = true;
      for (std::size_t i = 0; i < 4; ++i)
        for (std::size_t j = 0; j < 4; ++j)
          worst.compare(dg[k][i][j], static_cast<double>(difference.value[i][j]), scale, x,
                        [&] { return "d_" + coordinate(k) + " " + component("g_", i, j); });
    }
    if (settled) worst.count();
  }
  out.push_back(worst.result());
}

/// Hamilton's equations as the metric writes them, against those from g in long double. A force is a sum of
/// terms d_k g_ij k^i k^j that may cancel: its error counts against their magnitudes.
template <Metric M>
void check_rhs(const M& metric, const std::vector<Sample>& samples, Checks& out) {
  if constexpr (HasRhs<M>) {
    Worst worst("rhs against dual numbers", 1e-12);
    for (const Sample& s : samples) {
      worst.count();
      const auto x = convert<long double>(s.at.x);
      const auto found = metric.rhs(s.at.x, s.at.p);
      const auto expected = generic_rhs(metric, x, convert<long double>(s.at.p));
      double scale = 0;
      for (const auto& d : metric_derivatives(metric, x)) {
        double sum = 0;
        for (std::size_t i = 0; i < 4; ++i)
          for (std::size_t j = 0; j < 4; ++j)
            sum += static_cast<double>(abs(d[i][j] * expected.x[i] * expected.x[j]) / 2);
        scale = std::fmax(scale, sum);
      }
      for (std::size_t i = 0; i < 4; ++i) {
        worst.compare(found.x[i], static_cast<double>(expected.x[i]), largest(expected.x), s.at.x,
                      [&] { return "dx/dlambda, " + coordinate(i); });
        worst.compare(found.p[i], static_cast<double>(expected.p[i]), scale, s.at.x,
                      [&] { return "dp/dlambda, " + coordinate(i); });
      }
    }
    out.push_back(worst.result());
  }
}

/// A declared constant of motion along a ray, by duals in all directions of phase space.
struct Bracket {
  std::string name;
  double value;
  double rate;   ///< its Poisson bracket with H
  double scale;  ///< the magnitudes of the bracket's eight terms, and of what rounding may do to them
};
template <Metric M>
std::vector<Bracket> brackets(const M& metric, const Sample& s) {
  using L = long double;  // derivatives of g and of its inverse lose digits near singularities
  using D = Dual<L, 8>;
  const auto rate = generic_rhs(metric, convert<L>(s.at.x), convert<L>(s.at.p));
  const L change = rate_of_change(metric, s.at.x, s.tangent);
  const auto variable = [&](const Vec4<double>& v, std::size_t first) {
    return Vec4<D>::map([&](std::size_t i) { return D::variable(L(v[i]), first + i); });
  };
  std::vector<Bracket> out;
  for (const auto& [name, Q] : conserved_at(metric, variable(s.at.x, 0), variable(s.at.p, 4))) {
    L sum = 0, scale = 0;
    for (std::size_t i = 0; i < 4; ++i) {
      const L of_x = Q.d[i] * rate.x[i], of_p = Q.d[i + 4] * rate.p[i];
      sum += of_x + of_p;
      scale += abs(of_x) + abs(of_p) + change * abs(Q.d[i + 4] * L(s.at.p[i]));
    }
    out.push_back(
        {std::string(name), static_cast<double>(Q.v), static_cast<double>(sum), static_cast<double>(scale)});
  }
  return out;
}

template <Metric M>
void check_brackets(const M& metric, const std::vector<Sample>& samples, Checks& out) {
  if constexpr (HasConserved<M>) {
    std::vector<Worst> worst;
    for (const Sample& s : samples) {
      const auto found = brackets(metric, s);
      for (std::size_t q = 0; q < found.size(); ++q) {
        if (q == worst.size()) worst.emplace_back(found[q].name + " is constant: Poisson bracket", 1e-11);
        worst[q].count();
        worst[q].compare(found[q].rate, 0, found[q].scale, s.at.x, [&] { return "d" + found[q].name; });
      }
    }
    for (const Worst& w : worst) out.push_back(w.result());
  }
}

/// The same along a piece of the ray by the metric's own rhs, and g^mn p_m p_n with it. A wrong force shows
/// in the first digits; the limit is what steps may lose.
template <Metric M>
void check_along_rays(const M& metric, const std::vector<Sample>& samples, Checks& out) {
  Worst worst("constants along rays", 1e-6);
  for (const Sample& s : samples) {
    double length = 0;
    Phase<double> at = s.at;
    if (!follow(metric, at, length)) continue;
    worst.count();
    const auto square = [&](const Phase<double>& here) {
      return dot(here.p, generic_rhs(metric, here.x, here.p).x);
    };
    double terms = 0;
    for (std::size_t i = 0; i < 4; ++i) terms += std::fabs(s.at.p[i] * s.tangent[i]);
    worst.compare(square(at), square(s.at), terms, s.at.x, [] { return "g^mn p_m p_n"; });
    if constexpr (HasConserved<M>) {
      const auto after = conserved_at(metric, at.x, at.p);
      std::size_t q = 0;
      for (const Bracket& b : brackets(metric, s)) {
        worst.compare(after[q].second, b.value, std::fabs(b.value) + length * b.scale, s.at.x,
                      [&] { return b.name; });
        ++q;
      }
    }
  }
  out.push_back(worst.result());
}

NULLCONE_KERNEL_END
