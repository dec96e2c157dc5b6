// The shipped street at 0.8 c: corners of boxes stand in the picture where light from them arrives. Their
// places are taken from the records (texture coordinates of a face, continued to its corner), and calculated
// from the scene alone in the rest frame of the observer, towards whom the street flies.
#include <algorithm>
#include <fstream>
#include <numbers>

#include "core/base/json.h"
#include "tests/reference_cases.h"
#include "tests/traced.h"

namespace nullcone::test {
namespace {

using Point = std::array<double, 3>;
using Place = std::array<double, 2>;  ///< in the picture, in pixels from the upper left corner

/// A face of the atlas (docs/scene.md): the axis across it and its side, and along which axes u and v grow.
struct Face {
  std::size_t across, along_u, along_v;
  double side, u_sign;
};
constexpr Face kFaces[6] = {{0, 1, 2, 1, 1},   {1, 0, 2, 1, -1}, {2, 0, 1, 1, 1},     // +x, +y, +z: above
                            {0, 1, 2, -1, -1}, {1, 0, 2, -1, 1}, {2, 0, 1, -1, -1}};  // -x, -y, -z: below

/// Where on its face a crossing is, 0 to 1 along u and v.
struct OnFace {
  std::size_t face;
  double s, t, x, y;
};
OnFace on_face(double u, double v, double x, double y) {
  const double column = std::min(std::floor(3 * u), 2.0), row = v > 0.5 ? 0 : 1;
  return {static_cast<std::size_t>(3 * row + column), 3 * u - column, 2 * v - (1 - row), x, y};
}

/// The camera of the scene, by its angles. No roll.
Place projected(const json& camera, const Point& m) {
  const double elevation = double(camera["elevation_deg"]) * std::numbers::pi / 180;
  const double c = std::cos(elevation), s = std::sin(elevation);
  const double forward = c * m[0] + s * m[2], left = m[1], up = c * m[2] - s * m[0];
  const double width = camera["resolution"][0], height = camera["resolution"][1];
  const double scale = 0.5 * width / std::tan(double(camera["fov_deg"]) * std::numbers::pi / 360);
  return {0.5 * width - scale * left / forward, 0.5 * height - scale * up / forward};
}

/// Direction to a point at rest in the street, for the observer who moves along x. In his rest frame the
/// point is at (d_x/gamma - beta t', d_y, d_z), and seen where that is -t' away.
Point seen_from_motion(const Point& d, double beta) {
  const double shrunk = d[0] * std::sqrt(1 - beta * beta);
  const double a = 1 - beta * beta, b = beta * shrunk, c = shrunk * shrunk + d[1] * d[1] + d[2] * d[2];
  const double t = -(b + std::sqrt(b * b + a * c)) / a;  // a t^2 + 2 b t = c, in the past
  return {(shrunk - beta * t) / -t, d[1] / -t, d[2] / -t};
}

/// Solves A x = b by elimination with pivots; returns x[0].
double first_unknown(std::array<std::array<double, 7>, 6> A) {
  for (std::size_t k = 0; k < 6; ++k) {
    std::size_t best = k;
    for (std::size_t i = k; i < 6; ++i)
      if (std::fabs(A[i][k]) > std::fabs(A[best][k])) best = i;
    std::swap(A[k], A[best]);
    for (std::size_t i = 0; i < 6; ++i)
      if (i != k)
        for (std::size_t j = 7; j-- > k;) A[i][j] -= A[i][k] / A[k][k] * A[k][j];
  }
  return A[0][6] / A[0][0];
}

/// The value at (s, t) = 0 of the quadratic in s and t that fits best.
template <class Value>
double at_corner(const std::vector<OnFace>& near, double scale, const Value& value) {
  std::array<std::array<double, 7>, 6> A{};
  for (const OnFace& p : near) {
    const double s = p.s / scale, t = p.t / scale;
    const std::array<double, 7> row = {1, s, t, s * s, s * t, t * t, value(p)};
    for (std::size_t i = 0; i < 6; ++i)
      for (std::size_t j = 0; j < 7; ++j) A[i][j] += row[i] * row[j];
  }
  return first_unknown(A);
}

/// How many pixels wide or high the crossings lie together.
template <class Coordinate>
double extent(const std::vector<OnFace>& crossings, const Coordinate& coordinate) {
  double least = 1e9, most = -1e9;
  for (const OnFace& p : crossings)
    least = std::min(least, coordinate(p)), most = std::max(most, coordinate(p));
  return most - least;
}

/// Where the corner (0 or 1 along u and v) of a face is seen, by its crossings nearest to it; false where
/// they do not reach as far as one pixel from it, for something stands before it or it is beyond the picture,
/// and where they are in fewer columns or lines than a quadratic needs.
bool find_corner(std::vector<OnFace> crossings, double s, double t, Place& place) {
  constexpr std::size_t kNear = 40;
  for (OnFace& p : crossings) p.s -= s, p.t -= t;
  const auto distance = [](const OnFace& p) { return std::max(std::fabs(p.s), std::fabs(p.t)); };
  const auto x = [](const OnFace& p) { return p.x; };
  const auto y = [](const OnFace& p) { return p.y; };
  if (crossings.size() < kNear) return false;
  std::partial_sort(crossings.begin(), crossings.begin() + kNear, crossings.end(),
                    [&](const OnFace& p, const OnFace& q) { return distance(p) < distance(q); });
  crossings.resize(kNear);
  if (extent(crossings, x) < 1.5 || extent(crossings, y) < 1.5) return false;
  const double scale = distance(crossings.back());
  place = {at_corner(crossings, scale, x), at_corner(crossings, scale, y)};
  return std::any_of(crossings.begin(), crossings.end(),
                     [&](const OnFace& p) { return std::hypot(p.x - place[0], p.y - place[1]) < 1; });
}

TEST(Street, CornersStandWhereAberrationPutsThem) {
  const json text = json::parse(std::ifstream(NULLCONE_SOURCE "/scenes/street.json"));
  const Traced traced = trace_text(text.dump());
  const double samples = text["camera"]["samples"], beta = text["observer"]["velocity"][0];
  const json& eye = text["observer"]["event"];
  std::vector<std::array<std::vector<OnFace>, 6>> faces(text["objects"].size());
  const auto width = static_cast<std::size_t>(traced.scene.camera.width * traced.scene.camera.samples);
  const auto lines = static_cast<std::size_t>(kBandLines * traced.scene.camera.samples);
  for (std::size_t band = 0; band < traced.bands.size(); ++band)
    for (const HitRecord& h : traced.bands[band].hits) {
      const auto line = static_cast<double>(lines * band + h.pixel / width);
      const OnFace p =
          on_face(h.u, h.v, (static_cast<double>(h.pixel % width) + 0.5) / samples, (line + 0.5) / samples);
      faces[h.id - 1][p.face].push_back(p);
    }
  double worst = 0, nearest = 1e9, farthest = 0;
  int corners = 0, behind = 0;
  for (std::size_t n = 0; n < faces.size(); ++n) {
    const json& object = text["objects"][n];
    if (object["shape"]["type"] != "box") continue;
    for (std::size_t f = 0; f < 6; ++f)
      for (const double s : {0.0, 1.0})
        for (const double t : {0.0, 1.0}) {
          Place found{};
          if (!find_corner(faces[n][f], s, t, found)) continue;
          const Face& face = kFaces[f];
          Point d{};
          const auto put = [&](std::size_t axis, double side) {
            d[axis] = double(object["placing"]["worldline"]["event"][axis + 1]) - double(eye[axis + 1]) +
                      0.5 * side * double(object["shape"]["edges"][axis]);
          };
          put(face.across, face.side);
          put(face.along_u, face.u_sign * (2 * s - 1));
          put(face.along_v, 2 * t - 1);
          const Place expected = projected(text["camera"], seen_from_motion(d, beta));
          const double off = std::hypot(found[0] - expected[0], found[1] - expected[1]);
          EXPECT_LE(off, 0.1) << object["name"] << " face " << f << " corner " << s << ", " << t << " at "
                              << expected[0] << ", " << expected[1];
          const double distance = std::hypot(d[0], d[1], d[2]);
          worst = std::max(worst, off), ++corners, behind += d[0] < 0;
          nearest = std::min(nearest, distance), farthest = std::max(farthest, distance);
        }
  }
  EXPECT_GE(corners, 40);
  EXPECT_GE(behind, 4);  // what the observer has passed, he sees before him
  std::printf("%d corners, %.1f to %.1f away, %d of them behind the observer; farthest off %.4f pixels\n",
              corners, nearest, farthest, behind, worst);
}

/// The same direction by the formula cos theta' = (cos theta + beta)/(1 + beta cos theta).
TEST(Street, TheRetardedEventGivesTheAberrationFormula) {
  for (const Point d : {Point{40, -6, 5}, Point{-3, 7, 2}, Point{-30, 4, 9}, Point{0.1, 5, -2}}) {
    const double distance = std::hypot(d[0], d[1], d[2]), cosine = d[0] / distance;
    EXPECT_NEAR(seen_from_motion(d, 0.8)[0], (cosine + 0.8) / (1 + 0.8 * cosine), 1e-14);
  }
}

}  // namespace
}  // namespace nullcone::test
