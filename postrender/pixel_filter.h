// Pixel filters: from the samples of a line, or of a column, to its pixels.
#pragma once

#include <cstddef>
#include <vector>

#include "postrender/image.h"

namespace nullcone::postrender {

/// What a pixel takes in; the same along both axes (separable).
struct PixelFilter {
  enum class Type { box, gaussian, mitchell } type = Type::box;
  double width = 1;  ///< of all that it takes in, in pixels
  bool operator==(const PixelFilter&) const = default;
};

inline constexpr double kWidestFilter = 32;

/// The width where a look gives none.
double usual_width(PixelFilter::Type type);

/// The filter at x pixels from the pixel's centre, not normalised; 0 beyond half its width.
///
/// box: 1. gaussian: exp(-x^2 / 2 sigma^2), sigma = width / 4. mitchell: Mitchell & Netravali,
/// "Reconstruction filters in computer graphics" (1988), eq. (8) with B = C = 1/3, stretched from its width
/// of 4.
double filter_value(const PixelFilter& filter, double x);

/// Whether every pixel is its only sample.
bool is_identity(const PixelFilter& filter, int samples);

/// For each pixel of a line the samples that it takes in, and their weights, which add up to 1: also at the
/// borders, where samples are missing. A box weighs a sample by how much of its cell it covers.
class FilterTable {
 public:
  FilterTable(const PixelFilter& filter, int pixels, int samples);

  std::size_t pixels() const { return taps_.size(); }
  /// Calls add(weight, sample) in the order of the samples.
  template <class Add>
  void for_each_sample(std::size_t pixel, Add&& add) const {
    const Taps& taps = taps_[pixel];
    for (std::size_t k = 0; k < taps.weights.size(); ++k) add(taps.weights[k], taps.first + k);
  }

 private:
  struct Taps {
    std::size_t first;
    std::vector<float> weights;
  };
  std::vector<Taps> taps_;
};

/// Along a line: one colour a sample in, one a pixel out.
void filter_line(const FilterTable& table, const Rgbx* samples, Rgbx* pixels);

/// Down the columns: line `row` of the picture from the lines of samples, each `width` long.
void filter_columns(const FilterTable& table, std::size_t row, const Rgbx* samples, std::size_t width,
                    Rgbx* pixels);

}  // namespace nullcone::postrender
