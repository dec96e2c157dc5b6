// The pixel loops of post-rendering, compiled once for each instruction set (kernel.cpp) and chosen at run
// time. All give the same bits. They work on runs: neighbouring pixels of a scan line that look alike.
#pragma once

#include <array>
#include <cstddef>
#include <cstdint>
#include <span>
#include <string_view>

#include "postrender/color.h"
#include "postrender/image.h"
#include "postrender/spectral_view.h"
#include "postrender/texture.h"

namespace nullcone::postrender {

/// Crossings of the same rank along a scan line, one a column; `id` is 0 where a pixel has none.
struct Layer {
  const std::uint32_t *id, *order;
  const float *u, *v, *shift, *opacity;
  std::array<const float*, 4> duv = {};  ///< du/dx, dv/dx, du/dy, dv/dy; null where they are not recorded
};

/// How far (u, v) moves from one pixel to the next, to the right and down; signs mean nothing.
struct Footprints {
  float *u_right, *v_right, *u_down, *v_down;
};

/// What shading reads of a run of pixels.
struct Run {
  std::size_t count;
  const float *u, *v, *shift;
  const float* weight;  ///< transmittance in front of it times its opacity
  Footprints footprints;
};

struct ImageView {
  const LevelView* levels;
  float last_level;
  const Texel* texels;
  float unit;
  UvTransform uv;
  bool mipmap;
};

/// Components of a direction on a face of a cube: to the right, down, and through its middle; of length 1.
struct CubeFaceView {
  float right[3], down[3], ahead[3];
};

struct CubeView {
  CubeFaceView faces[6];
  const LevelView* levels;  ///< face by face, with a border of one texel
  float last_level;
  const Texel* texels;
  float unit;
  bool mipmap, recorded;  ///< `recorded`: steps are derivatives; else differences to neighbours
};

/// Pixels that light is added to: sum += weight * what is seen, by g, of a surface that is coloured so.
struct Lit {
  std::size_t count;
  const float *g, *weight;
  const Rgbx* colors;
  Rgbx* sum;
};

/// The appearance of a pixel without a crossing, or behind an opaque one.
inline constexpr std::uint32_t kUnseen = 0xffffffff;

/// Three components of a run of pixels.
struct Planes {
  float *r, *g, *b;
};

/// No exposed component is greater: far beyond all light, and far enough from where float ends.
inline constexpr float kBrightest = 1e36f;

/// colour = gain * display + physical_gain * physical, then through the matrix (three rows), unless null.
struct Exposure {
  float gain, physical_gain;
  const Rgb* matrix;
};

/// Y -> Y (a1 x + a0) / ((b2 x + b1) x + b0) with x = stretch Y; 1 from `white` on.
struct FilmicCurve {
  float a1, a0, b2, b1, b0, stretch, white;
};

/// Nodes of a ToneTable stand where the upper bits of a float luminance change: 2^kToneNodeBits an octave.
inline constexpr int kToneNodeBits = 9, kToneShift = 23 - kToneNodeBits;
struct ToneTableView {
  const float* nodes;
  std::int32_t first;  ///< upper bits of the first node's luminance
  float lowest, highest;
};

/// Pixels that go through all steps together, so that what passes from step to step stays in the first cache.
inline constexpr std::size_t kSegment = 256;

/// Functions of one instruction set.
struct Kernel {
  std::string_view isa;
  /// Of at most kSegment pixels from column `first` on of the middle one of three scan lines: see
  /// kernel_footprint.h.
  void (*footprints)(const std::array<Layer, 3>& lines, std::size_t width, std::size_t first,
                     std::size_t count, const Footprints& out);
  /// The same from what the middle line has recorded in `duv`.
  void (*recorded_footprints)(const Layer& line, std::size_t first, std::size_t count, const Footprints& out);
  /// Weights of the crossings of a rank, and what shines through to the next one: false if nothing does
  /// anywhere. Pixels that are not seen any more lose their appearance.
  bool (*weigh)(const float* opacity, std::size_t count, float* transmittance, float* weight,
                std::uint32_t* appearance);
  // The texture's colours along a run, of images also the alpha (colours are multiplied by it).
  void (*image)(const ImageView& image, const Run& run, Rgbx* out);
  void (*cube)(const CubeView& cube, const Run& run, Rgbx* out);
  void (*checkerboard)(const CheckerboardTexture& board, const Run& run, Rgbx* out);
  // Light: colours as they are; filters before one spectrum; amounts of three spectra; lines behind filters.
  void (*plain)(const Lit& lit);
  void (*filtered)(const TableView& table, const Lit& lit);
  void (*mixed)(const TableView& table, const Lit& lit);
  void (*lines)(const LinesView& lines, const Lit& lit);
  /// The light of a lamp, also by the ratio on its way to the surface, behind filters.
  void (*reflected)(const LitTableView& table, const float* g_light, const Lit& lit);
  /// sum += transmittance * color.
  void (*background)(const float* transmittance, const Rgbx& color, std::size_t count, Rgbx* sum);
  // Development, in place but for the first and the last step.
  // `physical` may be null; `weights` make luminances of components. What is exposed is at most kBrightest,
  // and black where radiance is not a number.
  void (*expose)(const Rgbx* display, const Rgbx* physical, const Exposure& by, std::size_t count,
                 const Planes& out);
  void (*exponential_curve)(float k, const Rgb& weights, std::size_t count, const Planes& colors);
  void (*filmic_curve)(const FilmicCurve& curve, const Rgb& weights, std::size_t count, const Planes& colors);
  void (*table_curve)(const ToneTableView& table, const Rgb& weights, std::size_t count,
                      const Planes& colors);
  void (*desaturate)(const Rgb& weights, std::size_t count, const Planes& colors);
  void (*clip)(std::size_t count, const Planes& colors);
  /// At most kSegment colours, with the entries of Srgb8Table.
  void (*encode_srgb8)(const std::uint32_t* table, const Planes& colors, std::size_t count,
                       std::uint8_t* out);
  void (*interleave)(const Planes& colors, std::size_t count, Rgb* out);
};

/// All that this machine can run, the widest first.
std::span<const Kernel* const> kernels();

}  // namespace nullcone::postrender
