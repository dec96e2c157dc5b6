// Connections with lamps at rest: against independent numbers, against paths, and against a search by force.
#include <algorithm>

#include "tests/connections.h"
#include "tests/reference_cases.h"

namespace nullcone::test {
namespace {

constexpr double kClose = 1e-10;

void expect_image(const json& c, const json& want, const Goedel& metric, const Vec4<double>& event,
                  const Connection<double>& got) {
  const bool general = want.contains("coordinate_travel_time");
  const json& view = general ? want["view_dir_123"] : want["view_dir_xyz"];
  EXPECT_NEAR(got.lambda, want["affine_length"].get<double>(), kClose) << c["id"];
  EXPECT_NEAR(event[0] - got.emitted[0],
              want[general ? "coordinate_travel_time" : "travel_time"].get<double>(), kClose)
      << c["id"];
  for (std::size_t i = 0; i < 3; ++i)
    EXPECT_NEAR(got.past[i + 1], view[i].get<double>(), kClose) << c["id"] << " view " << i;
  EXPECT_NEAR(got.det, want["detD_signed"].get<double>(), kClose) << c["id"];
  EXPECT_NEAR(area(metric, got.lambda, got.past[3]), got.det, kClose) << c["id"];
  EXPECT_LT(miss(metric, event, got), 1e-13) << c["id"];
}

void expect_images(const json& c, const Goedel& metric, const Vec4<double>& event, const Vec4<double>& lamp) {
  const int lobes = c["inputs"]["lobes_searched"];
  const auto found = all_connections(metric, event, lamp_at_rest(metric, lamp), lobes);
  const json& images = c["expected"]["images"];
  ASSERT_EQ(found.size(), images.size()) << c["id"];
  for (std::size_t i = 0; i < found.size(); ++i) expect_image(c, images[i], metric, event, found[i]);
}

TEST(Connect, ReferenceCasesFromTheOrigin) {
  for (const json& c : cases_of("godel_two_point")) {
    const json& in = c["inputs"];
    const double r = in["r0"], phi = in["phi0"];
    expect_images(c, {in["a"]}, Vec4<double>{{5, 0, 0, 0}},
                  Vec4<double>{{-3, r * std::cos(phi), r * std::sin(phi), in["z0"]}});
  }
}

TEST(Connect, ReferenceCasesBetweenAnyPlaces) {
  for (const json& c : cases_of("godel_two_point_general")) {
    const Vec3<double> observer = to_vec3(c["inputs"]["observer_xyz"]),
                       lamp = to_vec3(c["inputs"]["source_xyz"]);
    expect_images(c, {c["inputs"]["a"]}, {{-2, observer[0], observer[1], observer[2]}},
                  {{7, lamp[0], lamp[1], lamp[2]}});
  }
}

TEST(Connect, Fold) {
  for (const json& c : cases_of("godel_two_point_fold")) {
    const json &in = c["inputs"], &want = c["expected"];
    const Goedel metric{in["a"]};
    const int lobe = in["lobe"];
    const GoedelFold<double> fold({lobe, false}, in["z0"].get<double>() / (std::sqrt(2.0) * metric.a));
    EXPECT_NEAR(std::hypot(fold.p, fold.zeta), want["Psi_fold"].get<double>(), 1e-10);
    EXPECT_NEAR(2 * metric.a * fold.F, want["r0_max"].get<double>(), 1e-14);
    for (const double side : {-1, 1}) {
      const double r = want["r0_max"].get<double>() * (1 + side * 1e-13);
      const auto found = all_connections(metric, Vec4<double>{},
                                         lamp_at_rest(metric, Vec4<double>{{0, r, 0, in["z0"]}}), lobe + 1);
      EXPECT_EQ(found.size(), side < 0 ? 2u : 0u);
      for (const auto& one : found)
        EXPECT_NEAR(-one.emitted[0], want["travel_time_at_fold"].get<double>(), 1e-6);
    }
  }
}

TEST(Connect, FocusingAsTabulated) {
  for (const json& c : cases_of("godel_area_distance")) {
    const json &in = c["inputs"], &want = c["expected"];
    const Goedel metric{in["a"]};
    const double n_z = in["n_z"], lambda = in["lambda"], s = std::sqrt((1 - n_z) * (1 + n_z));
    const Vec4<double> event = {{1, .3 * metric.a, -.2 * metric.a, .1}};
    const Vec4<double> lamp = metric.path(event, Vec4<double>{{-1, .8 * s, .6 * s, n_z}}).at(lambda).event;
    int hits = 0;
    for (const auto& one : all_connections(metric, event, lamp_at_rest(metric, lamp), 4)) {
      if (std::fabs(one.lambda - lambda) > 1e-6) continue;
      ++hits;
      EXPECT_NEAR(one.det, want["detD_signed"].get<double>(), kClose) << c["id"];
      EXPECT_NEAR(one.past[3], n_z, kClose) << c["id"];
    }
    EXPECT_EQ(hits, 1) << c["id"];
  }
}

TEST(Connect, LampsOnTheAxis) {
  for (const json& c : cases_of("godel_two_point_axis")) {
    const Goedel metric{c["inputs"]["a"]};
    const json& rings = c["expected"]["rings"];
    const auto found = all_connections(metric, Vec4<double>{},
                                       lamp_at_rest(metric, Vec4<double>{{0, 0, 0, c["inputs"]["z0"]}}), 3);
    ASSERT_EQ(found.size(), 1 + rings.size());
    EXPECT_NEAR(found[0].past[3], 1, 1e-14);
    EXPECT_NEAR(-found[0].emitted[0], c["expected"]["direct"]["travel_time"].get<double>(), 1e-14);
    EXPECT_GT(found[0].det, 0);
    for (std::size_t i = 0; i < rings.size(); ++i) {
      EXPECT_NEAR(found[i + 1].past[3], rings[i]["abs_nz"].get<double>(), 1e-13);
      EXPECT_NEAR(found[i + 1].lambda, rings[i]["affine_length"].get<double>(), 1e-12);
      EXPECT_NEAR(-found[i + 1].emitted[0], rings[i]["travel_time"].get<double>(), 1e-12);
      EXPECT_EQ(found[i + 1].det, 0);
      EXPECT_LT(miss(metric, Vec4<double>{}, found[i + 1]), 1e-14);
    }
  }
  // In the lamp itself, only light that has gone round.
  const Goedel metric{2};
  const Vec4<double> here = {{1, .5, -.25, 3}};
  const auto round = all_connections(metric, here, lamp_at_rest(metric, here), 3);
  ASSERT_EQ(round.size(), 3u);
  for (std::size_t i = 0; i < 3; ++i) {
    const double turns = static_cast<double>(i + 1);
    EXPECT_NEAR(round[i].lambda, turns * 2 * std::numbers::pi * metric.a, 1e-13 * turns);
    EXPECT_EQ(round[i].det, 0);
  }
}

/// How many roots (4.1) has in a lobe, by samples of Psi between which the greatest is refined; -1 where the
/// place is too near to the fold to tell.
int count_by_force(int lobe, long double u0, long double zeta) {
  const long double pi = std::numbers::pi_v<long double>;
  const long double low = std::max(lobe * pi, zeta), high = (lobe + 1) * pi;
  if (low >= high) return 0;
  const auto F = [&](long double psi) {
    return sqrt((psi - zeta) * (psi + zeta)) * std::fabs(std::sin(psi)) / psi;
  };
  constexpr int kSamples = 24;
  const long double step = (high - low) / kSamples;
  int best = 1;
  for (int i = 1; i < kSamples; ++i)
    if (F(low + i * step) > F(low + best * step)) best = i;
  long double left = low + (best - 1) * step, right = low + (best + 1) * step;
  for (int i = 0; i < 40; ++i) {
    const long double m1 = left + (right - left) * 0.382L, m2 = left + (right - left) * 0.618L;
    (F(m1) < F(m2) ? left : right) = F(m1) < F(m2) ? m1 : m2;
  }
  const long double top = 0.5L * (left + right);
  if (std::fabs(F(top) - u0) < 1e-13L) return -1;
  int changes = 0;
  bool above = false;
  for (const auto& [from, to] : {std::pair{low, top}, std::pair{top, high}})
    for (int i = 1; i <= kSamples; ++i) {
      const long double psi = from + i * (to - from) / kSamples;
      const bool now = psi < high && F(psi) > u0;
      changes += now != above;
      above = now;
    }
  return changes;
}

TEST(Connect, RandomPairsMissNothing) {
  Random random(11);
  constexpr int kWindings = 4;
  double worst = 0, worst_det = 0;
  std::size_t found = 0, unclear = 0, wrong = 0;
  for (int n = 0; n < 100000; ++n) {
    const Goedel metric{random.logarithmic(1e-3, 1e8)};
    const Vec4<double> event = metric.a * random.event(2);
    const double height = random.uniform(0, 10) * (n % 2) + random.logarithmic(1e-9, 10) * (1 - n % 2);
    const Vec3<double> away = metric.a * random.logarithmic(1e-7, 4) * random.direction();
    const Vec4<double> lamp = {{metric.a * random.uniform(-5, 5), event[1] + away[0], event[2] + away[1],
                                event[3] + metric.a * height}};
    const auto place = metric.to_origin(convert<long double>(event), convert<long double>(lamp));
    const long double u0 = sqrt(norm2(metric.to_q(place))),
                      zeta = std::fabs(place[3]) / (std::numbers::sqrt2_v<long double> * metric.a);
    for (int lobe = 0; lobe < kWindings; ++lobe) {
      const int want = count_by_force(lobe, u0, zeta);
      int got = 0;
      for (int branch : {2 * lobe, 2 * lobe + 1}) {
        const auto one = connect(metric, event, lamp_at_rest(metric, lamp), branch);
        if (!one.found) continue;
        ++got;
        worst = std::fmax(worst, miss(metric, event, one));
        const double det = area(metric, one.lambda, one.past[3]);
        worst_det = std::fmax(worst_det, std::fabs(one.det - det) / (one.lambda * one.lambda));
        EXPECT_EQ(one.det < 0, branch % 2 == 1);
      }
      found += static_cast<std::size_t>(got);
      if (want < 0)
        ++unclear;
      else if (want != got && ++wrong < 10)
        ADD_FAILURE() << "lobe " << lobe << " of u0 " << double(u0) << " zeta " << double(zeta) << ": " << got
                      << " instead of " << want;
    }
  }
  EXPECT_EQ(wrong, 0u);
  EXPECT_LT(worst, 1e-9);
  EXPECT_LT(worst_det, 1e-9);
  EXPECT_GT(found, 100000u);
  EXPECT_LT(unclear, 10u);
}

/// The flat limit keeps all digits: lamps a few units away, a up to 1e15.
TEST(Connect, FlatLimit) {
  Random random(12);
  for (int n = 0; n < 2000; ++n) {
    const Goedel metric{random.logarithmic(1e10, 1e15)};
    const Vec4<double> event = random.event(5), lamp = random.event(5);
    const auto got = connect(metric, event, lamp_at_rest(metric, lamp), 0);
    const auto want = connect(Minkowski{}, event, lamp_at_rest(Minkowski{}, lamp), 0);
    ASSERT_TRUE(got.found);
    const double tolerance = 1e-14 + 200 / metric.a;  // the Coriolis force is of first order in 1/a
    EXPECT_NEAR(got.lambda, want.lambda, tolerance * want.lambda);
    EXPECT_NEAR(got.emitted[0], want.emitted[0], 20 * tolerance);
    EXPECT_NEAR(got.tau, want.tau, 20 * tolerance);
    EXPECT_NEAR(got.det, want.det, tolerance * want.det);
    for (std::size_t i = 1; i < 4; ++i) EXPECT_NEAR(got.past[i], want.past[i], 2 * tolerance);
  }
}

}  // namespace
}  // namespace nullcone::test
