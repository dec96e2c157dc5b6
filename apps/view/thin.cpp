#include "apps/view/thin.h"

#include <tbb/blocked_range.h>
#include <tbb/parallel_for.h>

#include <algorithm>
#include <functional>
#include <numeric>

#include "core/base/error.h"

namespace nullcone::view {

namespace {

/// Which pixels, and which of their samples, go into the copy.
class Choice {
 public:
  Choice(const Manifest& from, int step)
      : width_(static_cast<std::size_t>(from.width)),
        columns_(static_cast<std::size_t>(thinned(from.width, step))),
        rows_(static_cast<std::size_t>(thinned(from.lines, step))),
        step_(static_cast<std::size_t>(step)),
        lines_(static_cast<std::size_t>(from.lines)),
        samples_(static_cast<std::size_t>(from.samples)) {}

  std::size_t columns() const { return columns_; }
  std::size_t rows() const { return rows_; }
  std::size_t pixel(std::size_t row, std::size_t column) const {
    return line(row) * width_ + at(column, width_);
  }
  std::size_t line(std::size_t row) const { return at(row, lines_); }
  /// Nearest the centre; of four equally near ones the upper left.
  std::uint32_t sample() const { return static_cast<std::uint32_t>(middle() * samples_ + middle()); }
  bool one_sample() const { return samples_ == 1; }
  std::size_t ray(std::size_t row, std::size_t column) const {
    return (line(row) * samples_ + middle()) * width_ * samples_ + at(column, width_) * samples_ + middle();
  }

 private:
  std::size_t at(std::size_t i, std::size_t count) const {
    return std::min(step_ / 2 + i * step_, count - 1);
  }
  std::size_t middle() const { return (samples_ - 1) / 2; }

  std::size_t width_, columns_, rows_, step_, lines_, samples_;
};

/// f(row, column, number of the pixel in the copy), on all threads.
template <class F>
void for_each_pixel(const Choice& choice, F&& f) {
  tbb::parallel_for(tbb::blocked_range<std::size_t>(0, choice.rows(), 16), [&](const auto& rows) {
    for (std::size_t row = rows.begin(); row < rows.end(); ++row)
      for (std::size_t column = 0; column < choice.columns(); ++column)
        f(row, column, row * choice.columns() + column);
  });
}

/// Calls f(crossing) for the crossings that the copy keeps of a pixel.
template <class F>
void for_each_kept(const Hits& hits, const Choice& choice, std::size_t pixel, F&& f) {
  for (std::size_t hit = hits.offset[pixel]; hit < hits.offset[pixel + 1]; ++hit)
    if (choice.one_sample() || hits.sample[hit] == choice.sample()) f(hit);
}

/// Of all columns of a table, to[i] = from[places[i]]: one column a task, for it is the first touch of new
/// memory that takes the time.
template <class Table>
void gather(const Table& from, const std::vector<std::size_t>& places, Table& to) {
  std::vector<std::function<void()>> tasks;
  for_each_channel(
      [&](const ChannelInfo&, auto& copy, const auto& column) {
        if (column.empty()) return;  // not read
        tasks.emplace_back([&] {
          copy.resize(places.size());
          for (std::size_t i = 0; i < places.size(); ++i) copy[i] = column[places[i]];
        });
      },
      to, from);
  tbb::parallel_for(std::size_t{0}, tasks.size(), [&](std::size_t i) { tasks[i](); });
}

Hits thin_hits(const Hits& hits, const Choice& choice) {
  Hits out = empty_like(hits);
  // Step 1: how many crossings each pixel keeps, and so where they will stand.
  out.offset.assign(choice.rows() * choice.columns() + 1, 0);
  for_each_pixel(choice, [&](std::size_t row, std::size_t column, std::size_t pixel) {
    for_each_kept(hits, choice, choice.pixel(row, column), [&](std::size_t) { ++out.offset[pixel + 1]; });
  });
  std::partial_sum(out.offset.begin(), out.offset.end(), out.offset.begin());
  // Step 2: where they stand now.
  std::vector<std::size_t> places(out.count());
  for_each_pixel(choice, [&](std::size_t row, std::size_t column, std::size_t pixel) {
    std::size_t next = out.offset[pixel];
    for_each_kept(hits, choice, choice.pixel(row, column), [&](std::size_t hit) { places[next++] = hit; });
  });
  // Step 3: column by column.
  gather(hits, places, out);
  std::ranges::fill(out.sample, 0);
  return out;
}

Rays thin_rays(const Rays& rays, const Choice& choice) {
  Rays out;
  std::vector<std::size_t> places(choice.rows() * choice.columns());
  for_each_pixel(choice, [&](std::size_t row, std::size_t column, std::size_t pixel) {
    places[pixel] = choice.ray(row, column);
  });
  gather(rays, places, out);
  return out;
}

Manifest thin_manifest(const Manifest& manifest, const Choice& choice, int step) {
  Manifest out = manifest;
  out.width = static_cast<int>(choice.columns());
  out.lines = static_cast<int>(choice.rows());
  out.first_line = manifest.first_line / step;
  out.height = std::max(thinned(manifest.height, step), out.first_line + out.lines);
  out.traced_lines = 0;
  while (out.traced_lines < out.lines && choice.line(static_cast<std::size_t>(out.traced_lines)) <
                                             static_cast<std::size_t>(std::max(manifest.traced_lines, 0)))
    ++out.traced_lines;
  out.samples = 1;
  return out;
}

}  // namespace

int thinned(int count, int step) { return std::max((count - step / 2 + step - 1) / step, 1); }

Dataset thin(const Dataset& dataset, int step) {
  const Manifest& manifest = dataset.manifest;
  if (step < 1 || step > 1024) throw InputError("step", "expected 1 to 1024");
  if (manifest.samples > 1 && !dataset.hits.channels.has("sample"))
    throw InputError("dataset", "has no channel 'sample'; expected it where a pixel has several samples");
  const Choice choice(manifest, step);
  Dataset out{thin_manifest(manifest, choice, step), thin_hits(dataset.hits, choice),
              thin_rays(dataset.rays, choice)};
  for (std::vector<float>& changes : out.hits.duv)
    for (float& change : changes) change *= static_cast<float>(step);
  return out;
}

}  // namespace nullcone::view
