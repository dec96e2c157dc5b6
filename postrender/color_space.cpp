#include "postrender/color_space.h"

#include <Eigen/Dense>

#include "postrender/black_body.h"

namespace nullcone::postrender {

namespace {

using Matrix = Eigen::Matrix<double, 3, 3, Eigen::RowMajor>;

Matrix3 array_of(const Matrix& m) {
  Matrix3 out{};
  for (int i = 0; i < 3; ++i)
    for (int j = 0; j < 3; ++j) out[static_cast<std::size_t>(i)][static_cast<std::size_t>(j)] = m(i, j);
  return out;
}

Matrix matrix_of(const Matrix3& m) { return Eigen::Map<const Matrix>(m.front().data()); }

Eigen::Vector3d xyz_of(const Chromaticity& c) { return {c.x / c.y, 1.0, (1 - c.x - c.y) / c.y}; }

/// XYZ -> "sharpened" cones: Lam's matrix, as ICC.1:2010 Annex E prints it.
Matrix bradford_cones() {
  Matrix out;
  out << 0.8951, 0.2664, -0.1614, -0.7502, 1.7135, 0.0367, 0.0389, -0.0685, 1.0296;
  return out;
}

}  // namespace

std::string_view name_of(OutputSpace space) {
  for (const auto& [name, value] : kOutputSpaces)
    if (value == space) return name;
  return {};
}

Primaries primaries_of(OutputSpace space) {
  switch (space) {
    case OutputSpace::display_p3:
      return {{0.680, 0.320}, {0.265, 0.690}, {0.150, 0.060}, kD65};
    case OutputSpace::xyz:
      return {{1, 0}, {0, 1}, {0, 0}, kEqualEnergy};
    case OutputSpace::srgb:
    case OutputSpace::linear_rec709:
      break;
  }
  return {{0.64, 0.33}, {0.30, 0.60}, {0.15, 0.06}, kD65};
}

Matrix3 to_xyz(OutputSpace space) {
  if (space == OutputSpace::xyz) return {{{1, 0, 0}, {0, 1, 0}, {0, 0, 1}}};
  const Primaries from = primaries_of(space);
  Matrix columns;  // R, G, B at Y = 1 each
  columns << xyz_of(from.red), xyz_of(from.green), xyz_of(from.blue);
  // Scale the primaries so that R = G = B = 1 is the white.
  const Eigen::Vector3d scale = columns.partialPivLu().solve(xyz_of(from.white));
  return array_of(columns * scale.asDiagonal());
}

Rgb luminance_weights(OutputSpace space) {
  const auto [r, g, b] = to_xyz(space)[1];
  return {static_cast<float>(r), static_cast<float>(g), static_cast<float>(b)};
}

std::optional<Matrix3> adaptation(const Chromaticity& from, const Chromaticity& to) {
  const Matrix cones = bradford_cones();
  const Eigen::Vector3d before = cones * xyz_of(from), after = cones * xyz_of(to);
  constexpr double kLeast = 1e-3;
  if (!(before.minCoeff() >= kLeast) || !(after.minCoeff() >= kLeast)) return {};
  return array_of(cones.inverse() * after.cwiseQuotient(before).asDiagonal() * cones);
}

Chromaticity black_body_chromaticity(double temperature_K) {
  const Xyz xyz = black_body_xyz(temperature_K);
  const double sum = xyz[0] + xyz[1] + xyz[2];
  return {xyz[0] / sum, xyz[1] / sum};
}

std::optional<Matrix3> output_matrix(OutputSpace space, const Chromaticity& white) {
  const bool rec709 = space == OutputSpace::srgb || space == OutputSpace::linear_rec709;
  if (rec709 && white == kD65) return {};
  const Matrix into = matrix_of(to_xyz(space)).inverse(), from = matrix_of(to_xyz(OutputSpace::srgb));
  const std::optional<Matrix3> adapted = adaptation(white, kD65);
  return array_of(adapted && white != kD65 ? Matrix(into * matrix_of(*adapted) * from) : Matrix(into * from));
}

}  // namespace nullcone::postrender
