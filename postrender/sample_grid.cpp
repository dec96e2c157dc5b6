#include "postrender/sample_grid.h"

#include <numeric>
#include <string>

#include "core/base/error.h"

namespace nullcone::postrender {

namespace {

/// The ray of each crossing, by its place in the grid of samples.
std::vector<std::uint32_t> rays_of(const Dataset& dataset) {
  const auto n = static_cast<std::uint32_t>(dataset.manifest.samples);
  const auto width = static_cast<std::size_t>(dataset.manifest.width);
  const Hits& hits = dataset.hits;
  std::vector<std::uint32_t> out(hits.count());
  for (std::size_t pixel = 0; pixel < dataset.pixels(); ++pixel)
    for (std::size_t hit = hits.offset[pixel]; hit < hits.offset[pixel + 1]; ++hit) {
      const std::uint32_t sample = hits.sample[hit];
      if (sample >= n * n)
        throw InputError("dataset", "a crossing names sample " + std::to_string(sample) + "; expected 0 to " +
                                        std::to_string(n * n - 1));
      const std::size_t row = pixel / width * n + sample / n, column = pixel % width * n + sample % n;
      out[hit] = static_cast<std::uint32_t>(row * width * n + column);
    }
  return out;
}

}  // namespace

Dataset by_samples(Dataset dataset) {
  const int n = dataset.manifest.samples;
  if (n == 1) return dataset;
  Hits& hits = dataset.hits;
  if (!hits.channels.has("sample"))
    throw InputError("dataset", "has no channel 'sample'; expected it where a pixel has several samples");
  const std::vector<std::uint32_t> rays = rays_of(dataset);
  // Step 1: where the crossings of each ray will stand, in the order in which they come.
  std::vector<std::uint64_t> offset(dataset.manifest.rays() + 1);
  for (const std::uint32_t ray : rays) ++offset[ray + std::size_t{1}];
  std::partial_sum(offset.begin(), offset.end(), offset.begin());
  std::vector<std::uint64_t> next(offset.begin(), offset.end() - 1), place(rays.size());
  for (std::size_t hit = 0; hit < rays.size(); ++hit) place[hit] = next[rays[hit]]++;
  // Step 2: column by column, so that only one of them is there twice.
  for_each_channel(
      [&](const ChannelInfo&, auto& column) {
        auto moved = column;
        for (std::size_t hit = 0; hit < place.size(); ++hit) moved[place[hit]] = column[hit];
        column.swap(moved);
      },
      hits);
  for (std::vector<float>& steps : hits.duv)
    for (float& step : steps) step /= static_cast<float>(n);
  // Step 3: a picture of its own.
  hits.offset = std::move(offset);
  dataset.rays = {};
  Manifest& manifest = dataset.manifest;
  manifest.width *= n;
  manifest.height *= n;
  manifest.first_line *= n;
  manifest.lines *= n;
  manifest.traced_lines *= n;
  manifest.samples = 1;
  return dataset;
}

}  // namespace nullcone::postrender
