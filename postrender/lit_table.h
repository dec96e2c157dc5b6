// Lit surfaces: what is seen of a reflectance under a lamp, by two frequency ratios.
#pragma once

#include "postrender/bit_grid.h"
#include "postrender/light_tables.h"

namespace nullcone::postrender {

/// Colours (linear sRGB) of the integrals over wavelength of rho(g lambda) I(g_light g lambda) with the
/// sensor's responses, times the powers of g (radiance) and g_light (irradiance): Weiskopf, Kraus and Ruder
/// 1999, eqs. (14) and (18). g is observer over surface, g_light surface over lamp. Without lines. Bicubic
/// between nodes at the upper bits of both ratios.
class LitTable {
 public:
  LitTable(AnySpectrum lamp, AnySpectrum reflectance, const Effects& effects, const Sensor& sensor,
           ShiftRange shifts, ShiftRange light_shifts);

  /// Black unless both are positive and finite; beyond its ranges as at their ends.
  Rgb color(float g, float g_light) const;
  LitTableView view() const;
  /// The greatest error found between the nodes, relative to the largest component there, or to a hundredth
  /// of the largest in the table.
  double error() const { return error_; }
  std::size_t bytes() const { return cells_.size() * sizeof(Cell); }

 private:
  /// Coefficients of s^i t^j at [4 i + j]; s along g, t along g_light.
  struct Cell {
    std::array<Rgbx, 16> c;
    Rgb at(float s, float t) const;  ///< both from 0 to 1
  };
  using Colors = std::function<std::array<double, 3>(double, double)>;
  void fill(const Colors& colors);
  double measure(const Colors& colors) const;

  BitGrid along_, across_;
  std::vector<Cell> cells_;
  double error_ = 0;
};

}  // namespace nullcone::postrender
