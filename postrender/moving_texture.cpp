#include "postrender/moving_texture.h"

#include <algorithm>
#include <array>

#include "core/base/faces.h"
#include "postrender/anisotropic.h"

namespace nullcone::postrender {

namespace {

/// Of a moving texture the first frame: all are of one kind.
template <class F>
auto ask(const Texture& texture, F&& f) {
  const auto* moving = std::get_if<MovingTexture>(&texture);
  if (moving != nullptr) return std::visit(f, moving->parts->frames.front());
  const auto still = [&](const auto& found) {
    if constexpr (requires { found.parts; }) {
      return decltype(f(ColorTexture{})){};
    } else {
      return f(found);
    }
  };
  return std::visit(still, texture);
}

struct NeedsFootprint {
  bool operator()(const ColorTexture&) const { return false; }
  bool operator()(const CheckerboardTexture&) const { return true; }
  bool operator()(const ImageTexture& image) const { return image.filter != Filter::bilinear; }
  bool operator()(const CubeTexture& cube) const { return cube.filter != Filter::bilinear; }
};

struct HasAlpha {
  bool operator()(const ColorTexture&) const { return false; }
  bool operator()(const CheckerboardTexture&) const { return false; }
  bool operator()(const ImageTexture& image) const { return image.alpha; }
  bool operator()(const CubeTexture&) const { return false; }
};

/// Pixels [first, first + count) of a run.
Run part_of(const Run& run, std::size_t first, std::size_t count) {
  const Footprints& f = run.footprints;
  Run out = {count, run.u + first, run.v + first, nullptr, nullptr, {}};
  if (f.u_right != nullptr)
    out.footprints = {f.u_right + first, f.v_right + first, f.u_down + first, f.v_down + first};
  return out;
}

/// The faces' own axes.
constexpr std::array<CubeFaceView, 6> cube_views() {
  std::array<CubeFaceView, 6> out{};
  for (std::size_t i = 0; i < 6; ++i)
    for (std::size_t c = 0; c < 3; ++c) {
      const host::Face& face = host::kCube.face[i];
      out[i].right[c] = static_cast<float>(face.right.c[c] / 2);
      out[i].down[c] = static_cast<float>(face.down.c[c] / 2);
      out[i].ahead[c] = static_cast<float>(face.corner.c[c] + (face.right.c[c] + face.down.c[c]) / 2);
    }
  return out;
}
constexpr std::array<CubeFaceView, 6> kCubeViews = cube_views();

struct TextureColors {
  const Kernel& kernel;
  const Run& run;
  std::span<const Times> times;
  bool recorded;
  Rgbx* out;

  void operator()(const ColorTexture& texture) const { std::fill_n(out, run.count, Rgbx{texture.color}); }
  void operator()(const CheckerboardTexture& texture) const { kernel.checkerboard(texture, run, out); }
  void operator()(const ImageTexture& texture) const {
    const Pyramid& image = *texture.image;
    const ImageView view = {image.levels.data(), static_cast<float>(image.levels.size() - 1),
                            image.texels.data(), image.unit,
                            texture.uv,          texture.filter != Filter::bilinear};
    if (texture.filter == Filter::anisotropic) {
      anisotropic_colors(kernel, view, run, out);
    } else {
      kernel.image(view, run, out);
    }
  }
  void operator()(const CubeTexture& texture) const {
    const Pyramid& faces = *texture.faces;
    CubeView view = {{},
                     faces.levels.data(),
                     static_cast<float>(faces.levels.size() / 6 - 1),
                     faces.texels.data(),
                     faces.unit,
                     texture.filter != Filter::bilinear,
                     recorded};
    std::ranges::copy(kCubeViews, view.faces);
    kernel.cube(view, run, out);
  }
  void operator()(const MovingTexture& texture) const {
    if (!texture.parts->placement) return frames_of(*texture.parts, run);
    std::array<float, kSegment> u, v;
    std::copy_n(run.u, run.count, u.begin());
    std::copy_n(run.v, run.count, v.begin());
    const bool steps = needs_footprint(texture);
    place(*texture.parts->placement, times,
          {run.count, u.data(), v.data(), steps ? run.footprints : Footprints{}, recorded});
    Run placed = run;
    placed.u = u.data();
    placed.v = v.data();
    frames_of(*texture.parts, placed);
  }

 private:
  /// Frame by frame: neighbouring pixels mostly see the same one, or the same two.
  void frames_of(const MovingTexture::Parts& parts, const Run& all) const {
    if (parts.frames.size() == 1) return frame(parts.frames.front(), all, out);
    std::array<Timeline::Place, kSegment> places;
    for (std::size_t i = 0; i < all.count; ++i)
      places[i] = parts.timeline.at(times.empty() ? Times{} : times[i]);
    std::array<Rgbx, kSegment> next;
    for (std::size_t first = 0, last = 0; first < all.count; first = last) {
      const auto [from, to, share] = places[first];
      while (last < all.count && places[last].first == from && places[last].second == to) ++last;
      const Run part = part_of(all, first, last - first);
      frame(parts.frames[from], part, out + first);
      if (to == from) continue;
      frame(parts.frames[to], part, next.data());
      for (std::size_t i = first; i < last; ++i) blend(out[i], next[i - first], places[i].share);
    }
  }
  void frame(const StillTexture& texture, const Run& part, Rgbx* colors) const {
    std::visit(TextureColors{kernel, part, {}, recorded, colors}, texture);
  }
  static void blend(Rgbx& a, const Rgbx& b, float share) {
    const float alpha = a.idle + share * (b.idle - a.idle);
    a = mix(static_cast<Rgb>(a), static_cast<Rgb>(b), share);
    a.idle = alpha;
  }
};

}  // namespace

bool needs_footprint(const Texture& texture) { return ask(texture, NeedsFootprint{}); }

bool has_alpha(const Texture& texture) { return ask(texture, HasAlpha{}); }

Clocks clocks_of(const Texture& texture) {
  Clocks out;
  if (const auto* moving = std::get_if<MovingTexture>(&texture)) {
    if (moving->parts->placement) out = moving->parts->placement->clocks();
    if (moving->parts->frames.size() > 1) out.add(moving->parts->timeline.clock);
  }
  return out;
}

void look_up(const Kernel& kernel, const Texture& texture, const Run& run, std::span<const Times> times,
             bool recorded, Rgbx* out) {
  std::visit(TextureColors{kernel, run, times, recorded, out}, texture);
}

}  // namespace nullcone::postrender
