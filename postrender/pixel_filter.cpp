#include "postrender/pixel_filter.h"

#include <algorithm>
#include <cmath>

namespace nullcone::postrender {

namespace {

/// Eq. (8) of Mitchell & Netravali with B = C = 1/3, for 0 <= x.
double mitchell(double x) {
  if (x >= 2) return 0;
  if (x >= 1) return ((-7.0 / 3 * x + 12) * x - 20) * x / 6 + 16.0 / 9;
  return ((7 * x - 12) * x * x + 16.0 / 3) / 6;
}

void add(Rgbx& sum, float weight, const Rgbx& c) {
  sum.r += weight * c.r;
  sum.g += weight * c.g;
  sum.b += weight * c.b;
}

/// How much a pixel whose centre is at `centre` takes in of the sample's cell from `left` to `right`.
double taken_in(const PixelFilter& filter, double centre, double left, double right) {
  const double half = filter.width / 2;
  if (filter.type == PixelFilter::Type::box)
    return std::max(0.0, std::min(right, centre + half) - std::max(left, centre - half));
  return (right - left) * filter_value(filter, (left + right) / 2 - centre);
}

}  // namespace

double usual_width(PixelFilter::Type type) {
  switch (type) {
    case PixelFilter::Type::box:
      return 1;
    case PixelFilter::Type::gaussian:
      return 2;
    case PixelFilter::Type::mitchell:
      return 4;
  }
  return 1;
}

double filter_value(const PixelFilter& filter, double x) {
  if (std::abs(x) > filter.width / 2) return 0;
  switch (filter.type) {
    case PixelFilter::Type::box:
      return 1;
    case PixelFilter::Type::gaussian:
      return std::exp(-8 * x * x / (filter.width * filter.width));
    case PixelFilter::Type::mitchell:
      return mitchell(4 * std::abs(x) / filter.width);
  }
  return 0;
}

bool is_identity(const PixelFilter& filter, int samples) {
  return samples == 1 && filter.type == PixelFilter::Type::box && filter.width <= 1;
}

FilterTable::FilterTable(const PixelFilter& filter, int pixels, int samples) {
  for (int pixel = 0; pixel < pixels; ++pixel) {
    const double centre = pixel + 0.5, half = filter.width / 2;
    const int first = std::max(0, static_cast<int>(std::floor((centre - half) * samples))),
              last = std::min(pixels * samples, static_cast<int>(std::ceil((centre + half) * samples)));
    std::vector<double> weights;
    double sum = 0;
    for (int i = first; i < last; ++i) {
      weights.push_back(
          taken_in(filter, centre, static_cast<double>(i) / samples, static_cast<double>(i + 1) / samples));
      sum += weights.back();
    }
    Taps taps{static_cast<std::size_t>(first), {}};
    for (const double weight : weights) taps.weights.push_back(static_cast<float>(weight / sum));
    taps_.push_back(std::move(taps));
  }
}

void filter_line(const FilterTable& table, const Rgbx* samples, Rgbx* pixels) {
  for (std::size_t pixel = 0; pixel < table.pixels(); ++pixel) {
    Rgbx sum;
    table.for_each_sample(pixel, [&](float weight, std::size_t i) { add(sum, weight, samples[i]); });
    pixels[pixel] = sum;
  }
}

void filter_columns(const FilterTable& table, std::size_t row, const Rgbx* samples, std::size_t width,
                    Rgbx* pixels) {
  std::fill_n(pixels, width, Rgbx{});
  table.for_each_sample(row, [&](float weight, std::size_t line) {
    for (std::size_t i = 0; i < width; ++i) add(pixels[i], weight, samples[line * width + i]);
  });
}

}  // namespace nullcone::postrender
