#include "postrender/star_images.h"

#include <tbb/blocked_range.h>
#include <tbb/parallel_for.h>

#include "postrender/sky_mesh.h"

namespace nullcone::postrender {

namespace {

double dot(const Direction& a, const Direction& b) { return a[0] * b[0] + a[1] * b[1] + a[2] * b[2]; }
/// Exactly -cross(b, a).
Direction cross(const Direction& a, const Direction& b) {
  return {a[1] * b[2] - a[2] * b[1], a[2] * b[0] - a[0] * b[2], a[0] * b[1] - a[1] * b[0]};
}
double square_distance(const Direction& a, const Direction& b) {
  const Direction d = {a[0] - b[0], a[1] - b[1], a[2] - b[2]};
  return dot(d, d);
}

/// A corner of a triangle, in pixels of the picture.
struct Corner {
  const SkyVertex* vertex;
  double x, y;
};

/// A triangle of neighbouring rays; corners in the order of the mesh. `clockwise` in that order.
class Triangle {
 public:
  Triangle(const Corner& a, const Corner& b, const Corner& c, bool clockwise)
      : corners_{a, b, c}, clockwise_(clockwise) {
    if (!a.vertex->on_sky || !b.vertex->on_sky || !c.vertex->on_sky) return;
    const double ab = square_distance(direction(0), direction(1)),
                 bc = square_distance(direction(1), direction(2)),
                 ac = square_distance(direction(0), direction(2));
    square_reach_ = std::max(ab, ac);
    seen_ = std::max(square_reach_, bc) <= kLargestStep * kLargestStep;
  }
  /// Whether it shows a piece of the sky.
  bool seen() const { return seen_; }
  /// The square of the longest chord from the first corner.
  double square_reach() const { return seen_ ? square_reach_ : 0; }
  const Corner& corner(std::size_t i) const { return corners_[i]; }

  /// To be called before those that follow.
  void prepare() {
    if (!seen_) return;
    edges_ = {cross(direction(0), direction(1)), cross(direction(1), direction(2)),
              cross(direction(0), direction(2))};
    volume_ = dot(direction(2), edges_[0]);
    seen_ = volume_ != 0;
  }
  /// Van Oosterom and Strackee 1983, "The solid angle of a plane triangle", eq. 8.
  double solid_angle() const {
    const Direction &A = direction(0), &B = direction(1), &C = direction(2);
    return 2 * std::atan2(std::abs(volume_), 1 + dot(A, B) + dot(B, C) + dot(A, C));
  }
  /// In pixels.
  double area() const {
    const auto& [a, b, c] = corners_;
    return 0.5 * std::abs((b.x - a.x) * (c.y - a.y) - (b.y - a.y) * (c.x - a.x));
  }

  /// Whether the star is inside, and the weights of the corners. What lies on an edge belongs to one of its
  /// two triangles, what lies on a corner to one of its six: the one that goes along the edge as the mesh
  /// does.
  bool holds(const Direction& star, std::array<double, 3>& weights) const {
    const double ab = dot(edges_[0], star), bc = dot(edges_[1], star), ac = dot(edges_[2], star);
    const bool inside = clockwise_ ? within(ab, true) && within(bc, true) && within(-ac, false)
                                   : within(ac, true) && within(-bc, false) && within(-ab, false);
    if (!inside) return false;
    const double sum = std::abs(ab) + std::abs(bc) + std::abs(ac);
    if (!(sum > 0)) return false;
    weights = {std::abs(bc) / sum, std::abs(ac) / sum, std::abs(ab) / sum};
    return true;
  }

 private:
  const Direction& direction(std::size_t i) const { return corners_[i].vertex->direction; }
  /// Of a side that is gone along clockwise in the picture; of mirrored images that is the other way round.
  bool within(double side, bool along) const {
    if (side == 0) return along;
    return (side > 0) == (clockwise_ != (volume_ < 0));
  }

  std::array<Corner, 3> corners_;
  std::array<Direction, 3> edges_{};  ///< each from the corner that stands first in the mesh
  double volume_ = 0, square_reach_ = 0;
  bool clockwise_, seen_ = false;
};

/// Solid angle that a pixel of the picture sees, about a place in it.
double pixel_sr(const Camera& camera, double x, double y, double left, double right) {
  constexpr double kStep = 0.01;
  const double at_x = std::clamp(x, left + 0.5, right - 0.5), at_y = std::clamp(y, 0.5, camera.height - 0.5);
  const auto look = [&](double dx, double dy) {
    return host::look_direction<double>(camera, at_x, at_y, dx, dy);
  };
  const auto across = look(kStep, 0) - look(-kStep, 0), along = look(0, kStep) - look(0, -kStep);
  const auto area =
      cross(Direction{across[0], across[1], across[2]}, Direction{along[0], along[1], along[2]});
  return std::sqrt(dot(area, area)) / (4 * kStep * kStep);
}

/// Finds images in one row of the mesh after the other.
class Finder {
 public:
  Finder(const SkyMesh& mesh, const Manifest& picture, const StarField& field)
      : mesh_(mesh), camera_(camera_of(picture)), first_line_(picture.first_line), field_(field) {}

  /// Of the triangles between two rows of vertices.
  void find(std::size_t row, const std::vector<SkyVertex>& upper, const std::vector<SkyVertex>& lower,
            std::vector<StarImage>& out) const {
    const auto& columns = mesh_.columns();
    const double y0 = mesh_.y(row), y1 = mesh_.y(row + 1);
    for (std::size_t i = 0; i + 1 < columns.size(); ++i) {
      if (!columns[i].joined) continue;
      const double x0 = columns[i].x, x1 = columns[i + 1].x;
      const Corner a{&upper[i], x0, y0}, b{&upper[i + 1], x1, y0}, c{&lower[i], x0, y1},
          d{&lower[i + 1], x1, y1};
      if (a.vertex->on_sky && d.vertex->on_sky)
        find({Triangle(a, b, d, true), Triangle(a, c, d, false)}, columns[i], out);
    }
  }

 private:
  void find(std::array<Triangle, 2> triangles, const SkyMesh::Column& column,
            std::vector<StarImage>& out) const {
    constexpr double kChordToAngle = 1.02;  // within kLargestStep
    const double square = std::max(triangles[0].square_reach(), triangles[1].square_reach());
    if (square == 0) return;
    const SkyVertex& at = *triangles[0].corner(0).vertex;
    bool prepared = false;
    field_.near(at.latitude, at.longitude, kChordToAngle * std::sqrt(square) + 1e-6,
                [&](std::uint32_t first, std::uint32_t last) {
                  if (!prepared)
                    for (Triangle& triangle : triangles) triangle.prepare();
                  prepared = true;
                  for (std::uint32_t number = first; number < last; ++number)
                    test(triangles, column, number, out);
                });
  }

  void test(const std::array<Triangle, 2>& triangles, const SkyMesh::Column& column, std::uint32_t number,
            std::vector<StarImage>& out) const {
    const auto& p = field_.stars()[number].direction;
    const Direction star = {static_cast<double>(p[0]), static_cast<double>(p[1]), static_cast<double>(p[2])};
    std::array<double, 3> weights;
    for (const Triangle& triangle : triangles)
      if (triangle.seen() && triangle.holds(star, weights))
        out.push_back(image_of(triangle, column, number, weights));
  }

  StarImage image_of(const Triangle& triangle, const SkyMesh::Column& column, std::uint32_t number,
                     const std::array<double, 3>& weights) const {
    StarImage out{};
    double x = 0, y = 0, shift = 0;
    for (std::size_t i = 0; i < 3; ++i) {
      const Corner& corner = triangle.corner(i);
      x += weights[i] * corner.x;
      y += weights[i] * corner.y;
      shift += weights[i] * static_cast<double>(corner.vertex->shift);
      out.corners[i] = corner.vertex->ray;
      out.weights[i] = static_cast<float>(weights[i]);
    }
    const double area = triangle.area() / triangle.solid_angle();
    out.x = static_cast<float>(x);
    out.y = static_cast<float>(y);
    out.shift = static_cast<float>(shift);
    out.star = number;
    out.area = static_cast<float>(area);
    out.left = column.left;
    out.right = column.right;
    if (camera_)
      out.magnification =
          static_cast<float>(area * pixel_sr(*camera_, x, y + first_line_, column.left, column.right));
    return out;
  }

  const SkyMesh& mesh_;
  std::optional<Camera> camera_;
  int first_line_;
  const StarField& field_;
};

}  // namespace

StarImages find_star_images(const Dataset& samples, const Manifest& picture, std::uint32_t id,
                            const StarField& field) {
  constexpr std::size_t kBand = 16;
  const SkyMesh mesh(samples, picture, id, kBeyondEdge);
  const Finder finder(mesh, picture, field);
  // Step 1: band by band, each by itself.
  const std::size_t rows = mesh.rows() - 1, bands = (rows + kBand - 1) / kBand;
  std::vector<std::vector<StarImage>> found(bands);
  std::vector<std::size_t> count(rows);
  tbb::parallel_for(tbb::blocked_range<std::size_t>(0, bands, 1), [&](const auto& range) {
    std::vector<SkyVertex> upper, lower;
    for (std::size_t band = range.begin(); band < range.end(); ++band) {
      mesh.read_row(band * kBand, lower);
      for (std::size_t row = band * kBand; row < std::min(rows, (band + 1) * kBand); ++row) {
        upper.swap(lower);
        mesh.read_row(row + 1, lower);
        const std::size_t before = found[band].size();
        finder.find(row, upper, lower, found[band]);
        count[row] = found[band].size() - before;
      }
    }
  });
  // Step 2: all together, from the top.
  StarImages out;
  out.wraps = mesh.wraps();
  out.row_first = {0};
  for (std::size_t row = 0; row < rows; ++row) out.row_first.push_back(out.row_first.back() + count[row]);
  for (std::size_t row = 0; row <= rows; ++row) out.row_y.push_back(static_cast<float>(mesh.y(row)));
  out.images.reserve(out.row_first.back());
  for (const std::vector<StarImage>& band : found)
    out.images.insert(out.images.end(), band.begin(), band.end());
  return out;
}

}  // namespace nullcone::postrender
