#include "postrender/star_images.h"

#include <tbb/blocked_range.h>
#include <tbb/parallel_for.h>

#include "postrender/sky_triangle.h"

namespace nullcone::postrender {

namespace {

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

/// Rows of the mesh: that above a row of triangles, its own two, and that below; null where there is none.
using Rows = std::array<const std::vector<SkyVertex>*, 4>;

/// Finds images in one row of triangles.
class Finder {
 public:
  Finder(const SkyMesh& mesh, const Manifest& picture, const StarField& field)
      : mesh_(mesh), camera_(camera_of(picture)), first_line_(picture.first_line), field_(field) {}

  /// Of the triangles between rows `row` and `row` + 1, which are the middle ones of `rows`.
  void find(std::size_t row, const Rows& rows, std::vector<StarImage>& out) const {
    const auto& columns = mesh_.columns();
    const auto corner = [&](std::size_t down, std::size_t column) {
      return Corner{&(*rows[1 + down])[column], columns[column].x, mesh_.y(row + down), row + down, column};
    };
    for (std::size_t i = 0; i + 1 < columns.size(); ++i) {
      if (!columns[i].joined) continue;
      const Corner a = corner(0, i), b = corner(0, i + 1), c = corner(1, i), d = corner(1, i + 1);
      if (a.vertex->on_sky && d.vertex->on_sky)
        find(Quad{row, rows, {Triangle(a, b, d, true), Triangle(a, c, d, false)}}, out);
    }
  }

 private:
  struct Quad {
    std::size_t row;
    const Rows& rows;
    std::array<Triangle, 2> triangles;
  };

  void find(Quad quad, std::vector<StarImage>& out) const {
    if (!quad.triangles[0].seen() && !quad.triangles[1].seen()) return;
    bool prepared = false;
    field_.within(box_of(quad), [&](std::uint32_t first, std::uint32_t last) {
      if (!prepared)
        for (Triangle& triangle : quad.triangles) triangle.prepare();
      prepared = true;
      for (std::uint32_t number = first; number < last; ++number) test(quad, number, out);
    });
  }

  /// Holds both triangles. Where their corners are apart by s they bulge by less than s^2 / 5 from the flat
  /// ones.
  static Box box_of(const Quad& quad) {
    Direction low = {2, 2, 2}, high = {-2, -2, -2};
    double square = 0;
    for (const Triangle& triangle : quad.triangles) {
      if (!triangle.seen()) continue;
      square = std::max(square, triangle.square_side());
      for (std::size_t i = 0; i < 3; ++i) {
        const Direction& d = triangle.corner(i).vertex->direction;
        for (std::size_t k = 0; k < 3; ++k)
          low[k] = std::min(low[k], d[k]), high[k] = std::max(high[k], d[k]);
      }
    }
    const double more = square / 5 + 1e-6;  // and what float loses
    Box out;
    for (std::size_t k = 0; k < 3; ++k) {
      out.low[k] = static_cast<float>(low[k] - more);
      out.high[k] = static_cast<float>(high[k] + more);
    }
    return out;
  }

  void test(const Quad& quad, std::uint32_t number, std::vector<StarImage>& out) const {
    const auto& p = field_.stars()[number].direction;
    const Direction star = {static_cast<double>(p[0]), static_cast<double>(p[1]), static_cast<double>(p[2])};
    std::array<double, 3> weights;
    for (const Triangle& triangle : quad.triangles)
      if (triangle.seen() && triangle.holds(star, weights))
        out.push_back(image_of(quad, triangle, number, weights));
  }

  /// Solid angle on the sky that a pixel about a corner covers, by the corner's neighbours, negative where
  /// the image is mirrored; 0 where it has not all of them.
  double density_at(const Quad& quad, const Corner& corner) const {
    const auto& columns = mesh_.columns();
    const std::size_t rank = corner.row - quad.row + 1, last = columns.size() - 1;
    const std::vector<SkyVertex>*above = quad.rows[rank - 1], *below = quad.rows[rank + 1];
    const std::size_t i = corner.column, west = i > 0 ? i - 1 : last - 1, east = i < last ? i + 1 : 1;
    const bool inner =
        mesh_.wraps() || (columns[i].ray >= 0 && columns[west].ray >= 0 && columns[east].ray >= 0);
    if (!inner || corner.row <= SkyMesh::kOuter || corner.row + SkyMesh::kOuter + 1 >= mesh_.rows()) return 0;
    const std::vector<SkyVertex>& here = *quad.rows[rank];
    const std::array<const SkyVertex*, 4> around = {&here[west], &here[east], &(*above)[i], &(*below)[i]};
    for (const SkyVertex* one : around)
      if (!one->on_sky ||
          square_distance(one->direction, corner.vertex->direction) > kLargestStep * kLargestStep)
        return 0;
    Direction across, along;
    for (std::size_t k = 0; k < 3; ++k) {
      across[k] = around[1]->direction[k] - around[0]->direction[k];
      along[k] = around[3]->direction[k] - around[2]->direction[k];
    }
    const double pixels =
        2 * (mesh_.y(corner.row + 1) - mesh_.y(corner.row));  // both ways: rays stand on squares
    return dot(corner.vertex->direction, cross(across, along)) / (pixels * pixels);
  }

  /// Pixels a unit of solid angle at a place in a triangle. Its own mean is right to the first order in its
  /// size; linear between what is found at its corners, to the second. But not across folds of the map, and
  /// not where rays hardly resolve it.
  double pixels_a_steradian(const Quad& quad, const Triangle& triangle,
                            const std::array<double, 3>& weights) const {
    const double mean = triangle.solid_angle() / triangle.area();
    double here = 0;
    for (std::size_t i = 0; i < 3; ++i) {
      const double density = triangle.sense() * density_at(quad, triangle.corner(i));
      if (!(density > 0.5 * mean && density < 2 * mean)) return 1 / mean;
      here += weights[i] * density;
    }
    return 1 / here;
  }

  StarImage image_of(const Quad& quad, const Triangle& triangle, std::uint32_t number,
                     const std::array<double, 3>& weights) const {
    const SkyMesh::Column& column = mesh_.columns()[triangle.corner(0).column];
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
    const double area = pixels_a_steradian(quad, triangle, weights);
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
    std::array<std::vector<SkyVertex>, 4> kept;  // row r in place r modulo 4
    for (std::size_t band = range.begin(); band < range.end(); ++band) {
      const auto read = [&](std::size_t row) {
        if (row < mesh.rows()) mesh.read_row(row, kept[row % 4]);
      };
      const std::size_t first = band * kBand;
      for (std::size_t row = first - std::min<std::size_t>(first, 1); row < first + 2; ++row) read(row);
      for (std::size_t row = first; row < std::min(rows, first + kBand); ++row) {
        read(row + 2);
        const Rows around = {row > 0 ? &kept[(row + 3) % 4] : nullptr, &kept[row % 4], &kept[(row + 1) % 4],
                             row + 2 < mesh.rows() ? &kept[(row + 2) % 4] : nullptr};
        const std::size_t before = found[band].size();
        finder.find(row, around, found[band]);
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
