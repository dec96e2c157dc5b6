#include "postrender/texture.h"

#include <algorithm>
#include <cmath>

namespace nullcone::postrender {

namespace {

/// Positions beyond this are as good as lost in float, and would not fit an int.
constexpr float kFarthest = 1e6f;

float finite_or_zero(float x) { return std::abs(x) < kFarthest ? x : 0.0f; }

/// Area averages of `count` items (a `stride` apart) to `fewer` items, along one axis.
struct Shrink {
  int from, to;
  template <class Read, class Write>
  void operator()(Read&& read, Write&& write) const {
    const double ratio = static_cast<double>(from) / to;
    for (int i = 0; i < to; ++i) {
      const double first = i * ratio, last = std::min((i + 1) * ratio, static_cast<double>(from));
      Rgb sum;
      for (int k = static_cast<int>(first); k < from && k < last; ++k) {
        const double weight = std::min(last, k + 1.0) - std::max(first, static_cast<double>(k));
        sum = sum + static_cast<float>(weight / ratio) * read(k);
      }
      write(i, sum);
    }
  }
};

TextureLevel halved(const TextureLevel& full) {
  const auto at = [](int i, int j, int width) {
    return static_cast<std::size_t>(j) * static_cast<std::size_t>(width) + static_cast<std::size_t>(i);
  };
  TextureLevel narrow{std::max(1, full.width / 2), full.height, {}};
  narrow.texels.resize(at(0, narrow.height, narrow.width));
  for (int j = 0; j < full.height; ++j)
    Shrink{full.width, narrow.width}([&](int i) { return full.texel(i, j); },
                                     [&](int i, Rgb c) { narrow.texels[at(i, j, narrow.width)] = c; });
  TextureLevel half{narrow.width, std::max(1, full.height / 2), {}};
  half.texels.resize(at(0, half.height, half.width));
  for (int i = 0; i < half.width; ++i)
    Shrink{full.height, half.height}([&](int j) { return narrow.texel(i, j); },
                                     [&](int j, Rgb c) { half.texels[at(i, j, half.width)] = c; });
  return half;
}

/// The mean of the square wave (-1)^floor(x) over [x - width/2, x + width/2]: its integral is a triangle
/// wave.
float square_wave_mean(float x, float width) {
  const float first = x - width / 2, last = x + width / 2;
  if (!(std::floor(first) < std::floor(last))) return std::fmod(std::floor(x), 2.0f) == 0.0f ? 1.0f : -1.0f;
  const auto triangle = [](float y) {
    const float phase = y - 2 * std::floor(y / 2);
    return phase < 1 ? phase : 2 - phase;
  };
  return std::clamp((triangle(last) - triangle(first)) / (last - first), -1.0f, 1.0f);
}

}  // namespace

Rgb TextureLevel::bilinear(float u, float v) const {
  u = finite_or_zero(u);
  v = finite_or_zero(v);
  // Step 1: the position in texels, wrapped and clamped.
  const float x = (u - std::floor(u)) * static_cast<float>(width) - 0.5f;
  const float y =
      std::clamp((1 - v) * static_cast<float>(height) - 0.5f, 0.0f, static_cast<float>(height - 1));
  const float left = std::floor(x);
  const float s = x - left;
  int i0 = static_cast<int>(left);
  if (i0 < 0) i0 = width - 1;
  if (i0 >= width) i0 = 0;
  const int i1 = i0 + 1 == width ? 0 : i0 + 1;
  const int j0 = static_cast<int>(y), j1 = std::min(j0 + 1, height - 1);
  // Step 2: the four neighbours.
  return mix(mix(texel(i0, j0), texel(i1, j0), s), mix(texel(i0, j1), texel(i1, j1), s),
             y - static_cast<float>(j0));
}

Rgb Pyramid::trilinear(float u, float v, const Footprint& f) const {
  const TextureLevel& full = levels.front();
  const auto w = static_cast<float>(full.width), h = static_cast<float>(full.height);
  const float right = f.u_right * f.u_right * w * w + f.v_right * f.v_right * h * h;
  const float down = f.u_down * f.u_down * w * w + f.v_down * f.v_down * h * h;
  const float longest = std::max(right, down);
  if (!(longest > 1)) return full.bilinear(u, v);
  const float level = std::min(0.5f * std::log2(longest), static_cast<float>(levels.size() - 1));
  const auto below = static_cast<std::size_t>(level);
  const std::size_t above = std::min(below + 1, levels.size() - 1);
  return mix(levels[below].bilinear(u, v), levels[above].bilinear(u, v), level - static_cast<float>(below));
}

std::size_t Pyramid::bytes() const {
  std::size_t sum = 0;
  for (const TextureLevel& level : levels) sum += level.texels.size() * sizeof(Rgb);
  return sum;
}

Pyramid make_pyramid(TextureLevel full) {
  Pyramid pyramid;
  pyramid.levels.push_back(std::move(full));
  while (pyramid.levels.back().width > 1 || pyramid.levels.back().height > 1)
    pyramid.levels.push_back(halved(pyramid.levels.back()));
  return pyramid;
}

Rgb CheckerboardTexture::operator()(float u, float v, const Footprint& f) const {
  u = finite_or_zero(u) - std::floor(finite_or_zero(u));
  // v = 1 belongs to the topmost squares.
  v = std::clamp(finite_or_zero(v), 0.0f, 1 - 1e-6f);
  const float wave = square_wave_mean(u * counts[0], counts[0] * (std::abs(f.u_right) + std::abs(f.u_down))) *
                     square_wave_mean(v * counts[1], counts[1] * (std::abs(f.v_right) + std::abs(f.v_down)));
  const float s = axis == 0 ? u : v;
  return mix(mix(odd[0], odd[1], s), mix(even[0], even[1], s), 0.5f + 0.5f * wave);
}

}  // namespace nullcone::postrender
