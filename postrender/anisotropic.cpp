#include "postrender/anisotropic.h"

#include <algorithm>
#include <cmath>

namespace nullcone::postrender {

namespace {

/// The axes of the ellipse into which two steps take the unit circle.
struct Axes {
  double longer, shorter;  ///< their lengths
  double x, y;             ///< the direction of the longer one
};

Axes axes_of(double right_x, double right_y, double down_x, double down_y) {
  // The longer axis is the first eigenvector of [[a, b], [b, c]].
  const double a = right_x * right_x + down_x * down_x, b = right_x * right_y + down_x * down_y,
               c = right_y * right_y + down_y * down_y;
  if (!std::isfinite(a + c)) return {};  // beside what is not finite itself
  const double middle = (a + c) / 2, half = (a - c) / 2, spread = std::sqrt(half * half + b * b);
  const double longer = std::sqrt(middle + spread);
  const double area = std::abs(right_x * down_y - right_y * down_x);
  // Of the two ways to write the eigenvector the one without cancellation.
  double x = half >= 0 ? half + spread : b, y = half >= 0 ? b : spread - half;
  const double length = std::hypot(x, y);
  if (length > 0) {
    x /= length;
    y /= length;
  }
  return {longer, longer > 0 ? area / longer : 0, x, y};
}

/// Look-ups that go through the kernel together, and whose they are.
class Probes {
 public:
  Probes(const Kernel& kernel, const ImageView& image, Rgbx* out)
      : kernel_(kernel), image_(image), out_(out) {}

  void add(std::size_t pixel, double u, double v, double width, double share) {
    if (count_ == kSegment) flush();
    u_[count_] = static_cast<float>(u);
    v_[count_] = static_cast<float>(v);
    (across_ ? du_ : dv_)[count_] = static_cast<float>(width);
    share_[count_] = static_cast<float>(share);
    pixel_[count_++] = pixel;
  }
  void flush() {
    kernel_.image(image_,
                  {count_,
                   u_.data(),
                   v_.data(),
                   nullptr,
                   nullptr,
                   {du_.data(), dv_.data(), none_.data(), none_.data()}},
                  colors_.data());
    for (std::size_t i = 0; i < count_; ++i) {
      Rgbx& sum = out_[pixel_[i]];
      const Rgbx& color = colors_[i];
      const float share = share_[i];
      sum.r += share * color.r;
      sum.g += share * color.g;
      sum.b += share * color.b;
      sum.idle += share * color.idle;
    }
    count_ = 0;
  }

 private:
  const Kernel& kernel_;
  const ImageView& image_;
  Rgbx* out_;
  const bool across_ = image_.uv.scale[0] != 0;  ///< widths are told along u; else along v
  std::size_t count_ = 0;
  std::array<float, kSegment> u_, v_, du_{}, dv_{}, none_{}, share_;
  std::array<std::size_t, kSegment> pixel_;
  std::array<Rgbx, kSegment> colors_;
};

}  // namespace

void anisotropic_colors(const Kernel& kernel, const ImageView& image, const Run& run, Rgbx* out) {
  std::fill_n(out, run.count, Rgbx{});
  // Texels a unit of u and of v.
  const double width = static_cast<double>(image.levels[0].width) * static_cast<double>(image.uv.scale[0]);
  const double height = static_cast<double>(image.levels[0].height) * static_cast<double>(image.uv.scale[1]);
  const double unit = std::abs(width != 0 ? width : height != 0 ? height : 1);
  Probes probes(kernel, image, out);
  for (std::size_t i = 0; i < run.count; ++i) {
    const auto texels = [i](const float* step, double scale) { return static_cast<double>(step[i]) * scale; };
    const Axes axes = axes_of(texels(run.footprints.u_right, width), texels(run.footprints.v_right, height),
                              texels(run.footprints.u_down, width), texels(run.footprints.v_down, height));
    const double ratio = axes.longer / std::max(axes.shorter, 1.0);  // below a texel there is nothing to see
    const int count = ratio > 1 ? static_cast<int>(std::ceil(std::min(ratio, double{kMostProbes}))) : 1;
    const double thick = std::max({axes.shorter, axes.longer / kMostProbes, 1.0}) / unit;
    const double along_u = width != 0 ? axes.x * axes.longer / width : 0,
                 along_v = height != 0 ? axes.y * axes.longer / height : 0;
    const auto u = static_cast<double>(run.u[i]), v = static_cast<double>(run.v[i]);
    for (int k = 0; k < count; ++k) {
      const double s = (k + 0.5) / count - 0.5;
      probes.add(i, u + s * along_u, v + s * along_v, thick, 1.0 / count);
    }
  }
  probes.flush();
}

}  // namespace nullcone::postrender
