// The spacetimes that are integrated, against what is known of them: Kerr and Schwarzschild, the wormhole;
// and every rhs against dual numbers.
#include <gtest/gtest.h>

#include "core/trace/check_metric.h"
#include "metrics/ellis_wormhole.h"
#include "metrics/goedel.h"
#include "metrics/kerr_schild.h"
#include "metrics/minkowski.h"
#include "tests/random_rays.h"

namespace nullcone::test {
namespace {

using namespace nullcone::host;

/// Calls f with a wide choice of every spacetime: both charts, all spins, parameters far from 1.
template <class F>
void for_all_metrics(F&& f) {
  f(Minkowski{});
  for (const double a : {1e-3, 1.0, 1e8}) f(Goedel{a});
  for (const double throat : {1e-3, 1.0, 1e8}) f(EllisWormhole{throat});
  for (const double chart : {0.0, 1.0})
    for (const double spin : {-1.0, -0.5, 0.0, 0.3, 0.9, 0.998, 1.0})
      for (const double mass : {1.0, 1e-4, 1e9}) f(KerrSchild{mass, spin, chart});
}

void expect_all_hold(const std::vector<CheckResult>& results) {
  for (const CheckResult& r : results) EXPECT_TRUE(r.holds()) << r.name << ": " << r.worst << ", " << r.where;
}

TEST(Metrics, RhsAgreesWithDualNumbers) {
  for_all_metrics([](const auto& metric) {
    Sampler sampler(metric, 7);
    std::vector<Sample> samples(4000);
    for (Sample& s : samples)
      while (!sampler.sample(s)) continue;
    std::vector<CheckResult> results;
    check_rhs(metric, samples, results);
    expect_all_hold(results);
  });
}

TEST(Metrics, PacksAndDoublesAgreeToTheLastBit) {
  for_all_metrics([](const auto& metric) {
    Sampler sampler(metric, 8);
    for (int n = 0; n < 200; ++n) {
      Sample one, two;
      while (!sampler.sample(one) || !sampler.sample(two)) continue;
      const auto both = [](const Vec4<double>& a, const Vec4<double>& b) {
        return Vec4<Pack>::map([&](std::size_t i) {
          const std::array<double, 2> lanes = {a[i], b[i]};
          return Lanes<Pack>::load(lanes.data());
        });
      };
      const Phase<Pack> at = {both(one.at.x, two.at.x), both(one.at.p, two.at.p)};
      const Phase<Pack> rate = metric.rhs(at.x, at.p);
      const Pack end = ending(metric, at, rate, 1e-8), length = length_scale(metric, at.x);
      const Vec3<Pack> sky = sky_direction(metric, at, rate, as_scalar<Pack>(Ending::sky));
      for (const std::size_t lane : {0U, 1U}) {
        const Phase<double> here = lane == 0 ? one.at : two.at, alone = metric.rhs(here.x, here.p);
        for (std::size_t i = 0; i < 4; ++i) {
          EXPECT_EQ(rate.x[i].get(lane), alone.x[i]);
          EXPECT_EQ(rate.p[i].get(lane), alone.p[i]);
        }
        EXPECT_EQ(end.get(lane), ending(metric, here, alone, 1e-8));
        EXPECT_EQ(length.get(lane), length_scale(metric, here.x));
        const auto direction = sky_direction(metric, here, alone, as_scalar<double>(Ending::sky));
        for (std::size_t i = 0; i < 3; ++i) {
          if (std::isfinite(direction[i])) {
            EXPECT_EQ(sky[i].get(lane), direction[i]);
          }
        }
      }
    }
  });
}

TEST(Metrics, NotANumberEndsNothingAndStaysVisible) {
  for_all_metrics([](const auto& metric) {
    const double nan = std::nan("");
    const Phase<double> at = {{{0, nan, 1, 1}}, {{1, -1, 0, 0}}}, rate = metric.rhs(at.x, at.p);
    EXPECT_EQ(ending(metric, at, rate, 1e-8), as_scalar<double>(Ending::none));
    if constexpr (!std::is_same_v<decltype(metric), const Minkowski&>) {
      EXPECT_TRUE(std::isnan(rate.p[1]));
    }
  });
}

/// The Ricci tensor from g by dual numbers of dual numbers.
template <Metric M>
Matrix4<double> ricci(const M& metric, const Vec4<double>& x) {
  using D = Dual<double, 4>;
  const auto X = Vec4<D>::map([&](std::size_t i) { return D::variable(x[i], i); });
  const auto dg = metric_derivatives(metric, X);
  const Matrix4<D> over = inverse(metric.g(X));
  std::array<Matrix4<D>, 4> gamma{};  // gamma[a][b][c], first index up
  for (std::size_t a = 0; a < 4; ++a)
    for (std::size_t b = 0; b < 4; ++b)
      for (std::size_t c = 0; c < 4; ++c)
        for (std::size_t d = 0; d < 4; ++d)
          gamma[a][b][c] = gamma[a][b][c] + D(0.5) * over[a][d] * (dg[b][d][c] + dg[c][d][b] - dg[d][b][c]);
  Matrix4<double> out{};
  for (std::size_t b = 0; b < 4; ++b)
    for (std::size_t c = 0; c < 4; ++c)
      for (std::size_t a = 0; a < 4; ++a) {
        out[b][c] += gamma[a][b][c].d[a] - gamma[a][b][a].d[c];
        for (std::size_t d = 0; d < 4; ++d)
          out[b][c] += gamma[a][a][d].v * gamma[d][b][c].v - gamma[a][c][d].v * gamma[d][b][a].v;
      }
  return out;
}

TEST(KerrSchild, IsAVacuum) {
  Random random(1);
  for (int n = 0; n < 1000; ++n) {
    const KerrSchild metric{1, random.uniform(-1, 1), n % 2 == 0 ? 0.0 : 1.0};
    const Vec3<double> X = random.logarithmic(1.2, 50) * random.direction();
    const double r = metric.congruence(Vec4<double>{{0, X[0], X[1], X[2]}}).r;
    if (r < 0.5) continue;
    // The tidal field is of order M/r^3; second derivatives of g by duals round at 1e-16 of M/r^3 (1 +
    // 2M/r)^3.
    EXPECT_LT(largest(ricci(metric, {{0, X[0], X[1], X[2]}})), 1e-11 / (r * r * r))
        << metric.spin << " " << r;
  }
  EXPECT_GT(largest(ricci(Goedel{1}, {{0, 0.3, 0.2, 0.1}})), 0.5);  // dust: the yardstick sees matter
}

TEST(KerrSchild, CongruenceIsNullAndTheRadiusIsThatOfTheSpheroids) {
  Random random(2);
  for (int n = 0; n < 1000; ++n) {
    const KerrSchild metric{2, random.uniform(-1, 1), n % 2 == 0 ? 0.0 : 1.0};
    const Vec4<double> x = random.event(20);
    const auto c = metric.congruence(x);
    EXPECT_NEAR(dot(c.l, c.l), 1, 1e-12);
    EXPECT_NEAR((x[1] * x[1] + x[2] * x[2]) / c.r2_a2 + x[3] * x[3] / (c.r * c.r), 1, 1e-12);
  }
}

TEST(KerrSchild, KillingVectorsHaveTheLengthsOfBoyerAndLindquist) {
  Random random(3);
  for (int n = 0; n < 1000; ++n) {
    const KerrSchild metric{1.5, random.uniform(-1, 1), n % 2 == 0 ? 0.0 : 1.0};
    const Vec4<double> x = random.event(10);
    const auto c = metric.congruence(x);
    const double sine2 = (x[1] * x[1] + x[2] * x[2]) / c.r2_a2, a = metric.a(), M = metric.mass;
    const Matrix4<double> g = metric.g(x);
    const Vec4<double> turning = {{0, -x[2], x[1], 0}}, still = {{1, 0, 0, 0}};
    const double h = 2 * M * c.r / c.sigma;
    const double limit = 1e-12 * (1 + h) * c.r2_a2;
    EXPECT_NEAR(inner(g, still, still), 1 - h, limit);
    EXPECT_NEAR(inner(g, still, turning), h * a * sine2, limit);
    EXPECT_NEAR(inner(g, turning, turning), -(c.r2_a2 + h * a * a * sine2) * sine2, limit);
  }
}

TEST(KerrSchild, HorizonIsNull) {
  Random random(4);
  for (int n = 0; n < 1000; ++n) {
    const KerrSchild metric{1, random.uniform(-1, 1), n % 2 == 0 ? 0.0 : 1.0};
    const Vec3<double> d = random.direction();
    const double r = metric.horizon(), flat = std::sqrt((r * r + metric.a() * metric.a()) / 1.0);
    using D = Dual<double, 4>;
    const Vec4<double> x = {{0, flat * d[0], flat * d[1], r * d[2]}};  // on the spheroid r = r_+
    const auto radius =
        metric.congruence(Vec4<D>::map([&](std::size_t i) { return D::variable(x[i], i); })).r;
    EXPECT_NEAR(radius.v, r, 1e-12);
    EXPECT_NEAR(dot(radius.d, inverse(metric.g(x)) * radius.d), 0, 1e-12);
  }
}

/// The second derivative of the position along a ray, by duals.
template <Metric M>
Vec4<double> acceleration(const M& metric, const Phase<double>& at) {
  using D = Dual<double, 1>;
  const Phase<double> rate = metric.rhs(at.x, at.p);
  const auto along = [](const Vec4<double>& v, const Vec4<double>& d) {
    return Vec4<D>::map([&](std::size_t i) { return D(v[i], {{d[i]}}); });
  };
  const Vec4<D> velocity = metric.rhs(along(at.x, rate.x), along(at.p, rate.p)).x;
  return Vec4<double>::map([&](std::size_t i) { return velocity[i].d[0]; });
}

TEST(KerrSchild, LightObeysTheSchwarzschildEquations) {
  for (const double chart : {0.0, 1.0}) {
    const KerrSchild metric{1.3, 0, chart};
    Sampler sampler(metric, 5);
    for (int n = 0; n < 1000; ++n) {
      Sample s;
      if (!sampler.sample(s) ||
          std::fabs(s.local[1] * s.local[1] + s.local[2] * s.local[2] + s.local[3] * s.local[3] - 1) > 1e-12)
        continue;  // light only
      const Vec3<double> X = spatial(s.at.x), V = spatial(s.tangent), A = spatial(acceleration(metric, s.at));
      const double r = norm(X), L2 = dot(cross(X, V), cross(X, V)), E = s.at.p[0],
                   f = 1 - 2 * metric.mass / r;
      const double expected = -3 * metric.mass * L2 / std::pow(r, 5), radial = dot(X, V) / r;
      const double scale = dot(V, V) / r * (1 + metric.mass / r);  // of the terms that cancel
      for (std::size_t i = 0; i < 3; ++i) EXPECT_NEAR(A[i], expected * X[i], 1e-11 * scale);  // (8.2)
      EXPECT_NEAR(radial * radial, E * E - f * L2 / (r * r), 1e-11 * dot(V, V));
    }
  }
}

TEST(KerrSchild, LightCirclesAtThePhotonOrbits) {
  // r = 2M (1 + cos(2/3 arccos(-+a/M))), with and against the hole's turning (Bardeen, Press & Teukolsky
  // 1972).
  for (const double spin : {0.0, 0.5, 0.9})
    for (const double sense : {1.0, -1.0}) {
      const KerrSchild metric{1, spin, 0};
      const double r = 2 * (1 + std::cos(2.0 / 3 * std::acos(-sense * spin)));
      const Vec4<double> x = {{0, std::sqrt(r * r + spin * spin), 0, 0}}, turning = {{0, 0, x[1], 0}};
      const Matrix4<double> g = metric.g(x);
      const double A = inner(g, turning, turning), B = g[0][2] * x[1], C = g[0][0];
      const double omega = (-B - sense * std::sqrt(B * B - A * C)) / A;
      const Vec4<double> k = {{1, 0, omega * x[1], 0}};
      const auto step = acceleration(metric, {x, g * k});
      EXPECT_NEAR(sense * omega, 1 / (std::pow(r, 1.5) + sense * spin), 1e-12);
      EXPECT_NEAR(step[0], 0, 1e-13);
      EXPECT_NEAR(step[1], -omega * omega * x[1], 1e-13);
      EXPECT_NEAR(step[2], 0, 1e-13);
      EXPECT_NEAR(step[3], 0, 1e-13);
    }
}

TEST(KerrSchild, CarterConstantIsThatOfTheSeparatedEquations) {
  // Q = p_theta^2 + cos^2 (a^2 (m^2 - E^2) + L^2/sin^2) (Carter 1968): by the coordinates' own derivatives.
  Random random(6);
  for (int n = 0; n < 1000; ++n) {
    const KerrSchild metric{1, random.uniform(-1, 1), n % 2 == 0 ? 0.0 : 1.0};
    const Vec4<double> x = random.event(8);
    const Vec4<double> k = {{1, random.normal(), random.normal(), random.normal()}}, p = metric.g(x) * k;
    const auto c = metric.congruence(x);
    const double w = std::sqrt(x[1] * x[1] + x[2] * x[2]), sine = w / std::sqrt(c.r2_a2), cosine = x[3] / c.r;
    const double p_theta = (x[1] * p[1] + x[2] * p[2]) * cosine / sine - c.r * sine * p[3];
    const double E = p[0], L = x[1] * p[2] - x[2] * p[1], m2 = dot(p, k), a2 = metric.a() * metric.a();
    const double Q = p_theta * p_theta + cosine * cosine * (a2 * (m2 - E * E) + L * L / (sine * sine));
    const auto conserved = metric.conserved(x, k);
    const double scale = (1 + 1 / (sine * sine)) * (1 + dot(p, p)) * (1 + dot(spatial(x), spatial(x)));
    EXPECT_NEAR(conserved[2].second, Q, 1e-12 * scale);
    EXPECT_NEAR(conserved[1].second, L, 1e-12 * scale);
    EXPECT_NEAR(conserved[0].second, E, 1e-12 * scale);
  }
}

TEST(Metrics, ConstantsOfMotionAreConstant) {
  for_all_metrics([](const auto& metric) {
    Sampler sampler(metric, 9);
    std::vector<Sample> samples(500);
    for (Sample& s : samples)
      while (!sampler.sample(s)) continue;
    std::vector<CheckResult> results;
    check_brackets(metric, samples, results);
    EXPECT_GE(results.size(), 3U);
    expect_all_hold(results);
  });
}

TEST(EllisWormhole, ExchangingTheSidesKeepsTheMetric) {
  using D = Dual<double, 4>;
  Random random(10);
  const EllisWormhole metric{2.6};
  for (int n = 0; n < 1000; ++n) {
    const Vec3<double> X = random.logarithmic(1e-3, 1e3) * random.direction();
    const Vec4<double> x = {{1, X[0], X[1], X[2]}};
    const auto d = Vec4<D>::map([&](std::size_t i) { return D::variable(x[i], i); });
    const D factor = D(metric.quarter()) / dot(spatial(d), spatial(d));
    const Vec4<D> y = {{d[0], factor * d[1], factor * d[2], factor * d[3]}};
    const Matrix4<double> here = metric.g(x),
                          there = metric.g(Vec4<double>::map([&](std::size_t i) { return y[i].v; }));
    for (std::size_t i = 0; i < 4; ++i)
      for (std::size_t j = 0; j < 4; ++j) {
        double pulled_back = 0;
        for (std::size_t k = 0; k < 4; ++k) pulled_back += there[k][k] * y[k].d[i] * y[k].d[j];
        EXPECT_NEAR(pulled_back, here[i][j], 1e-13 * largest(here));
      }
  }
}

TEST(EllisWormhole, IsEllis1973) {
  // ds^2 = dt^2 - dl^2 - (b^2 + l^2) dOmega^2 with l = rho - b^2/(4 rho): along and across the radius.
  const EllisWormhole metric{1.7};
  for (const double rho : {1e-3, 0.3, 0.85, 2.0, 1e4}) {
    const Matrix4<double> g = metric.g(Vec4<double>{{0, rho, 0, 0}});
    const double l = rho - metric.quarter() / rho, dl = 1 + metric.quarter() / (rho * rho);
    EXPECT_NEAR(-g[1][1] / (dl * dl), 1, 1e-14);
    EXPECT_NEAR(-g[2][2] * rho * rho / (metric.throat * metric.throat + l * l), 1, 1e-13);
  }
}

}  // namespace
}  // namespace nullcone::test
