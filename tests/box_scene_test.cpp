// Scenes with boxes in flat space: everything that a crossing tells against the slab method, and what a fast
// one looks like.
#include <gtest/gtest.h>

#include <map>
#include <numbers>

#include "core/base/error.h"
#include "tests/box_oracle.h"
#include "tests/by_ray.h"
#include "tests/random_rays.h"

namespace nullcone::test {
namespace {

using namespace host;

const std::string kFull =
    R"(, "records": {"channels": ["order", "uv", "shift", "t", "tau", "mu", "N", "K"]})";

std::string moving_box(const std::string& name, Random& random, const std::string& more) {
  const auto place = random.logarithmic(1.5, 30) * random.direction();
  return R"({"name": ")" + name + R"(", "shape": )" + box(random_edges(random, random.logarithmic(0.3, 3))) +
         more +
         R"(, "placing": {"type": "local", "axes": "static", "worldline": {"type": "geodesic", "event": [0, )" +
         text_of(place).substr(1) + R"(, "velocity": )" +
         text_of(random.uniform(0, 0.95) * random.direction()) + R"(}, "z_axis": )" +
         text_of(random.direction()) + R"(, "y_axis": )" + text_of(random.direction()) + "}}";
}

/// Where the atlas has a point of a face, face by face.
Vec<double, 2> atlas(std::size_t axis, double side, const Vec3<double>& X, const Vec3<double>& edges) {
  const double x = X[0] / edges[0], y = X[1] / edges[1], z = X[2] / edges[2], row = side > 0 ? 0.75 : 0.25;
  if (axis == 0) return {{(0.5 + side * y) / 3, row + 0.5 * z}};
  if (axis == 1) return {{(1.5 - side * x) / 3, row + 0.5 * z}};
  return {{(2.5 + side * x) / 3, row + 0.5 * y}};
}

/// A ray of the picture as a box sees it.
struct SeenByBox {
  BoxOracle oracle;
  double frequency;  ///< that the box's surface emits, over that observed
};
SeenByBox seen_by(const Scene& scene, const Object& object, const Vec3<double>& look) {
  using L = long double;
  const Vec4<double> u = four_velocity(Vec3<double>{scene.observer.velocity}),
                     from = Vec4<double>{scene.observer.event},
                     start = Vec4<double>{object.placing.worldline.event};
  const Vec4<L> v = convert<L>(four_velocity(Vec3<double>{object.placing.worldline.velocity}));
  const Vec4<L> past = boost(v, -convert<L>(seen_photon(u, look))), X = boost(v, convert<L>(from - start));
  const Matrix3<L> rows = {convert<L>(object.placing.axes[0]), convert<L>(object.placing.axes[1]),
                           convert<L>(object.placing.axes[2])};
  return {BoxOracle(rows * spatial(X), rows * spatial(past), Vec3<double>{object.shape.edges}),
          static_cast<double>(-past[0])};
}

/// One crossing against the oracle.
void expect_crossing(const HitRecord& hit, const HitDetail& detail, const SeenByBox& seen, bool enters,
                     const Vec3<double>& edges, double rounding) {
  const BoxOracle& o = seen.oracle;
  const std::size_t axis = enters ? o.axis_in : o.axis_out;
  const BoxOracle::L lambda = enters ? o.enter : o.leave;
  const double steep = static_cast<double>(std::fabs(o.k[axis])), mu = steep / seen.frequency;
  ASSERT_NEAR(hit.Z * steep, static_cast<double>(lambda) * steep, rounding);
  ASSERT_NEAR(hit.shift, 1 / seen.frequency, 1e-12 / seen.frequency);
  if (static_cast<double>(enters ? o.margin_in : o.margin_out) * steep < 10 * rounding) return;  // an edge
  ASSERT_NEAR(hit.mu, mu, rounding);
  const auto X =
      Vec3<double>::map([&](std::size_t i) { return static_cast<double>(o.X[i] + lambda * o.k[i]); });
  const double side = X[axis] < 0 ? -1 : 1;
  const auto uv = atlas(axis, side, X, edges);
  const double least = std::min({edges[0], edges[1], edges[2]});
  if (rounding < 1e-7 * least && mu > 1e-3) {
    ASSERT_NEAR(hit.u, uv[0], 1e-6 + rounding / (mu * least));
    ASSERT_NEAR(hit.v, uv[1], 1e-6 + rounding / (mu * least));
  }
  const auto column = static_cast<double>(axis), row = side > 0 ? 0.5 : 0.0;
  ASSERT_GT(static_cast<float>(hit.u), static_cast<float>(column / 3));
  ASSERT_LT(static_cast<float>(hit.u), static_cast<float>((column + 1) / 3));
  ASSERT_GT(static_cast<float>(hit.v), static_cast<float>(row));
  ASSERT_LT(static_cast<float>(hit.v), static_cast<float>(row + 0.5));
  for (std::size_t i = 0; i < 3; ++i) {
    ASSERT_EQ(detail.N[i], i == axis ? (enters ? side : -side) : 0) << i;
    ASSERT_NEAR(detail.K[i], static_cast<double>(-o.k[i]) / seen.frequency, 1e-10);
  }
}

struct BoxCounts {
  std::size_t rays = 0, crossings = 0, missed = 0, invented = 0, other = 0;
};

/// Every crossing of every ray with transparent boxes, or the first of each ray with opaque ones.
void compare(const Traced& traced, bool opaque, BoxCounts& counts) {
  for (const RayOfPicture& ray : by_ray(traced)) {
    ++counts.rays;
    expect_sorted(ray);
    ASSERT_EQ(ray.status,
              opaque && ray.hits.back().id < traced.scene.objects.size() ? Status::hit : Status::sky);
    const Vec3<double> look = traced.look(ray.x, ray.y);
    double nearest = std::numeric_limits<double>::infinity();  // of what an opaque scene must show
    for (std::uint32_t id = 1; id < traced.scene.objects.size(); ++id) {
      const Object& object = traced.scene.objects[id - 1];
      const SeenByBox seen = seen_by(traced.scene, object, look);
      const double rounding = 3e-13 * seen.frequency *
                              (1 + norm(seen_by(traced.scene, object, look).oracle.half)) *
                              (1 + static_cast<double>(norm(seen.oracle.X)));
      const bool sure = seen.oracle.meets() && seen.oracle.depth() > rounding;
      if (sure) nearest = std::min(nearest, static_cast<double>(seen.oracle.enter));
      std::vector<std::size_t> found;
      for (std::size_t i = 0; i < ray.hits.size(); ++i)
        if (ray.hits[i].id == id) found.push_back(i);
      counts.crossings += found.size();
      if (!opaque) {
        counts.missed += sure && found.size() != 2;
        counts.other += found.size() % 2;
      }
      for (std::size_t n = 0; n < found.size(); ++n) {
        const HitRecord& hit = ray.hits[found[n]];
        counts.invented += seen.oracle.outside_by(hit.Z) > rounding;
        if (sure)
          expect_crossing(hit, ray.details[found[n]], seen, n == 0, Vec3<double>{object.shape.edges},
                          rounding);
      }
    }
    if (opaque && nearest < 1e300) counts.missed += !(ray.hits[0].Z <= nearest * (1 + 1e-9));
  }
}

TEST(BoxScene, EveryCrossingTellsWhatTheSlabsTell) {
  Random random(21);
  BoxCounts counts;
  for (int trial = 0; trial < (kSanitized ? 1 : 3); ++trial)
    for (const bool opaque : {false, true}) {
      std::string objects;
      for (int i = 0; i < 12; ++i)
        objects += moving_box("b" + std::to_string(i), random, opaque ? "" : kTransparent) + ", ";
      const std::string camera =
          R"("type": "sphere", "resolution": )" + std::string(kSanitized ? "[60, 30]" : "[240, 120]");
      const std::string more = R"("observer": {"event": [0.5, 0, 0, 0], "velocity": )" +
                               text_of(random.uniform(0, 0.9) * random.direction()) + "}" + kFull;
      std::string scene = scene_of("minkowski", camera, objects + kSky, more);
      try {
        compare(trace_text(scene), opaque, counts);
        if (trial == 0) compare(trace_text(R"({"paths": "integrated", )" + scene.substr(1)), opaque, counts);
      } catch (const InputError&) {
        --trial;  // the observer stands in one of them
        break;
      }
      if (HasFatalFailure()) FAIL() << scene;
    }
  EXPECT_EQ(counts.missed, 0U);
  EXPECT_EQ(counts.invented, 0U);
  EXPECT_EQ(counts.other, 0U);
  EXPECT_GT(counts.rays, kSanitized ? 3000U : 200'000U);
  EXPECT_GT(counts.crossings, counts.rays / (kSanitized ? 10 : 5));
}

TEST(BoxScene, AFastBoxFarAwaySeemsTurned) {
  // Terrell 1959: a cube of edge 1 that flies by at right angles to the look direction is seen contracted to
  // 1/gamma, and of its rear face a width beta. Light from the middle of the near face left it at t = -D.
  const double D = 1e4, beta = 0.8, pixel = 0.01 / D;
  constexpr std::size_t kPixels = 301;
  const std::string size = std::to_string(kPixels);
  const Traced traced = trace_text(
      scene_of("minkowski",
               R"("type": "perspective", "fov_deg": )" +
                   text_of(2 * std::atan(0.5 * kPixels * pixel) * 180 / std::numbers::pi) +
                   R"(, "resolution": [)" + size + ", " + size + "]",
               R"({"name": "cube", "shape": )" + box({{1, 1, 1}}) +
                   R"(, "placing": {"type": "local", "worldline": {"type": "geodesic", "event": [)" +
                   text_of(-D) + ", " + text_of(D + 0.5) + R"(, 0, 0], "velocity": [0, 0.8, 0]}}}, )" + kSky,
               kAtOrigin));
  std::map<std::pair<int, int>, std::size_t> faces;  // by column and row of the atlas, on the middle line
  std::size_t across = 0;
  traced.for_each_hit([&](const HitRecord& hit, std::size_t x, std::size_t y) {
    if (hit.id != 1) return;
    if (y == kPixels / 2) ++faces[{static_cast<int>(3 * hit.u), static_cast<int>(2 * hit.v)}];
    across += x == kPixels / 2;
    // Across the line of sight: only time dilation (by 1/D, as far as the box is wide).
    ASSERT_NEAR(hit.shift, std::sqrt(1 - beta * beta), 3 / D);
  });
  ASSERT_EQ(faces.size(), 2U);
  const auto width = [&](int column, int row) { return 0.01 * static_cast<double>(faces[{column, row}]); };
  EXPECT_NEAR(width(0, 0), std::sqrt(1 - beta * beta), 0.015) << "the face -x, which looks at us";
  EXPECT_NEAR(width(1, 0), beta, 0.015) << "the face -y, which goes behind";
  EXPECT_NEAR(0.01 * static_cast<double>(across), 1, 0.015);
}

TEST(BoxScene, AnObserverInsideIsRefused) {
  const auto complaint = [](const Vec3<double>& centre) -> std::string {
    try {
      trace_text(scene_of("minkowski", R"("type": "sphere", "resolution": [8, 4])",
                          local_object("b", box({{2, 4, 6}}), centre), kAtOrigin));
    } catch (const InputError& error) {
      return error.what();
    }
    return "";
  };
  for (const Vec3<double> inner :
       {Vec3<double>{}, Vec3<double>{{0.99, -1.99, 2.99}}, Vec3<double>{{1, 0, 0}}})
    EXPECT_NE(complaint(inner).find("holds the observer; what is seen from inside needs"), std::string::npos);
  EXPECT_EQ(complaint({{1.01, 0, 0}}) + complaint({{0, 2.01, 0}}) + complaint({{0, 0, -3.01}}), "");
}

}  // namespace
}  // namespace nullcone::test
