#include "apps/view/inspect.h"

#include "apps/info.h"
#include "apps/view/spectra.h"

namespace nullcone::view {

nlohmann::ordered_json inspect_pixel(const Dataset& dataset, const postrender::Look& look, int x, int y) {
  nlohmann::ordered_json out = pixel_records(dataset, x, y);
  const Manifest& m = dataset.manifest;
  const std::size_t row = static_cast<std::size_t>(y - m.first_line), column = static_cast<std::size_t>(x);
  const std::size_t pixel = row * static_cast<std::size_t>(m.width) + column;
  out["spectra"] = spectra_of(dataset, look, dataset.hits.offset[pixel], dataset.hits.offset[pixel + 1]);
  return out;
}

}  // namespace nullcone::view
