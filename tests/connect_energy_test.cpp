// Connections and energy: what leaves a lamp goes through every closed surface around it; lamps and events
// change places; moving lamps in flat spacetime against tabulated numbers.
#include <gtest/gtest.h>

#include "tests/connections.h"
#include "tests/reference_cases.h"

namespace nullcone::test {
namespace {

constexpr double kSphere = 4 * std::numbers::pi;

/// A closed surface at rest: a sphere in the chart. The volume element of the space at rest is that of the
/// chart, in both spacetimes.
struct Surface {
  Vec3<double> centre;
  double radius;
};

/// The light of a lamp of unit intensity at rest that goes through a surface, outwards less inwards, by paths
/// up to an affine length: sum of E dA, E = cos alpha / |det D|.
template <class M>
double flux(const M& metric, const Vec4<double>& lamp, const Surface& surface, int windings, double longest) {
  constexpr int kPoints = 200000;
  const auto line = lamp_at_rest(metric, lamp);
  double out = 0;
  for (int i = 0; i < kPoints; ++i) {
    const Vec3<double> normal = golden_point(i, kPoints), X = surface.centre + surface.radius * normal;
    const Vec4<double> event = {{3, X[0], X[1], X[2]}};
    const auto tetrad = static_tetrad(metric, event);
    for (const auto& c : all_connections(metric, event, line, windings))
      if (c.lambda < longest)
        out +=
            dot(normal, spatial(-tetrad.to_chart(c.past))) / std::fabs(c.det);  // cos alpha dA per R^2 dOmega
  }
  return out * surface.radius * surface.radius * kSphere / kPoints;
}

/// The light that is outside the surface after this affine length, ray by ray.
template <class M>
double outside(const M& metric, const Vec4<double>& lamp, const Surface& surface, double lambda) {
  constexpr int kRays = 200000;
  int count = 0;
  for (int i = 0; i < kRays; ++i) {
    const Vec3<double> n = golden_point(i, kRays);
    const auto end = metric.path(lamp, Vec4<double>{{1, n[0], n[1], n[2]}}).at(lambda);
    count += norm(spatial(end.event) - surface.centre) > surface.radius;
  }
  return kSphere * count / kRays;
}

TEST(ConnectEnergy, FlatSurfacesCatchAllLight) {
  const Vec4<double> lamp = {{1, .3, -.2, .5}};
  const Vec3<double> place = spatial(lamp);
  EXPECT_NEAR(flux(Minkowski{}, lamp, {place, 2}, 1, 100), kSphere, 1e-9);
  EXPECT_NEAR(flux(Minkowski{}, lamp, {place + Vec3<double>{{.8, -.4, .6}}, 2}, 1, 100), kSphere, 1e-3);
  EXPECT_NEAR(flux(Minkowski{}, lamp, {place + Vec3<double>{{2, -1, 1}}, 2}, 1, 100), 0, 1e-3);
}

TEST(ConnectEnergy, GoedelSurfacesCatchAllLight) {
  const Goedel metric{1.5};
  const double a = metric.a, once = std::numbers::pi * a;
  const Vec4<double> axis = {{2, 0, 0, .4}};
  // After half a revolution all light is farther away than 1.95 a.
  for (const double radius : {.2, 1.0, 1.6, 1.95}) {
    const Surface around = {spatial(axis), radius * a};
    EXPECT_NEAR(outside(metric, axis, around, once), kSphere, 1e-9) << radius;
    EXPECT_NEAR(flux(metric, axis, around, 2, once), kSphere, 1e-3 * kSphere) << radius;
  }
  // Lamp and surface anywhere.
  const Vec4<double> lamp = {{2, .5 * a, -.3 * a, .4}};
  for (const Vec3<double>& off : {Vec3<double>{{.3, -.2, .4}}, Vec3<double>{{-.5, .3, -.2}}}) {
    const Surface moved = {spatial(lamp) + a * off, 1.2 * a};
    EXPECT_NEAR(outside(metric, lamp, moved, once), kSphere, 1e-9);
    EXPECT_NEAR(flux(metric, lamp, moved, 2, once), kSphere, 1e-3 * kSphere);
  }
}

/// What goes through a latitude of a surface that has the lamp in its middle, on the axis; and which of the
/// branches.
struct Ring {
  std::vector<bool> seen;
  double brightness = 0;
};
Ring ring(const Goedel& metric, double radius, int windings, double longest, double z) {
  const Vec3<double> normal = {{std::sqrt((1 - z) * (1 + z)), 0, z}};
  const Vec4<double> event = {{3, radius * normal[0], 0, radius * z}};
  const auto line = lamp_at_rest(metric, Vec4<double>{});
  Ring out;
  for (int branch = 0; branch < branches(metric, windings); ++branch) {
    const auto c = connect(metric, event, line, branch);
    out.seen.push_back(c.found && c.lambda < longest);
    if (out.seen.back())
      out.brightness +=
          dot(normal, spatial(-static_tetrad(metric, event).to_chart(c.past))) / std::fabs(c.det);
  }
  return out;
}

/// As flux(), latitude by latitude. Brightness goes like one over the root of the distance to a caustic,
/// where branches begin and end: so they divide the integral, and points crowd towards them (Chebyshev).
double flux_by_latitude(const Goedel& metric, double radius, int windings, double longest) {
  const auto at = [&](double z) { return ring(metric, radius, windings, longest, z); };
  constexpr int kSteps = 20000, kPoints = 1000;
  std::vector<double> parts = {-1};
  for (int i = 0; i < kSteps; ++i) {
    double from = (2.0 * i) / kSteps - 1, to = (2.0 * i + 2) / kSteps - 1;
    const auto before = at(from).seen;
    if (before == at(to).seen) continue;
    for (int k = 0; k < 50; ++k) {
      const double middle = 0.5 * (from + to);
      (at(middle).seen == before ? from : to) = middle;
    }
    parts.push_back(from);
  }
  parts.push_back(1);
  double out = 0;
  for (std::size_t n = 1; n < parts.size(); ++n) {
    const double middle = 0.5 * (parts[n] + parts[n - 1]), half = 0.5 * (parts[n] - parts[n - 1]);
    for (int i = 0; i < kPoints && half > 1e-12; ++i) {
      const double angle = (i + 0.5) * std::numbers::pi / kPoints;
      out += half * std::sin(angle) * at(middle - half * std::cos(angle)).brightness;
    }
  }
  return out * radius * radius * 0.5 * kSphere * std::numbers::pi / kPoints;
}

TEST(ConnectEnergy, SheetsOverlapAboutTheHorizon) {
  // Light that went out comes back in; near the horizon by many sheets. Beyond 2a only light along z leaves.
  const Goedel metric{1};
  for (const double radius : {1.2, 1.9, 1.999, 2.0, 2.2, 3.0})
    for (const double longest : {2.5, 4.0, 7.0, 9.5})
      EXPECT_NEAR(flux_by_latitude(metric, radius, 4, longest),
                  outside(metric, Vec4<double>{}, {{}, radius}, longest), 1e-3 * kSphere)
          << radius << " " << longest;
}

TEST(ConnectEnergy, LampAndEventChangePlaces) {
  Random random(31);
  int found = 0;
  for (int n = 0; n < 1000; ++n) {
    const Goedel metric{random.logarithmic(1e-2, 1e4)};
    const Vec4<double> one = metric.a * random.event(1), other = metric.a * random.event(1);
    const auto there = all_connections(metric, one, lamp_at_rest(metric, other), 3),
               back = all_connections(metric, other, lamp_at_rest(metric, one), 3);
    ASSERT_EQ(there.size(), back.size());
    for (std::size_t i = 0; i < there.size(); ++i) {
      ++found;
      EXPECT_NEAR(there[i].lambda, back[i].lambda, 1e-12 * there[i].lambda);
      EXPECT_NEAR(there[i].det, back[i].det, 1e-10 * there[i].lambda * there[i].lambda);
      EXPECT_NEAR(there[i].past[3], -back[i].past[3], 1e-12);
      // All circles run the same way, so that there and back are different paths and take different times.
      const double time = one[0] - there[i].emitted[0], return_time = other[0] - back[i].emitted[0];
      EXPECT_GT(std::fabs(time - return_time), 1e-9 * metric.a);
    }
  }
  EXPECT_GT(found, 1000);
}

TEST(ConnectFlat, MovingLightsAsTabulated) {
  for (const json& c : cases_of("sr_point_light")) {
    const json &in = c["inputs"], &want = c["expected"];
    const Vec3<double> V = to_vec3(in["light_velocity_in_object_frame"]),
                       R = to_vec3(in["emission_pos_in_object_frame"]), normal = to_vec3(in["patch_normal"]);
    // The lamp's worldline, given by an event long before the emission.
    const Vec4<double> event = {{4, 1, -2, .5}};
    const double distance = norm(R), before = 7;
    const Vec3<double> early = spatial(event) + R - before * V;
    const Minkowski flat;
    const Vec4<double> start = {{event[0] - distance - before, early[0], early[1], early[2]}};
    const auto line = falling_lamp(flat, start, V);
    const auto found = all_connections(flat, event, line, 1);
    ASSERT_EQ(found.size(), 1u);
    const Connection<double>& got = found[0];
    EXPECT_NEAR(got.lambda, want["r_prime"].get<double>(), 1e-12) << c["id"];
    EXPECT_NEAR(event[0] - got.emitted[0], distance, 1e-12) << c["id"];
    EXPECT_LT(miss(flat, event, got), 1e-14) << c["id"];
    const Vec4<double> u = four_velocity(V);
    EXPECT_NEAR(got.tau, before / u[0], 1e-12) << c["id"];
    const double g = 1 / -(got.tangent[0] * u[0] - dot(spatial(got.tangent), spatial(u)));
    EXPECT_NEAR(g, want["g"].get<double>(), 1e-12) << c["id"];
    const double cos_alpha = dot(spatial(got.past), normal), E = cos_alpha / std::fabs(got.det);
    EXPECT_NEAR(cos_alpha, want["cos_alpha"].get<double>(), 1e-12) << c["id"];
    const double irradiance = in["I"].get<double>() * std::pow(g, 4) * E;
    EXPECT_NEAR(irradiance / want["E_prime"].get<double>(), 1, 1e-10) << c["id"];
  }
}

TEST(ConnectFlat, FastLampsKeepTheirDigits) {
  Random random(32);
  for (int n = 0; n < 2000; ++n) {
    const Minkowski flat;
    const double speed = 1 - random.logarithmic(1e-8, 1);
    const auto line = falling_lamp(flat, random.event(3), speed * random.direction());
    const Vec4<double> event = random.event(3);
    const auto got = connect(flat, event, line, 0);
    ASSERT_TRUE(got.found);
    EXPECT_GT(got.lambda, 0);
    EXPECT_LT(miss(flat, event, got), 1e-14 * line.body.frame.u[0]);
    const Vec4<double> there = line.event(got.tau);
    for (std::size_t i = 0; i < 4; ++i)
      EXPECT_NEAR(there[i], got.emitted[i], 1e-14 * line.body.frame.u[0] * (1 + std::fabs(got.tau)));
  }
}

}  // namespace
}  // namespace nullcone::test
