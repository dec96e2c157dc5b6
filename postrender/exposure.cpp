#include "postrender/exposure.h"

#include <tbb/blocked_range.h>
#include <tbb/enumerable_thread_specific.h>
#include <tbb/parallel_for.h>

#include <algorithm>
#include <array>
#include <bit>
#include <cmath>
#include <limits>

#include "postrender/color.h"

namespace nullcone::postrender {

namespace {

constexpr std::size_t kBlock = 8192;  ///< pixels: what one task works on

/// Calls work(block, luminance) for the luminances of all lit pixels, block by block.
template <class Begin>
void for_each_block(const std::vector<Rgbx>& light, Begin&& begin) {
  const std::size_t blocks = (light.size() + kBlock - 1) / kBlock;
  tbb::parallel_for(tbb::blocked_range<std::size_t>(0, blocks), [&](const auto& range) {
    for (std::size_t block = range.begin(); block < range.end(); ++block) {
      auto&& add = begin(block);
      for (std::size_t i = block * kBlock; i < std::min(light.size(), (block + 1) * kBlock); ++i)
        if (const float Y = luminance(light[i]); Y > 0 && Y <= std::numeric_limits<float>::max()) add(Y);
    }
  });
}

using Histogram = std::vector<std::uint32_t>;
constexpr int kHalf = 16;
constexpr std::uint32_t kLowHalf = 0xffff;

std::uint32_t bits_of(float x) { return std::bit_cast<std::uint32_t>(x); }

/// How many luminances have each value of bin(Y) < 2^16; none where it is not.
template <class Bin>
Histogram counted(const std::vector<Rgbx>& light, Bin&& bin) {
  tbb::enumerable_thread_specific<Histogram> parts([] { return Histogram(kLowHalf + 1); });
  for_each_block(light, [&](std::size_t) {
    return [&bin, &counts = parts.local()](float Y) {
      if (const std::uint32_t at = bin(Y); at <= kLowHalf) ++counts[at];
    };
  });
  Histogram out(kLowHalf + 1);
  for (const Histogram& part : parts) std::ranges::transform(out, part, out.begin(), std::plus{});
  return out;
}

/// The bin that holds the number at `position` in sorted order, which becomes its position in the bin.
std::uint32_t bin_at(const Histogram& counts, std::size_t& position) {
  std::uint32_t bin = 0;
  while (position >= counts[bin]) position -= counts[bin++];
  return bin;
}

/// Positive floats are ordered as their bits are: first the upper half of the bits, then the lower.
double percentile(const std::vector<Rgbx>& light, double percent) {
  const Histogram upper = counted(light, [](float Y) { return bits_of(Y) >> kHalf; });
  std::size_t lit = 0;
  for (const std::uint32_t count : upper) lit += count;
  if (lit == 0) return 1;
  auto position = static_cast<std::size_t>(percent / 100 * static_cast<double>(lit - 1));
  const std::uint32_t high = bin_at(upper, position);
  const Histogram lower = counted(
      light, [high](float Y) { return bits_of(Y) >> kHalf == high ? bits_of(Y) & kLowHalf : kLowHalf + 1; });
  return static_cast<double>(std::bit_cast<float>(high << kHalf | bin_at(lower, position)));
}

/// A sum of logarithms as the logarithm of a product: exponents are added exactly, mantissas multiplied.
struct LogSum {
  double product = 1;
  std::int64_t exponents = 0;
  std::size_t count = 0;

  void add(float Y) {
    const auto bits = std::bit_cast<std::uint64_t>(static_cast<double>(Y));  // normal, as all floats here
    constexpr std::uint64_t kMantissa = (std::uint64_t{1} << 52) - 1, kOne = std::uint64_t{1023} << 52;
    exponents += static_cast<std::int64_t>(bits >> 52) - 1023;
    product *= std::bit_cast<double>((bits & kMantissa) | kOne);
    if (++count % 512 == 0) normalise();
  }
  void normalise() {
    int exponent = 0;
    product = std::frexp(product, &exponent);
    exponents += exponent;
  }
  double log2() const { return std::log2(product) + static_cast<double>(exponents); }
};

double geometric_mean(const std::vector<Rgbx>& light) {
  std::vector<LogSum> sums((light.size() + kBlock - 1) / kBlock);
  for_each_block(light, [&](std::size_t block) { return [&sum = sums[block]](float Y) { sum.add(Y); }; });
  double sum = 0;
  std::size_t count = 0;
  for (const LogSum& part : sums) {  // in the order of the picture, whoever made them
    sum += part.log2();
    count += part.count;
  }
  return count == 0 ? 0 : std::exp2(sum / static_cast<double>(count));
}

}  // namespace

double auto_white_cd_m2(const Radiance& radiance, const AutoWhite& exposure) {
  if (exposure.mode == AutoWhite::Mode::percentile) return percentile(radiance.physical, exposure.percentile);
  const double mean = geometric_mean(radiance.physical);
  return mean > 0 ? mean / exposure.key : 1;
}

}  // namespace nullcone::postrender
