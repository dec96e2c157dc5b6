// The flat companion of a dataset, for programs that do not read deep pictures.
#pragma once

#include <string>

namespace nullcone {

inline constexpr int kDefaultRanks = 6;

/// Writes one flat scan line picture of the window of the dataset `data`: a crossing a pixel, the quality of
/// the worst ray, and Cryptomatte layers with up to `ranks` objects a pixel (docs/format.md, companions).
/// Holds a few scan lines at a time. Throws InputError for the dataset or the name, WorkError where it cannot
/// be written.
void write_flat(const std::string& data, const std::string& output, int ranks = kDefaultRanks);

}  // namespace nullcone
