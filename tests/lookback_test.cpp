// Limits of lookback in coordinate time: rays end where they first are so far in the past, also where time
// runs backwards along them.
#include <gtest/gtest.h>

#include <cmath>
#include <nlohmann/json.hpp>
#include <random>

#include "core/base/error.h"
#include "core/record/dataset.h"
#include "core/trace/time_limit.h"
#include "metrics/goedel.h"
#include "metrics/minkowski.h"
#include "tests/traced.h"

namespace nullcone::test {
namespace {

using namespace host;
using nlohmann::json;

/// A past-directed null tangent of some frequency, in the static tetrad.
Vec4<double> tangent(std::mt19937_64& random) {
  std::normal_distribution<double> normal;
  const Vec3<double> n = normalised(Vec3<double>{{normal(random), normal(random), normal(random)}});
  const double k = std::exp(0.5 * normal(random));
  return {{-k, k * n[0], k * n[1], k * n[2]}};
}

TEST(Lookback, TimeBendsNoMoreThanTheMetricSays) {
  std::mt19937_64 random(2);
  std::uniform_real_distribution<double> place(-20, 20), part(0, 1);
  for (const double a : {1.0, 3.0}) {
    const Goedel goedel{a};
    double most = 0;
    for (int i = 0; i < 200000; ++i) {
      const auto k = tangent(random);
      const auto path = goedel.path(Vec4<double>{{0, place(random), place(random), 0}}, k);
      const double at = 12 * a * part(random) / -k[0], h = 1e-4 * a / -k[0];
      const double bend = (path.at(at + h).tangent[0] - path.at(at - h).tangent[0]) / (2 * h * k[0] * k[0]);
      most = std::max(most, std::fabs(bend));
    }
    EXPECT_LT(most, (1 + 1e-7) * goedel.bend_of_time());
    EXPECT_GT(most, 0.6 * goedel.bend_of_time());  // 2.35 of 3.41 can be
  }
}

TEST(Lookback, EndsWhereTimeIsFirstSoEarly) {
  std::mt19937_64 random(3);
  std::uniform_real_distribution<double> place(-12, 12), time(0.01, 14);
  const Goedel goedel{1};
  int turned = 0;
  for (int i = 0; i < 3000; ++i) {
    const auto k = tangent(random);
    const double back = time(random), limit = 20 / -k[0];
    const auto path = goedel.path(Vec4<double>{{0.5, place(random), place(random), 0}}, k);
    bool lost = true;
    const double end = first_time_back(path, back, goedel.bend_of_time() * k[0] * k[0], limit, lost);
    ASSERT_FALSE(lost);
    const auto above = [&](double lambda) { return path.at(lambda).event[0] - 0.5 + back; };
    if (end < limit) {
      ASSERT_NEAR(above(end), 0, 2e-13) << i;
    }
    // Before it time is nowhere so early; behind it, it may come back.
    for (int n = 0; n < 500; ++n) ASSERT_GT(above(end * (n + 0.5) / 500), -1e-13) << i;
    if (end < limit) {
      bool back_again = false;
      for (int n = 1; n < 200; ++n) back_again |= above(end + n * 0.02 / -k[0]) > 1e-3;
      turned += back_again;
    }
  }
  EXPECT_GT(turned, 100);

  const auto k = tangent(random);
  bool lost = true;
  EXPECT_NEAR(first_time_back(Minkowski{}.path(Vec4<double>{{3, 1, 2, 0}}, k), 7, 0.0, 1e300, lost),
              7 / -k[0], 1e-14 * 7 / -k[0]);
  EXPECT_FALSE(lost);
}

json scene_of(const std::string& metric, const json& lookback, bool integrated) {
  json out = json::parse(R"({"observer": {"event": [5, 0, 0, 0], "velocity": [0.2, 0.1, 0]},
    "camera": {"type": "sphere", "resolution": [96, 48]}, "records": {"max_hits": 50}, "objects": [
    {"name": "far", "shape": {"type": "sphere", "radius": 2.5}, "placing": {"type": "coordinate", "centre": [0.5, 4, 0]}},
    {"name": "near", "shape": {"type": "sphere", "radius": 1}, "placing": {"type": "coordinate", "centre": [-2, 0, 1]}}]})");
  out["metric"]["name"] = metric;
  out["max_lookback"] = lookback;
  if (integrated) out["paths"] = "integrated";
  if (metric == "goedel") out["observer"]["event"] = {5, 0, 0, 0.3};
  if (metric == "goedel" && !integrated) {  // far from the axis, where time runs to and fro along rays
    const auto placing = [](double x, double y, double z) {
      return json{{"type", "local"}, {"worldline", {{"type", "static"}, {"event", {0, x, y, z}}}}};
    };
    out["observer"]["event"] = {5, 8, 0, 0.3};
    out["objects"][0]["placing"] = placing(11, -0.1, 0.2), out["objects"][0]["shape"]["radius"] = 0.3;
    out["objects"][1]["placing"] = placing(7, 0.15, 0), out["objects"][1]["shape"]["radius"] = 0.25;
  }
  if (metric == "kerr_schild")
    out["observer"]["event"] = {5, 12, 0, 1}, out["observer"]["velocity"] = {0, 0, 0},
    out["objects"][0]["placing"]["centre"] = {-4, 5, 0}, out["objects"][1]["placing"]["centre"] = {4, -3, 1};
  if (metric != "goedel") out["objects"].push_back({{"name", "heaven"}, {"shape", {{"type", "sky"}}}});
  return out;
}

struct Met {
  std::size_t x, y;
  std::uint32_t id;
  double Z, t;
};
std::vector<Met> crossings(const Traced& traced) {
  std::vector<Met> out;
  traced.for_each_hit([&](const HitRecord& hit, std::size_t x, std::size_t y) {
    out.push_back({x, y, hit.id, hit.Z, hit.t});
  });
  return out;
}

/// Traced with the limit, there is what lies before it without the limit, and nothing else.
TEST(Lookback, CutsRaysAndNothingElse) {
  const struct {
    const char* metric;
    bool integrated;
    double back;
  } cases[] = {{"minkowski", false, 4}, {"minkowski", true, 4},   {"goedel", false, 3},
               {"goedel", false, 1},    {"goedel", false, 1.5},   {"goedel", false, 2},
               {"goedel", true, 2},     {"kerr_schild", true, 18}};
  std::size_t again = 0;  // crossings that come too late, though not their time
  for (const auto& [metric, integrated, back] : cases) {
    const json whole = metric == std::string("goedel") ? json(60) : json(1e4);
    const Traced all = trace_text(scene_of(metric, whole, integrated).dump()),
                 cut = trace_text(scene_of(metric, {{"t", back}}, integrated).dump());
    std::vector<Met> expected;
    for (const Met& c : crossings(all)) {
      bool before = c.t >= -back;
      if (before && metric == std::string("goedel") && !integrated) {  // also on the way there
        const auto k =
            -seen_photon(four_velocity(Vec3<double>{all.scene.observer.velocity}), all.look(c.x, c.y));
        const Goedel goedel{1};  // its paths point to it
        const auto path = goedel.path(Vec4<double>{all.scene.observer.event}, k);
        for (int n = 0; n < 400; ++n)
          before &= path.at(c.Z * n / 400).event[0] >= all.scene.observer.event[0] - back;
        again += !before;
      }
      if (before) expected.push_back(c);
    }
    const std::vector<Met> found = crossings(cut);
    ASSERT_EQ(found.size(), expected.size()) << metric << " " << integrated << " " << back << ": " << again;
    EXPECT_LT(found.size(), crossings(all).size()) << metric << " " << back;
    EXPECT_GT(found.size(), 20U) << metric << " " << back;
    for (std::size_t i = 0; i < found.size(); ++i) {
      ASSERT_EQ(found[i].id, expected[i].id);
      // The last steps of integrated rays may be cut otherwise.
      ASSERT_NEAR(found[i].Z, expected[i].Z, integrated ? 1e-6 : 0);
    }
    EXPECT_EQ(cut.rays_with(Status::sky), 0U);
    EXPECT_EQ(cut.rays_with(Status::step_limit), 0U);
    EXPECT_GT(cut.rays_with(Status::lookback_reached), 100U);
  }
  EXPECT_GT(again, 5U);
}

TEST(Lookback, IsReadInBothForms) {
  const auto metrics = metric_descriptions();
  const auto read = [&](const json& lookback) {
    return read_scene(scene_of("goedel", lookback, false).dump(), "file", metrics);
  };
  EXPECT_EQ(read(7).max_lookback, 7);
  EXPECT_EQ(read({{"lambda", 7}}).max_lookback, 7);
  EXPECT_EQ(read({{"lambda", 7}}).max_lookback_t, INFINITY);
  EXPECT_EQ(read({{"t", 7}}).max_lookback, INFINITY);
  EXPECT_EQ(read({{"t", 7}}).max_lookback_t, 7);
  EXPECT_EQ(format_of(read({{"lambda", 7}})), 2);
  EXPECT_EQ(format_of(read({{"t", 7}, {"lambda", 3}})), 4);
  for (const auto& [lookback, place] :
       {std::pair<json, const char*>{json::object(), "/max_lookback: expected a number, or lambda"},
        {{{"t", 0}}, "/max_lookback/t: "},
        {{{"t", -1}}, "/max_lookback/t: "},
        {{{"t", "1"}}, "/max_lookback/t: expected a number"},
        {{{"lambda", 1e16}}, "/max_lookback/lambda: "},
        {{{"t", 1}, {"tau", 1}}, "/max_lookback/tau: unknown key"}}) {
    try {
      read(lookback);
      FAIL() << lookback;
    } catch (const InputError& error) {
      EXPECT_EQ(std::string(error.what()).find(std::string("file: ") + place), 0U) << error.what();
    }
  }
}

}  // namespace
}  // namespace nullcone::test
