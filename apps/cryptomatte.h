// Cryptomatte 1.1.0 (Friedman & Jones 2015, specification by Psyop): which object covers how much of a pixel,
// with names as hashes, so that compositing programs can pick objects by name.
#pragma once

#include <cstdint>
#include <string>
#include <string_view>
#include <utility>
#include <vector>

#include "core/record/dataset.h"

namespace nullcone {

/// MurmurHash3_x86_32 of the name with seed 0; a bit of the exponent is flipped where the number, taken for a
/// float, would be denormal, infinite or not a number.
std::uint32_t cryptomatte_hash(std::string_view name);

/// Attributes of the header by which readers find the layer: {name, value}.
std::vector<std::pair<std::string, std::string>> cryptomatte_attributes(
    const std::string& layer, const std::vector<ObjectEntry>& objects);

/// An object, by its number from 1, and the share of the pixel that it covers.
struct Coverage {
  std::uint32_t id;
  double share;
};

/// What covers pixels. Every ray weighs the same, and along a ray each crossing hides its opacity of what is
/// left.
class Coverages {
 public:
  /// Throws InputError where crossings cannot be told apart by rays.
  Coverages(const Manifest& manifest, const std::string& place);
  /// The objects that cover a pixel of `hits`, greatest share first; valid until the next call.
  const std::vector<Coverage>& of(const Hits& hits, std::size_t pixel) &;

 private:
  void add(std::uint32_t id, double share);

  std::size_t objects_;
  std::vector<double> left_;  ///< of each ray: what has not been hidden yet
  std::vector<Coverage> found_;
};

}  // namespace nullcone
