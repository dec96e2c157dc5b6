#include "postrender/develop.h"

#include <algorithm>
#include <cmath>
#include <limits>

#include "postrender/color.h"

namespace nullcone::postrender {

namespace {

std::optional<std::array<Rgb, 3>> rows_of(const std::optional<Matrix3>& matrix) {
  if (!matrix) return {};
  std::array<Rgb, 3> out;
  for (std::size_t i = 0; i < 3; ++i) {
    const auto& [r, g, b] = (*matrix)[i];
    out[i] = {static_cast<float>(r), static_cast<float>(g), static_cast<float>(b)};
  }
  return out;
}

float as_gain(double x) {
  return static_cast<float>(std::min(x, static_cast<double>(std::numeric_limits<float>::max())));
}

}  // namespace

LineDeveloper::LineDeveloper(const DevelopLook& look, const Kernel& kernel)
    : look_(look),
      kernel_(kernel),
      matrix_(rows_of(output_matrix(look.output.space, look.white_point))),
      weights_(luminance_weights(look.output.space)),
      filmic_(hable_curve(look.filmic_white)) {}

void set_size(Image& image, int width, int height, const ImageParts& parts) {
  const std::size_t pixels = static_cast<std::size_t>(width) * static_cast<std::size_t>(height);
  image.width = width;
  image.height = height;
  image.exposed.resize(parts.exposed ? pixels : 0);
  image.display.resize(parts.display ? pixels : 0);
  image.encoded.resize(parts.encoded ? 3 * pixels : 0);
}

void LineDeveloper::develop(const Rgbx* display, const Rgbx* physical, std::size_t first, std::size_t count,
                            Image& image) {
  for (std::size_t done = 0; done < count; done += kSegment)
    develop_segment(display == nullptr ? nullptr : display + done,
                    physical == nullptr ? nullptr : physical + done, first + done,
                    std::min(kSegment, count - done), image);
}

void LineDeveloper::develop_segment(const Rgbx* display, const Rgbx* physical, std::size_t first,
                                    std::size_t count, Image& image) {
  const Planes planes = {planes_[0].data(), planes_[1].data(), planes_[2].data()};
  const double gain = std::exp2(look_.ev);
  const Exposure exposure = {as_gain(gain), as_gain(gain / image.white_cd_m2),
                             matrix_ ? matrix_->data() : nullptr};
  if (display == nullptr) {
    kernel_.expose(physical, nullptr, {exposure.physical_gain, 0, exposure.matrix}, count, planes);
  } else {
    kernel_.expose(display, physical, exposure, count, planes);
  }
  if (!image.exposed.empty()) kernel_.interleave(planes, count, image.exposed.data() + first);
  if (image.display.empty() && image.encoded.empty()) return;
  apply_curve(count, planes);
  if (look_.gamut == DevelopLook::Gamut::hue_preserving) kernel_.desaturate(weights_, count, planes);
  if (look_.gamut == DevelopLook::Gamut::clip) kernel_.clip(count, planes);
  if (!image.display.empty()) kernel_.interleave(planes, count, image.display.data() + first);
  if (!image.encoded.empty())
    kernel_.encode_srgb8(Srgb8Table::instance().entries.data(), planes, count,
                         image.encoded.data() + 3 * first);
}

void LineDeveloper::apply_curve(std::size_t count, const Planes& planes) const {
  switch (look_.curve) {
    case DevelopLook::Curve::linear:
      return;
    case DevelopLook::Curve::exponential:
      return kernel_.exponential_curve(static_cast<float>(look_.k), weights_, count, planes);
    case DevelopLook::Curve::filmic:
      return kernel_.filmic_curve(filmic_, weights_, count, planes);
    case DevelopLook::Curve::table:
      return kernel_.table_curve(look_.table.view(), weights_, count, planes);
  }
}

}  // namespace nullcone::postrender
