// The Gödel universe: closed forms against independent numbers, against the metric, and against each other.
#include "metrics/goedel.h"

#include "tests/random_rays.h"
#include "tests/reference_cases.h"

namespace nullcone::test {
namespace {

using namespace nullcone::host;

Vec4<double> in_direction(const json& in) {
  const double alpha = in["alpha"], s = in["s_inplane_speed"];
  return {{1.0, s * std::cos(alpha), s * std::sin(alpha), in["n_z"]}};
}

void expect_point(const json& c, const PathPoint<double>& P) {
  const json& want = c["expected"];
  const char* names[] = {"t", "x", "y", "z"};
  for (std::size_t i = 0; i < 4; ++i) {
    expect_case(c, names[i], P.event[i], want[names[i]]);
    expect_case(c, std::string("d") + names[i], P.tangent[i], want["dxdlambda_txyz"][i]);
  }
}

TEST(Goedel, MetricAndTetradAgreeWithReference) {
  for (const json& c : cases_of("godel_metric")) {
    const Goedel metric{c["inputs"]["a"]};
    const Vec4<double> x = to_vec4(c["inputs"]["event_txyz"]), v = to_vec4(c["inputs"]["vel"]);
    const auto g = metric.g(x);
    const json& want = c["expected"];
    expect_case(c, "g_xx", g[1][1],
                want.contains("g_xx") ? double(want["g_xx"]) : double(want["g_xx_plus_1"]) - 1);
    expect_case(c, "g_xy", g[1][2], want["g_xy"]);
    expect_case(c, "g_tx", g[0][1], want["g_tx"]);
    expect_case(c, "g_ty", g[0][2], want["g_ty"]);
    const Vec4<double> acceleration = -connection(metric, x, v, v);
    const auto tetrad = metric.static_tetrad(x);
    for (std::size_t i = 0; i < 4; ++i) {
      expect_case(c, "acceleration", acceleration[i], want["geodesic_accel_txyz"][i]);
      expect_case(c, "e1", tetrad.e[1][i], want["tetrad_e1_txyz"][i]);
      expect_case(c, "e2", tetrad.e[2][i], want["tetrad_e2_txyz"][i]);
    }
  }
}

TEST(Goedel, GeodesicsThroughTheOrigin) {
  for (const json& c : cases_of("godel_origin_geodesic")) {
    const Goedel metric{c["inputs"]["a"]};
    expect_point(
        c, metric.path(Vec4<double>{}, in_direction(c["inputs"])).at(c["inputs"]["lambda"].get<double>()));
  }
}

TEST(Goedel, GeodesicsFromAnywhere) {
  for (const json& c : cases_of("godel_general_geodesic")) {
    const Goedel metric{c["inputs"]["a"]};
    const auto P = metric.path(to_vec4(c["inputs"]["start_txyz"]), in_direction(c["inputs"]))
                       .at(c["inputs"]["lambda"].get<double>());
    expect_point(c, P);
    const auto charges = metric.conserved(P.event, P.tangent);
    const char* names[] = {"charge_E", "charge_L", "", "charge_K4", "charge_K5"};
    for (std::size_t i : {0, 1, 3, 4}) expect_case(c, names[i], charges[i].second, c["expected"][names[i]]);
  }
}

TEST(Goedel, Periods) {
  for (const json& c : cases_of("godel_period")) {
    const Goedel metric{c["inputs"]["a"]};
    const double n_z = c["inputs"]["n_z"], s = std::sqrt((1 - n_z) * (1 + n_z));
    const json& want = c["expected"];
    const auto path = metric.path(Vec4<double>{}, Vec4<double>{{1, s, 0, n_z}});
    const double period = want["affine_period"];
    const PathPoint<double> once = path.at(period), half = path.at(0.5 * period);
    EXPECT_NEAR(once.event[0], want["coordinate_time_per_period"].get<double>(), 4e-14) << c["id"];
    EXPECT_NEAR(std::hypot(once.event[1], once.event[2]), 0, 1e-14) << c["id"];
    EXPECT_NEAR(std::hypot(half.event[1], half.event[2]), want["r_max"].get<double>(), 1e-14) << c["id"];
    const double caustic = want["first_caustic_lambda"];
    EXPECT_EQ(metric.caustics(caustic * (1 - 1e-12), n_z), 0.0) << c["id"];
    EXPECT_EQ(metric.caustics(caustic * (1 + 1e-12), n_z), 1.0) << c["id"];
    EXPECT_EQ(metric.caustics(7.9999 * period, n_z), 15.0)
        << c["id"];  // two a lobe, the last just before its end
  }
}

TEST(Goedel, IsometriesAgreeWithReference) {
  for (const json& c : cases_of("godel_isometry")) {
    const Goedel metric{c["inputs"]["a"]};
    const Vec4<double> P0 = to_vec4(c["inputs"]["P0_txyz"]), P = to_vec4(c["inputs"]["P_txyz"]);
    const Vec4<double> to = metric.to_origin(P0, P), from = metric.from_origin(P0, P);
    for (std::size_t i = 0; i < 4; ++i) {
      expect_case(c, "to_origin", to[i], c["expected"]["to_origin_txyz"][i]);
      expect_case(c, "from_origin", from[i], c["expected"]["from_origin_txyz"][i]);
    }
  }
}

TEST(Goedel, TetradIsOrthonormal) {
  Random random(1);
  for (int n = 0; n < 1000; ++n) {
    const Goedel metric{random.logarithmic(1e-3, 1e6)};
    const Vec4<double> x = random.event(5 * metric.a);
    const auto g = metric.g(x);
    const auto tetrad = metric.static_tetrad(x);
    const double u2 = (x[1] * x[1] + x[2] * x[2]) / (4 * metric.a * metric.a);
    for (std::size_t i = 0; i < 4; ++i)
      for (std::size_t j = 0; j < 4; ++j)  // components grow with u^2: rounding does too
        EXPECT_NEAR(inner(g, tetrad.e[i], tetrad.e[j]), i != j ? 0 : i == 0 ? 1 : -1, 1e-14 * (1 + 30 * u2));
  }
}

/// Second derivative of the closed form, by duals of duals, plus the connection from g: zero along a
/// geodesic.
TEST(Goedel, GeodesicEquationHoldsAlongClosedForms) {
  using D = Dual<double, 1>;
  using DD = Dual<D, 1>;
  Random random(2);
  double worst = 0;
  for (int n = 0; n < 2000; ++n) {
    const Goedel metric{n % 3 == 0 ? 1.0 : random.logarithmic(1e-3, 1e12)};
    const double a = metric.a, speed = n % 2 ? 1.0 : random.uniform(0, 0.99);
    Vec4<double> start = random.event(3 * a);
    start[0] = start[3] = 0;
    const auto path = metric.path(convert<DD>(convert<D>(start)),
                                  convert<DD>(convert<D>(moving(random.direction(), speed))));
    const double lambda = random.uniform(-10, 10) * a;
    const auto P = path.at(DD(D(lambda, Vec<double, 1>{{1.0}}), Vec<D, 1>{{D(1.0)}}));
    const auto x = Vec4<double>::map([&](std::size_t i) { return P.event[i].v.v; });
    const auto v = Vec4<double>::map([&](std::size_t i) { return P.event[i].v.d[0]; });
    const auto acceleration = Vec4<double>::map([&](std::size_t i) { return P.event[i].d[0].d[0]; });
    const Vec4<double> residual = acceleration + connection(metric, x, v, v);
    const double size = norm(acceleration) + norm(v) * norm(v) / a;
    for (std::size_t i = 0; i < 4; ++i) {
      EXPECT_NEAR(P.tangent[i].v.v, v[i], 1e-12 * norm(v));  // the tangent is the derivative of the path
      // Beyond r = 2a the connection's terms grow like u^2 and cancel.
      const double u2 = 1 + (x[1] * x[1] + x[2] * x[2]) / (4 * a * a);
      EXPECT_LT(std::fabs(residual[i]), 1e-12 * size * u2) << "n " << n;
      worst = std::max(worst, std::fabs(residual[i]) / (size * u2));
    }
  }
  RecordProperty("worst_relative_residual", std::to_string(worst));
}

/// Rounding in P, Q is amplified by the isometry to the start (docs/physics.md): e^chi = (p0 + |q0|)^2.
double amplification(const Goedel& metric, const Vec4<double>& x) {
  const auto q = metric.to_q(x);
  const double u = std::sqrt(norm2(q));
  return (std::sqrt(1 + u * u) + u) * (std::sqrt(1 + u * u) + u);
}

TEST(Goedel, ConservedQuantitiesAlongManyPeriods) {
  Random random(3);
  for (int n = 0; n < 3000; ++n) {
    const Goedel metric{random.logarithmic(1e-3, 1e12)};
    const double a = metric.a;
    const Vec4<double> start = random.event(2.5 * a), k = moving(random.direction(), n % 2 ? 1.0 : 0.8);
    const auto path = metric.path(start, k);
    const auto P = path.at(0.0), Q = path.at(random.uniform(-300, 300) * a);
    const auto before = metric.conserved(P.event, P.tangent), after = metric.conserved(Q.event, Q.tangent);
    const double grown = amplification(metric, P.event) * amplification(metric, Q.event);
    for (std::size_t i = 0; i < before.size(); ++i) {
      const double unit =
          i == 0 || i == 2 ? 1 : a;  // E and p_z are frequencies, L and the others frequency x a
      EXPECT_NEAR(after[i].second, before[i].second, 1e-12 * unit * std::max(1.0, 0.05 * grown))
          << before[i].first << " a " << a << " n " << n;
    }
    EXPECT_NEAR(inner(metric.g(Q.event), Q.tangent, Q.tangent),
                inner(metric.g(P.event), P.tangent, P.tangent), 1e-12 * std::max(1.0, 0.05 * grown));
  }
}

TEST(Goedel, ManyPeriodsAgreeWithLongDouble) {
  Random random(4);
  for (int n = 0; n < 3000; ++n) {
    const Goedel metric{random.logarithmic(1e-3, 1e12)};
    const double a = metric.a, lambda = random.uniform(-300, 300) * a;
    Vec3<double> d = random.direction();
    if (n % 4 == 0) d = normalised(Vec3<double>{{1e-9 * d[0], 1e-9 * d[1], 1.0}});  // n_z -> 1
    Vec4<double> start = n % 5 == 0 ? Vec4<double>{} : random.event(2 * a);
    start[0] = start[3] = 0;
    const auto P = metric.path(start, moving(d)).at(lambda);
    const auto Q = metric.path(convert<long double>(start), convert<long double>(moving(d))).at(lambda);
    const double periods = 1 + std::fabs(lambda) / (2 * std::numbers::pi * a);
    for (std::size_t i = 0; i < 4; ++i)
      EXPECT_NEAR(P.event[i], static_cast<double>(Q.event[i]), 1e-12 * 5 * a * periods)
          << "n " << n << " a " << a;
  }
}

/// g is unchanged, and the static tetrad goes to the static tetrad turned by turn().
TEST(Goedel, IsometryLeavesTheMetricInvariant) {
  using D = Dual<double, 4>;
  Random random(5);
  for (int n = 0; n < 3000; ++n) {
    const Goedel metric{random.logarithmic(1e-2, 1e3)};
    const Vec4<double> P = random.event(4 * metric.a), x = random.event(4 * metric.a);
    const auto image =
        metric.to_origin(convert<D>(P), Vec4<D>::map([&](std::size_t i) { return D::variable(x[i], i); }));
    const auto y = Vec4<double>::map([&](std::size_t i) { return image[i].v; });
    const auto g_there = metric.g(y);
    const auto tetrad = metric.static_tetrad(x), tetrad_there = metric.static_tetrad(y);
    const double grown = amplification(metric, P) * amplification(metric, x);
    const Complex<double> turn = metric.turn(P, x);
    std::array<Vec4<double>, 4> carried;
    for (std::size_t i = 0; i < 4; ++i)
      carried[i] = Vec4<double>::map([&](std::size_t k) { return dot(image[k].d, tetrad.e[i]); });
    for (std::size_t i = 0; i < 4; ++i)
      for (std::size_t j = 0; j < 4; ++j)
        EXPECT_NEAR(inner(g_there, carried[i], carried[j]), i != j ? 0 : i == 0 ? 1 : -1, 1e-13 * grown);
    const Vec4<double> expected = turn.re * tetrad_there.e[1] + turn.im * tetrad_there.e[2];
    for (std::size_t k = 0; k < 4; ++k)
      EXPECT_NEAR(carried[1][k], expected[k], 1e-13 * grown * std::max(1.0, norm(expected)));
    const Vec4<double> back = metric.from_origin(P, y);
    for (std::size_t k = 0; k < 4; ++k)
      EXPECT_NEAR(back[k], x[k], 1e-13 * grown * 4 * std::max(1.0, metric.a));
  }
}

TEST(Goedel, FlatLimitIsMinkowski) {
  const Goedel metric{1e12};
  const Vec4<double> start = {{0.5, 2, -3, 1}};
  const auto P = metric.path(start, Vec4<double>{{1, 0.6, 0, 0.8}}).at(4.0);
  const double expected[] = {4.5, 4.4, -3, 4.2};  // Coriolis bends by lambda^2/a = 1e-11
  for (std::size_t i = 0; i < 4; ++i) EXPECT_NEAR(P.event[i], expected[i], 3e-11);
}

TEST(Goedel, RegularOnTheAxis) {
  const Goedel metric{1};
  for (const double r : {0.0, 1e-300, 1e-160, 1e-12}) {
    const auto P = metric.path(Vec4<double>{{0, r, -r, 0}}, Vec4<double>{{1, 0, 0, -1}}).at(123.0);
    for (std::size_t i = 0; i < 4; ++i) EXPECT_TRUE(std::isfinite(P.event[i]) && std::isfinite(P.tangent[i]));
    EXPECT_NEAR(P.event[3], -123, 1e-12);
    EXPECT_NEAR(std::hypot(P.event[1], P.event[2]), std::sqrt(2.0) * r, 1e-12 * r + 1e-300);
  }
}

}  // namespace
}  // namespace nullcone::test
