// One triangle and a line or a point near it. One lane.
#pragma once

#include "core/base/vector.h"
#include "core/scene/mesh.h"
#include "core/trace/sight.h"

NULLCONE_KERNEL_BEGIN

inline Vec3<double> corner_of(const MeshTriangle& triangle, std::size_t i) {
  const double* const p = triangle.corner[i];
  return {{p[0], p[1], p[2]}};
}

/// Whether a line passes through triangles: no line slips through where they meet (Woop, Benthin and Wald
/// 2013). Corners are sheared onto the line; the three areas about it have the same sign. Two triangles find
/// the same area at a common edge, but for the sign, and rounding may make it zero, never change its sign.
class Shear {
 public:
  Shear(const Vec3<double>& foot, const Vec3<double>& W) : foot_(foot) {
    const double x = abs(W[0]), y = abs(W[1]), z = abs(W[2]);
    z_ = x > y ? (x > z ? 0 : 2) : (y > z ? 1 : 2);
    x_ = z_ == 2 ? 0 : z_ + 1, y_ = x_ == 2 ? 0 : x_ + 1;
    by_x_ = W[x_] / W[z_], by_y_ = W[y_] / W[z_];
  }
  struct Areas {
    double a, b, c;

    bool on_an_edge() const { return a == 0 || b == 0 || c == 0; }
    bool crossed() const {
      return !((a < 0 || b < 0 || c < 0) && (a > 0 || b > 0 || c > 0)) && a + b + c != 0;
    }
  };
  Areas areas(const MeshTriangle& triangle) const {
    double x[3], y[3];
    for (std::size_t i = 0; i < 3; ++i) {
      const double* const p = triangle.corner[i];
      const double along = p[z_] - foot_[z_];
      x[i] = (p[x_] - foot_[x_]) - by_x_ * along;
      y[i] = (p[y_] - foot_[y_]) - by_y_ * along;
    }
    return {x[2] * y[1] - y[2] * x[1], x[0] * y[2] - y[0] * x[2], x[1] * y[0] - y[1] * x[0]};
  }

 private:
  Vec3<double> foot_;
  std::size_t x_, y_, z_;
  double by_x_, by_y_;
};

/// The plane of a triangle as X sees it, which moves with the slope W.
struct TrianglePlane {
  Vec3<double> normal;  ///< of length 1; the corners go round it to the left
  double ahead;         ///< what is left to it, along the normal
  double rate;          ///< at which X comes nearer, likewise
  double blur;          ///< what rounding leaves of `ahead`: slivers have no sharp planes

  TrianglePlane(const MeshTriangle& triangle, const Vec3<double>& X, const Vec3<double>& W) {
    const Vec3<double> a = corner_of(triangle, 0), u = corner_of(triangle, 1) - a,
                       v = corner_of(triangle, 2) - a, n = cross(u, v), from = a - X;
    const double size = norm(n);
    normal = (1 / size) * n;
    ahead = dot(normal, from), rate = dot(normal, W);
    blur = 1e-15 * (sqrt(dot(u, u) * dot(v, v)) / size) * norm(from);
  }
};

/// Whether X is within the box about a triangle, or nearly.
inline bool is_beside(const MeshTriangle& triangle, const Vec3<double>& X, double room) {
  for (std::size_t i = 0; i < 3; ++i) {
    const double a = triangle.corner[0][i], b = triangle.corner[1][i], c = triangle.corner[2][i];
    if (X[i] < min(a, min(b, c)) - room || X[i] > max(a, max(b, c)) + room) return false;
  }
  return true;
}

/// How a curved ray is bounded: it stays within bend t^2/2 of the line X + t W until t = `until`.
struct Bow {
  Vec3<double> X, W;
  double bend, until;
  double rounding;  ///< a length

  double thickness() const { return 0.5 * bend * until * until + rounding; }
};

/// A time before which a curved ray cannot meet the triangle, or kFar: not before it comes to its plane, nor
/// before it is on the inner side of each edge; and it may do so only while all of that can hold at once.
inline double not_before(const MeshTriangle& triangle, const Bow& ray) {
  const TrianglePlane plane(triangle, ray.X, ray.W);
  const double off = abs(plane.ahead), away = plane.ahead < 0 ? plane.rate : -plane.rate;
  const double thickness = ray.thickness();
  double enters = off <= ray.rounding + plane.blur ? 0 : plane_step(off, away, ray.bend), leaves = ray.until;
  if (enters >= ray.until) return kFar;
  if (away < 0) leaves = min(leaves, (off + thickness) / -away);
  for (std::size_t i = 0; i < 3; ++i) {
    const Vec3<double> p = corner_of(triangle, i), edge = corner_of(triangle, i < 2 ? i + 1 : 0) - p,
                       outward = cross(edge, plane.normal);
    const double over_length = 1 / norm(edge);
    const double outside = over_length * dot(outward, ray.X - p) - ray.rounding;
    const double rate = over_length * dot(outward, ray.W);
    if (outside > 0) enters = max(enters, plane_step(outside, rate, ray.bend));
    if (rate > 0) leaves = min(leaves, (thickness - outside) / rate);
  }
  return enters > leaves ? kFar : enters;
}

/// The point of a triangle that is nearest to X, as parts of its second and third corner (Ericson 2005,
/// section 5.1.5).
struct Nearest {
  double second, third;
  double distance2;

  Nearest(const MeshTriangle& triangle, const Vec3<double>& X) {
    const Vec3<double> a = corner_of(triangle, 0), u = corner_of(triangle, 1) - a,
                       v = corner_of(triangle, 2) - a, from = X - a;
    find(dot(u, u), dot(u, v), dot(v, v), dot(u, from), dot(v, from));
    const Vec3<double> off = from - second * u - third * v;
    distance2 = dot(off, off);
  }

 private:
  static double within(double x) { return x > 0 ? min(x, 1.0) : 0.0; }

  void find(double uu, double uv, double vv, double u, double v) {
    const double area = uu * vv - uv * uv;
    second = (vv * u - uv * v) / area, third = (uu * v - uv * u) / area;
    if (second >= 0 && third >= 0 && second + third <= 1) return;
    // Else on the nearest of the edges: squares of the distance, less that to the first corner.
    const double on_u = within(u / uu), on_v = within(v / vv);
    const double ww = uu - 2 * uv + vv, on_w = within((v - u + uu - uv) / ww);
    const double to_u = on_u * (on_u * uu - 2 * u), to_v = on_v * (on_v * vv - 2 * v);
    const double s = 1 - on_w, t = on_w;
    const double to_w = s * s * uu + 2 * s * t * uv + t * t * vv - 2 * (s * u + t * v);
    second = on_u, third = 0;
    if (to_v < to_u) second = 0, third = on_v;
    if (to_w < min(to_u, to_v)) second = s, third = t;
  }
};

NULLCONE_KERNEL_END
