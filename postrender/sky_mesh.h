// The map from the picture to the directions on a sky, as a mesh of vertices in rows: one a ray, and beyond
// the edges of the picture, or of the faces of a cube map, as the map goes on there.
#pragma once

#include <cstdint>
#include <optional>
#include <vector>

#include "core/base/camera.h"
#include "core/record/dataset.h"
#include "postrender/stars.h"

namespace nullcone::postrender {

/// As far as the manifest tells: nothing without its `setting`.
std::optional<Camera> camera_of(const Manifest& manifest);

struct SkyVertex {
  Direction direction;
  float shift;
  std::uint32_t ray;  ///< in the grid of samples; beyond the edges the nearest
  bool on_sky;        ///< else the other entries mean nothing
};

class SkyMesh {
 public:
  /// `samples` as in find_star_images(); `beyond` in pixels.
  SkyMesh(const Dataset& samples, const Manifest& picture, std::uint32_t id, double beyond);

  struct Column {
    double x;           ///< in pixels of the picture
    int ray;            ///< column in the grid of samples; -1: continued
    int first, second;  ///< where it is continued from, the outer one first: columns in the grid of samples
    double steps;       ///< and how far, in rays
    bool joined;        ///< to the next column
    std::int32_t left, right;  ///< columns of the picture that belong to its face
  };
  const std::vector<Column>& columns() const { return columns_; }
  std::size_t rows() const { return y_.size(); }
  double y(std::size_t row) const { return y_[row]; }
  bool wraps() const { return wraps_; }

  /// The vertices of a row, one a column.
  void read_row(std::size_t row, std::vector<SkyVertex>& out) const;
  /// Rows beyond the outermost rays, on each side: at the border, and as far beyond as was asked for.
  static constexpr std::size_t kOuter = 2;

 private:
  void add_columns(int first, int last, double beyond);
  void read_rays(int row, std::vector<SkyVertex>& out) const;
  SkyVertex vertex_of(std::uint32_t ray) const;

  const Dataset& samples_;
  std::uint32_t id_;
  int per_pixel_;
  bool wraps_;
  std::array<bool, 2> in_pole_ = {};  ///< whether the upper and the lower border are one direction each
  std::vector<Column> columns_;
  std::vector<double> y_;      ///< of the rows, in lines of the window
  std::array<double, 2> out_;  ///< how far the border lies beyond the outermost rays, and the end; in rays
};

}  // namespace nullcone::postrender
