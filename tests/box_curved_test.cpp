// Boxes where light is bent: against the six quads that are their faces, and closed paths against integrated
// ones.
#include "metrics/goedel_kernel.h"
#include "tests/box_oracle.h"
#include "tests/by_ray.h"
#include "tests/random_rays.h"

namespace nullcone::test {
namespace {

using namespace host;

/// A box, and the six quads that are its faces, both transparent and fixed in the chart.
std::string box_and_faces(const Vec3<double>& centre, const Vec3<double>& edges,
                          const Matrix3<double>& axes) {
  const auto object = [&](const std::string& name, const std::string& shape, const Vec3<double>& at,
                          const Vec3<double>& z, const Vec3<double>& y) {
    return R"({"name": ")" + name + R"(", "transparent": true, "shape": )" + shape +
           R"(, "placing": {"type": "coordinate", "centre": )" + text_of(at) + R"(, "z_axis": )" +
           text_of(z) + R"(, "y_axis": )" + text_of(y) + "}}";
  };
  std::string out = object("box", box(edges), centre, axes[2], axes[1]);
  for (std::size_t i = 0; i < 3; ++i)
    for (const double side : {1.0, -1.0}) {
      const std::size_t j = (i + 1) % 3, k = (i + 2) % 3;  // x, y, z of the quad are j, k, i of the box
      out += ", " +
             object((side > 0 ? "p" : "m") + std::to_string(i),
                    R"({"type": "quad", "edges": [)" + text_of(edges[j]) + ", " + text_of(edges[k]) + "]}",
                    centre + 0.5 * side * edges[i] * axes[i], axes[i], axes[k]);
    }
  return out;
}

struct FacesMet {
  std::size_t met = 0;     ///< crossings of the box
  std::size_t beyond = 0;  ///< rays that come back to it
  std::size_t off = 0;     ///< rays that meet another number of quads
};

/// The first object, a box, against all others.
FacesMet compare_faces(const std::string& scene) {
  FacesMet out;
  for (const RayOfPicture& ray : by_ray(trace_text(scene))) {
    std::vector<HitRecord> of_box, of_quads;
    for (const HitRecord& hit : ray.hits) (hit.id == 1 ? of_box : of_quads).push_back(hit);
    EXPECT_EQ(of_box.size() % 2, 0U);
    out.met += of_box.size();
    out.beyond += of_box.size() > 2;
    if (of_box.size() != of_quads.size()) {
      ++out.off;
      continue;
    }
    for (std::size_t i = 0; i < of_box.size(); ++i) {
      const HitRecord &a = of_box[i], &b = of_quads[i];
      const double rounding = 1e-9 / (std::min(a.mu, b.mu) + 1e-3);
      EXPECT_NEAR(a.Z, b.Z, rounding * (1 + a.Z)) << scene;
      EXPECT_NEAR(a.shift, b.shift, rounding);
      EXPECT_NEAR(a.mu, b.mu, rounding);
    }
  }
  return out;
}

TEST(BoxInCurvedSpace, IsMetWhereItsSixFacesAre) {
  struct Case {
    std::string metric, more;
    Vec3<double> centre, edges;
  };
  const std::string hole =
      R"("observer": {"event": [0, 14, 0, 2]}, "camera": {"type": "perspective", "azimuth_deg": 180,
    "elevation_deg": -8, "fov_deg": 70, )";
  const std::string inside = R"("observer": {"event": [0.5, 0.1, -0.2, 0.1]}, "max_lookback": 9,
    "camera": {"type": "sphere", )";
  const std::string kerr = R"({"metric": {"name": "kerr_schild", "spin": 0.8}, )",
                    wormhole = R"({"metric": {"name": "ellis_wormhole", "throat": 2}, )",
                    goedel = R"({"metric": {"name": "goedel"}, )",
                    flat = R"({"metric": {"name": "minkowski"}, )";
  const std::string integrated = R"("paths": "integrated", )";
  std::size_t beyond = 0;
  for (const Case& c :
       {Case{kerr, hole, {{-5, 3, 1}}, {{3, 2, 4}}}, Case{kerr, hole, {{4, -3, 1}}, {{1, 4, 0.01}}},
        Case{wormhole, hole, {{5, 2, 1}}, {{2, 1, 3}}},
        Case{wormhole, hole, {{0.5, 0.3, 0.2}}, {{0.4, 0.5, 0.4}}},
        Case{goedel, inside, {{-0.5, 0.6, 0.1}}, {{0.5, 0.3, 0.8}}},
        Case{goedel, inside, {{0.6, 0.5, 0.3}}, {{0.5, 0.6, 1e-4}}},
        Case{goedel, integrated + inside, {{-0.5, 0.6, 0.1}}, {{0.5, 0.3, 0.8}}},
        Case{flat, hole, {{5, 2, 1}}, {{2, 1, 3}}}}) {
    Random random(31);
    const Vec3<double> z = random.direction(), x = normalised(cross(random.direction(), z));
    const std::string pixels = kSanitized ? R"("resolution": [36, 18]})" : R"("resolution": [180, 90]})";
    const std::string scene = c.metric + c.more + pixels + R"(, "objects": [)" +
                              box_and_faces(c.centre, c.edges, {x, cross(z, x), z}) + "]}";
    const FacesMet found = compare_faces(scene);
    beyond += found.beyond;
    EXPECT_LE(found.off, 1U) << scene;  // a ray through an edge may meet a quad more, or less
    EXPECT_GT(found.met, kSanitized ? 2U : 100U) << scene;
  }
  EXPECT_TRUE(kSanitized || beyond > 10) << "some rays should come back";
}

TEST(BoxInCurvedSpace, LooksTheSameWithIntegratedRays) {
  const std::string placing = R"(, "placing": {"type": "local", "worldline": {"type": "static", "event": )";
  const std::string scene = scene_of(
      "goedel", R"("type": "sphere", "resolution": )" + std::string(kSanitized ? "[48, 24]" : "[240, 120]"),
      R"({"name": "a", "shape": )" + box({{0.5, 0.6, 0.4}}) + kTransparent + placing +
          R"([0, 0.9, 0.1, 0]}, "z_axis": [0.3, 0.2, 1]}}, {"name": "b", "shape": )" +
          box({{0.4, 0.01, 0.9}}) + placing + R"([0, -0.5, -0.6, -0.1]}, "z_axis": [1, 0.5, 0.2]}})",
      R"("observer": {"event": [0.5, 0.1, -0.2, 0.1]}, "max_lookback": 9)");
  const auto closed = by_ray(trace_text(scene)),
             marched =
                 by_ray(trace_text(R"({"paths": "integrated", "accuracy": "reference", )" + scene.substr(1)));
  std::size_t other = 0, met = 0;
  for (std::size_t i = 0; i < closed.size(); ++i) {
    if (ids(closed[i]) != ids(marched[i])) {
      ++other;
      continue;
    }
    for (std::size_t n = 0; n < closed[i].hits.size(); ++n, ++met) {
      const HitRecord &a = closed[i].hits[n], &b = marched[i].hits[n];
      if (std::min(a.mu, b.mu) < 0.05) continue;
      if (std::fabs(a.u - b.u) + std::fabs(a.v - b.v) > 0.01) {
        ++other;  // an edge: another face
        continue;
      }
      for (const double error :
           {a.u - b.u, a.v - b.v, a.shift / b.shift - 1, a.mu - b.mu, a.t - b.t, a.tau - b.tau})
        ASSERT_NEAR(error, 0, 1e-7);
    }
  }
  EXPECT_LE(other, 1 + closed.size() / 2000);
  EXPECT_GT(met, kSanitized ? 30U : 1000U);
}

TEST(BoxInCurvedSpace, FallingBoxesInGoedel) {
  // Where the ray is inside of the box, point by point, against the crossings before that point.
  Random random(41);
  std::size_t inside = 0, wrong = 0, checked = 0, lost = 0;
  for (int object = 0; object < (kSanitized ? 4 : 60); ++object) {
    const Goedel metric{random.uniform(1, 5)};
    const Vec3<double> edges = random_edges(random, random.uniform(0.05, 0.2));
    const Box shape{0.5 * edges[0], 0.5 * edges[1], 0.5 * edges[2]};
    const Vec3<double> z = random.direction(), x = normalised(cross(random.direction(), z));
    LocalFrame<Goedel> frame{
        metric, random.event(metric.a), four_velocity(random.uniform(0, 0.6) * random.direction()), true,
        {},     {x, cross(z, x), z}};
    frame.prepare();
    const GoedelOrbit orbit = make_orbit(frame, shape.bounding_radius());
    ASSERT_TRUE(orbit.fits());
    const MovingPlacing<Goedel> placing{frame, orbit, false};
    for (int n = 0; n < 40; ++n) {
      const auto X = Vec3<double>::map([&](std::size_t i) { return edges[i] * random.uniform(-0.7, 0.7); });
      const double back = random.uniform(1, 8 * metric.a), size = norm(edges);
      const auto P = metric.path(frame.event(random.uniform(-3, 3), X), moving(random.direction())).at(back);
      const auto ray = placing.ray(placing.launch(P.event), -P.local);
      bool given_up = false;
      const auto found = all_crossings(ray, shape, back + 3 * size, 4e-15 * norm(spatial(P.event)), given_up);
      lost += given_up;
      for (int i = 0; i < 400; ++i) {
        const double lambda = back + 0.01 * (i - 200) * size;
        if (lambda <= 0) continue;
        const Vec4<double> x_i = ray.path.at(lambda).event;
        const double tau = proper_time(frame, x_i, orbit.proper_time(x_i));
        const Vec3<double> at = frame.to_object(tau, spatial(frame.rest(x_i, tau)));
        double f = -1;
        for (std::size_t k = 0; k < 3; ++k) f = std::max(f, std::fabs(at[k]) - 0.5 * edges[k]);
        if (!(std::fabs(f) > 1e-10)) continue;
        const auto before = std::ranges::count_if(found, [&](double crossing) { return crossing < lambda; });
        ++checked, inside += f < 0;
        wrong += (before % 2 == 1) != (f < 0);
      }
    }
  }
  EXPECT_EQ(wrong, 0U);
  EXPECT_EQ(lost, 0U);
  EXPECT_GT(checked, kSanitized ? 50'000U : 800'000U);
  EXPECT_GT(inside, checked / (kSanitized ? 100 : 50));
}

}  // namespace
}  // namespace nullcone::test
