#include "apps/geodesic_outline.h"

#include <algorithm>
#include <cmath>
#include <numbers>

#include "core/base/boost.h"
#include "core/base/error.h"
#include "core/trace/follow.h"

namespace nullcone {

namespace {

using Vector = host::Vec3<double>;
using host::dot, host::norm;

constexpr std::array<const char*, 6> kColors = {"#1f6fb4", "#d9822b", "#3a9a5b",
                                                "#a23e8c", "#8a6d1d", "#5c6773"};

/// How an object's frame lies in the chart's x-y plane: rows of x and of y, for components in its rest frame.
struct Projection {
  PlanePoint centre;
  std::array<Vector, 2> rows;

  PlanePoint operator()(const Vector& X) const {
    return {centre[0] + dot(rows[0], X), centre[1] + dot(rows[1], X)};
  }
};

/// Where a worldline is at a chart time: Newton's method from the proper time of the record, or from 0.
GeodesicPoint worldline_at(const Inquiry& inquiry, const Object& object, double time, double tau) {
  const Worldline& worldline = object.placing.worldline;
  Ray line{inquiry.spacetime, inquiry.parameters, worldline.event,
           host::four_velocity(Vector{worldline.velocity}).c, inquiry.members[0].ray.accuracy};
  if (inquiry.spacetime->description().closed_paths) line.accuracy.reset();
  const auto at = [&](double proper_time) {
    if (!object.motion) return line.at(proper_time);
    const Followed now = follow(*inquiry.spacetime, inquiry.parameters, *object.motion,
                                ObserverFrame::at_rest, proper_time, object.name);
    return GeodesicPoint{proper_time, now.event, now.axes[0]};
  };
  GeodesicPoint here = at(tau);
  for (int i = 0; i < 50 && std::fabs(here.event[0] - time) > 1e-9 && here.tangent[0] != 0; ++i) {
    const double next = tau + (time - here.event[0]) / here.tangent[0];
    try {
      here = at(next);
    } catch (const InputError&) {
      break;  // there is no way so far
    }
    tau = next;
  }
  return here;
}

Projection projection(const Inquiry& inquiry, const Object& object, double time, double tau) {
  const Worldline& worldline = object.placing.worldline;
  if (object.placing.type == PlacingType::coordinate)
    return {{worldline.event[1], worldline.event[2]}, {Vector{{1, 0, 0}}, Vector{{0, 1, 0}}}};
  GeodesicPoint here{0, worldline.event, {}};
  host::Vec4<double> u = {{1, 0, 0, 0}};  // in the static tetrad
  const bool moves = object.motion || !worldline.is_static();
  if (moves) {
    here = worldline_at(inquiry, object, time, tau);
    u.c = in_static_tetrad(*inquiry.spacetime, inquiry.parameters, here.event, here.tangent);
  }
  const auto axes = inquiry.spacetime->static_tetrad(inquiry.parameters, here.event);
  Projection out{{here.event[1], here.event[2]}, {}};
  for (std::size_t i = 0; i < 3; ++i) {
    // A unit step along axis i of the rest frame, then along the worldline back to the same chart time.
    host::Vec4<double> local{}, step{};
    local[i + 1] = 1;
    local = host::boost(host::opposite(u), local);
    for (std::size_t a = 0; a < 4; ++a) step = step + local[a] * host::Vec4<double>{axes[a]};
    const double late = moves && here.tangent[0] != 0 ? step[0] / here.tangent[0] : 0;
    for (std::size_t row = 0; row < 2; ++row) out.rows[row][i] = step[row + 1] - late * here.tangent[row + 1];
  }
  return out;
}

/// Of a sphere: where its surface turns away from the viewer, R A A^T n/|A^T n| for every direction n.
std::vector<PlanePoint> sphere_outline(const Projection& A, double radius) {
  std::vector<PlanePoint> out;
  for (int i = 0; i < 120; ++i) {
    const double angle = 2 * std::numbers::pi * i / 120;
    const Vector normal = std::cos(angle) * A.rows[0] + std::sin(angle) * A.rows[1];
    out.push_back(A((radius / norm(normal)) * normal));
  }
  return out;
}

/// Of a box or a quad: its edges, as they are seen from above, once round in the order of their directions.
std::vector<PlanePoint> box_outline(const Projection& A, const Object& object) {
  std::vector<PlanePoint> edges, out;
  PlanePoint corner = A.centre;
  for (std::size_t i = 0; i < 3; ++i) {
    const Vector X = object.shape.edges[i] * Vector{object.placing.axes[i]};
    PlanePoint edge = {dot(A.rows[0], X), dot(A.rows[1], X)};
    if (edge[1] < 0) edge = {-edge[0], -edge[1]};
    if (edge[0] != 0 || edge[1] != 0) edges.push_back(edge);
    for (std::size_t k = 0; k < 2; ++k) corner[k] -= 0.5 * edge[k];
  }
  std::ranges::sort(edges, {}, [](const PlanePoint& edge) { return std::atan2(edge[1], edge[0]); });
  for (const double way : {1.0, -1.0})
    for (const PlanePoint& edge : edges) {
      out.push_back(corner);
      for (std::size_t k = 0; k < 2; ++k) corner[k] += way * edge[k];
    }
  return out;
}

std::vector<PlanePoint> circle(double radius) {
  std::vector<PlanePoint> out;
  for (int i = 0; i < 180; ++i) {
    const double angle = 2 * std::numbers::pi * i / 180;
    out.push_back({radius * std::cos(angle), radius * std::sin(angle)});
  }
  return out;
}

}  // namespace

double ball_of(const Shape& shape) {
  if (shape.type == ShapeType::solid) return shape.solid->ball;
  if (shape.type == ShapeType::mesh) return shape.mesh->ball;
  if (shape.type == ShapeType::sphere) return shape.radius;
  return 0.5 * std::hypot(shape.edges[0], shape.edges[1], shape.edges[2]);
}

std::vector<Stroke> object_outlines(const Inquiry& inquiry, double time) {
  std::vector<Stroke> out;
  if (!inquiry.traced) return out;
  const TracedPixel& traced = *inquiry.traced;
  for (std::size_t i = 0; i < traced.scene.objects.size(); ++i) {
    const Object& object = traced.scene.objects[i];
    if (object.shape.type == ShapeType::sky) continue;
    double tau = 0;
    for (const HitRecord& hit : traced.hits)
      if (hit.id == i + 1) tau = hit.tau + traced.tau_origins[i];
    const Projection A = projection(inquiry, object, time, tau);
    const ShapeType type = object.shape.type;  // of solids and meshes, the ball that holds them
    const bool edged = type == ShapeType::quad || type == ShapeType::box;
    const bool open = type == ShapeType::quad || object.shape.dome || object.shape.solid || object.shape.mesh;
    out.push_back({open ? Stroke::Kind::outline : Stroke::Kind::filled, kColors[i % kColors.size()],
                   object.name, edged ? box_outline(A, object) : sphere_outline(A, ball_of(object.shape))});
  }
  return out;
}

std::vector<Stroke> landmarks(const Inquiry& inquiry) {
  const MetricDescription metric = inquiry.spacetime->description();
  const auto value = [&](std::string_view name) {
    std::size_t i = 0;
    while (metric.parameters[i].name != name) ++i;
    return inquiry.parameters[i];
  };
  using Kind = Stroke::Kind;
  if (metric.name == "goedel") return {{Kind::dashed, "#777", "Gödel radius 2a", circle(2 * value("a"))}};
  if (metric.name == "ellis_wormhole")
    return {{Kind::dashed, "#777", "throat", circle(0.5 * value("throat"))}};
  if (metric.name == "kerr_schild") {
    // Where r = r_+ on the equator: x^2 + y^2 = r_+^2 + a^2 = 2 M r_+.
    const double M = value("mass"), spin = value("spin"), r = M * (1 + std::sqrt((1 - spin) * (1 + spin)));
    return {{Kind::filled, "#111", "horizon", circle(std::sqrt(2 * M * r))}};
  }
  return {};
}

}  // namespace nullcone
