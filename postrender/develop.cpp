#include "postrender/develop.h"

#include <algorithm>
#include <cmath>

#include "postrender/color.h"

namespace nullcone::postrender {

double auto_white_cd_m2(const Radiance& radiance) {
  std::vector<float> lit;
  for (const Rgb c : radiance.physical)
    if (const float Y = luminance(c); Y > 0 && std::isfinite(Y)) lit.push_back(Y);
  if (lit.empty()) return 1;
  const auto at = lit.begin() + static_cast<std::ptrdiff_t>(0.99 * static_cast<double>(lit.size() - 1));
  std::nth_element(lit.begin(), at, lit.end());
  return static_cast<double>(*at);
}

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
    develop_segment(display + done, physical == nullptr ? nullptr : physical + done, first + done,
                    std::min(kSegment, count - done), image);
}

void LineDeveloper::develop_segment(const Rgbx* display, const Rgbx* physical, std::size_t first,
                                    std::size_t count, Image& image) {
  const Planes planes = {planes_[0].data(), planes_[1].data(), planes_[2].data()};
  const double gain = std::exp2(look_.ev);
  kernel_.expose(display, static_cast<float>(gain), physical, static_cast<float>(gain / image.white_cd_m2),
                 count, planes);
  if (!image.exposed.empty()) kernel_.interleave(planes, count, image.exposed.data() + first);
  if (look_.curve == DevelopLook::Curve::exponential)
    kernel_.exponential_curve(static_cast<float>(look_.k), count, planes);
  if (look_.gamut == DevelopLook::Gamut::hue_preserving) kernel_.desaturate(count, planes);
  if (look_.gamut == DevelopLook::Gamut::clip) kernel_.clip(count, planes);
  if (!image.display.empty()) kernel_.interleave(planes, count, image.display.data() + first);
  if (!image.encoded.empty())
    encode_srgb8({planes.r, count}, planes.g, planes.b, image.encoded.data() + 3 * first);
}

}  // namespace nullcone::postrender
