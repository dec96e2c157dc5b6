// The checks check: every shipped spacetime passes, and what is planted wrong is found.
#include "core/trace/check_metric.h"

#include <gtest/gtest.h>

#include <algorithm>

#include "metrics/ellis_wormhole.h"
#include "metrics/goedel.h"
#include "metrics/kerr_schild.h"
#include "metrics/minkowski.h"
#include "tests/moving_dielectric.h"
#include "tests/sanitized.h"

namespace nullcone::test {
namespace {

using namespace nullcone::host;

template <class M>
void expect_right(const M& metric) {
  for (unsigned seed = 1; seed <= (kSanitized ? 1 : 3); ++seed)
    for (const CheckResult& r : check_metric(metric, {seed, 400})) {
      EXPECT_TRUE(r.holds()) << M::name << ", " << r.name << ": worst " << r.worst << ", " << r.events
                             << " events, " << r.where;
      EXPECT_GE(r.events, 100U) << r.name;
    }
}

TEST(CheckMetric, ShippedSpacetimesAreRight) {
  expect_right(Minkowski{});
  for (const double a : {1e-3, 1.0, 1e8}) expect_right(Goedel{a});
  for (const double throat : {1e-3, 1.0, 1e8}) expect_right(EllisWormhole{throat});
  for (const double chart : {0.0, 1.0})
    for (const double spin : {-1.0, -0.5, 0.0, 0.3, 0.9, 1.0}) {
      expect_right(KerrSchild{1, spin, chart});
      expect_right(KerrSchild{1e6, spin, chart});
    }
}

/// The checks that fail must be those whose names begin so, and their complaint must hold `text`.
template <class M>
void expect_caught(const M& metric, std::vector<std::string> names, const std::string& text = "") {
  for (const CheckResult& r : check_metric(metric, {1, 400})) {
    const auto expected =
        std::find_if(names.begin(), names.end(), [&](const auto& name) { return r.name.starts_with(name); });
    EXPECT_EQ(r.holds(), expected == names.end()) << r.name << ": " << r.worst << ", " << r.where;
    if (expected == names.end()) continue;
    names.erase(expected);
    EXPECT_NE(r.where.find(text), std::string::npos) << r.where;
    EXPECT_NE(r.where.find(" at ("), std::string::npos) << r.where;
    EXPECT_NE(r.where.find(" against "), std::string::npos) << r.where;
  }
  for (const std::string& name : names) ADD_FAILURE() << name << " is not among the checks";
}

/// A wormhole whose solid angle is d theta^2 + sin theta d phi^2, as once published: static, symmetric about
/// the axis, with a norm and an energy that every integrator keeps; but not spherical.
struct WrongSolidAngle {
  static constexpr std::string_view name = "wrong_solid_angle";
  static constexpr std::tuple<> parameters{};

  template <class S>
  Matrix4<S> g(const Vec4<S>& x) const {
    Matrix4<S> out = EllisWormhole{1}.g(x);
    const S w2 = x[1] * x[1] + x[2] * x[2], rho2 = w2 + x[3] * x[3], over_sine = sqrt(rho2 / w2);
    const S extra = out[3][3] * (over_sine - S(1.0)) / w2;  // times (x dy - y dx)^2
    const Vec4<S> around = {{S(0.0), -x[2], x[1], S(0.0)}};
    for (std::size_t i = 1; i < 3; ++i) out[i] = out[i] + (extra * around[i]) * around;
    return out;
  }
  template <class S>
  auto conserved(const Vec4<S>& x, const Vec4<S>& k) const {
    const Vec4<S> p = g(x) * k;
    using C = std::pair<std::string_view, S>;
    return std::array<C, 4>{C{"E", p[0]}, C{"L_x", x[2] * p[3] - x[3] * p[2]},
                            C{"L_y", x[3] * p[1] - x[1] * p[3]}, C{"L_z", x[1] * p[2] - x[2] * p[1]}};
  }
};

TEST(CheckMetric, FindsSineForSineSquared) {
  // E, L_z and the norm are kept, as they were in the pictures that nobody doubted.
  expect_caught(WrongSolidAngle{}, {"L_x is constant", "L_y is constant", "constants along rays"}, "L_");
}

/// And with the right wormhole's equations beside it.
struct WrongSolidAngleRightRhs : WrongSolidAngle {
  template <class S>
  Phase<S> rhs(const Vec4<S>& x, const Vec4<S>& p) const {
    return EllisWormhole{1}.rhs(x, p);
  }
};

TEST(CheckMetric, FindsThatGAndRhsAreOfTwoSpacetimes) {
  expect_caught(WrongSolidAngleRightRhs{},
                {"rhs against", "L_x is constant", "L_y is constant", "constants along rays"});
}

struct WrongForce : EllisWormhole {
  template <class S>
  Phase<S> rhs(const Vec4<S>& x, const Vec4<S>& p) const {
    Phase<S> out = EllisWormhole::rhs(x, p);
    out.p[2] = -out.p[2];
    return out;
  }
};
TEST(CheckMetric, FindsAWrongSignOfTheForce) {
  expect_caught(WrongForce{}, {"rhs against", "constants along rays"});
  const auto results = check_metric(WrongForce{}, {1, 400});
  const auto rhs = std::find_if(results.begin(), results.end(),
                                [](const auto& r) { return r.name.starts_with("rhs against"); });
  EXPECT_EQ(rhs->where.find("dp/dlambda, y at ("), 0U) << rhs->where;
}

struct Asymmetric : Minkowski {
  template <class S>
  Matrix4<S> g(const Vec4<S>& x) const {
    Matrix4<S> out = Minkowski::g(x);
    out[1][3] = S(1e-9);
    return out;
  }
};
TEST(CheckMetric, FindsAnAsymmetricMetric) {
  const auto results = check_metric(Asymmetric{}, {1, 400});
  const auto symmetry =
      std::find_if(results.begin(), results.end(), [](const auto& r) { return r.name == "g is symmetric"; });
  ASSERT_NE(symmetry, results.end());
  EXPECT_FALSE(symmetry->holds());
  EXPECT_EQ(symmetry->where.find("g_xz at ("), 0U) << symmetry->where;
  EXPECT_NE(symmetry->where.find("1e-09 against 0"), std::string::npos) << symmetry->where;
}

struct WrongSignature {
  static constexpr std::string_view name = "wrong_signature";
  static constexpr std::tuple<> parameters{};
  template <class S>
  Matrix4<S> g(const Vec4<S>& x) const {
    Matrix4<S> out = EllisWormhole{1}.g(x);
    for (std::size_t i = 0; i < 4; ++i) out[i][i] = -out[i][i];
    return out;
  }
};
TEST(CheckMetric, FindsAWrongSignature) {
  const auto results = check_metric(WrongSignature{}, {1, 400});
  const auto failed = [&](const char* name) {
    return std::any_of(results.begin(), results.end(),
                       [&](const auto& r) { return r.name.starts_with(name) && !r.holds(); });
  };
  EXPECT_TRUE(failed("signature"));
  EXPECT_TRUE(failed("events that the chart covers"));
}

struct WrongCarter : KerrSchild {
  template <class S>
  auto conserved(const Vec4<S>& x, const Vec4<S>& k) const {
    auto out = KerrSchild::conserved(x, k);
    out[2].second = out[2].second + S(1e-6) * x[3] * x[3];
    return out;
  }
};
TEST(CheckMetric, FindsWhatIsNotConserved) {
  expect_caught(WrongCarter{{1, 0.9, 0}}, {"Q is constant", "constants along rays"}, "Q");
}

struct NotFlat : Goedel {
  static constexpr int skies = 1;
};
TEST(CheckMetric, FindsASkyWithoutAnInfinity) { expect_caught(NotFlat{}, {"flat far out"}); }

struct WrongIsometry : Goedel {
  template <class S>
  Vec4<S> to_origin(const Vec4<S>& P, const Vec4<S>& x) const {
    Vec4<S> out = Goedel::to_origin(P, x);
    out[0] = x[0] - P[0];  // static worldlines turn against each other: time must shift
    return out;
  }
};
TEST(CheckMetric, FindsAWrongIsometry) {
  expect_caught(WrongIsometry{}, {"the isometry keeps g", "the isometry and its inverse"});
}

struct WrongPath : Minkowski {
  template <class S>
  struct Curve {
    Path<S> path;
    PathPoint<S> at(const S& lambda) const { return path.at(S(1.001) * lambda); }
  };
  template <class S>
  Curve<S> path(const Vec4<S>& start, const Vec4<S>& k) const {
    return {{start, k}};
  }
};
TEST(CheckMetric, FindsAWrongPath) { expect_caught(WrongPath{}, {"closed paths"}); }

struct WrongTetrad : Goedel {
  template <class S>
  Tetrad<S> static_tetrad(const Vec4<S>& x) const {
    Tetrad<S> out = Goedel::static_tetrad(x);
    out.e[1][0] = S(0.0);
    return out;
  }
};
TEST(CheckMetric, FindsAWrongTetrad) {
  const auto results = check_metric(WrongTetrad{}, {1, 400});
  const auto tetrad = std::find_if(results.begin(), results.end(),
                                   [](const auto& r) { return r.name == "static tetrad is orthonormal"; });
  ASSERT_NE(tetrad, results.end());
  EXPECT_FALSE(tetrad->holds());
  EXPECT_NE(tetrad->where.find("e1"), std::string::npos) << tetrad->where;
}

struct NotANumber : Minkowski {
  template <class S>
  Phase<S> rhs(const Vec4<S>& x, const Vec4<S>& p) const {
    Phase<S> out = Minkowski::rhs(x, p);
    if (x[1] > S(0.0)) out.p[1] = sqrt(S(-1.0));
    return out;
  }
};
TEST(CheckMetric, FindsNumbersThatBreakDown) {
  const auto results = check_metric(NotANumber{}, {1, 400});
  EXPECT_TRUE(std::any_of(results.begin(), results.end(),
                          [](const auto& r) { return r.name.starts_with("rhs against") && !r.holds(); }));
}

TEST(MovingDielectric, PassesTheChecks) {
  expect_right(MovingDielectric{});
  expect_right(MovingDielectric{2.4, 1e6, -0.3, 0});
  expect_right(MovingDielectric{1.33, 0.01, 0.2, 0.5});
}

TEST(MovingDielectric, DragsLightAlongLikeFresnel) {
  // In the middle of a very large drop that flows along x with velocity v: (1/n + v)/(1 + v/n) downstream,
  // Einstein's sum of velocities; Fresnel's 1/n + v (1 - 1/n^2) to first order. Across, in the medium's frame
  // and then boosted: the light that has v_x = v has v_y = sqrt(1 - v^2)/n.
  for (const double n : {1.0, 1.33, 2.0})
    for (const double v : {0.0, 1e-4, -0.3, 0.45}) {
      const MovingDielectric metric{n, 1e12, 0, v / std::sqrt(1 - v * v)};
      const Matrix4<double> g = metric.g(Vec4<double>{{0, 1, 2, 3}});
      const auto null = [&](double vx, double vy) {
        const Vec4<double> k = {{1, vx, vy, 0}};
        return inner(g, k, k);
      };
      EXPECT_NEAR(null((1 / n + v) / (1 + v / n), 0), 0, 1e-14);
      EXPECT_NEAR(null((-1 / n + v) / (1 - v / n), 0), 0, 1e-14);
      EXPECT_NEAR(null(v, std::sqrt(1 - v * v) / n), 0, 1e-14);
      const double fresnel = 1 / n + v * (1 - 1 / (n * n));
      EXPECT_NEAR((1 / n + v) / (1 + v / n), fresnel, 2 * v * v);
    }
}

TEST(CheckMetric, CountsEigenvalues) {
  Matrix4<double> m{};
  for (std::size_t i = 0; i < 4; ++i) m[i][i] = i < 3 ? 1 : -1;
  EXPECT_EQ(positive_eigenvalues(m), 3);
  m[1][2] = m[2][1] = 5;  // 1 +- 5
  EXPECT_EQ(positive_eigenvalues(m), 2);
}

}  // namespace
}  // namespace nullcone::test
