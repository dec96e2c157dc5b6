#include "postrender/layers.h"

#include <algorithm>
#include <limits>
#include <string_view>

namespace nullcone::postrender {

namespace {

constexpr std::size_t kNowhere = std::numeric_limits<std::size_t>::max();

/// Where the columns begin; null for channels that the dataset does not have.
Layer columns_of(const Hits& hits) {
  const auto begin = [&](const auto& column, std::string_view group) {
    return hits.channels.has(group) ? column.data() : nullptr;
  };
  return {begin(hits.id, "id"),
          begin(hits.order, "order"),
          begin(hits.u, "uv"),
          begin(hits.v, "uv"),
          begin(hits.shift, "shift"),
          begin(hits.A, "A"),
          {begin(hits.duv[0], "duv"), begin(hits.duv[1], "duv"), begin(hits.duv[2], "duv"),
           begin(hits.duv[3], "duv")}};
}

/// A column, or one value in its place: entry i stands at data[i & mask].
template <class T>
struct Column {
  const T* data;
  std::size_t mask;
  Column(const T* column, const T& missing)
      : data(column != nullptr ? column : &missing), mask(column != nullptr ? ~std::size_t{0} : 0) {}
  T operator[](std::size_t i) const { return data[i & mask]; }
};

}  // namespace

std::vector<std::uint8_t> lines_with_one_each(const Dataset& dataset) {
  const auto width = static_cast<std::size_t>(dataset.manifest.width);
  std::vector<std::uint8_t> out;
  for (std::size_t line = 0; line < static_cast<std::size_t>(dataset.manifest.lines); ++line) {
    const std::uint64_t* offset = dataset.hits.offset.data() + line * width;
    std::uint64_t difference = 0;
    for (std::size_t i = 0; i <= width; ++i) difference |= offset[i] - offset[0] - i;
    if (difference != 0) {
      out.push_back(0);
      continue;
    }
    const float* opacity = dataset.hits.A.data() + offset[0];
    const bool opaque = std::all_of(opacity, opacity + width, [](float A) { return A >= 1; });
    out.push_back(opaque ? kOneOpaqueEach : 1);
  }
  return out;
}

Layer Layers::Expanded::layer() const {
  return {id.data(),
          order.data(),
          u.data(),
          v.data(),
          shift.data(),
          opacity.data(),
          {duv[0].data(), duv[1].data(), duv[2].data(), duv[3].data()}};
}

Layers::Layers(const Dataset& dataset, std::span<const std::uint8_t> one_each)
    : offset_(dataset.hits.offset),
      columns_(columns_of(dataset.hits)),
      one_each_(one_each),
      width_(static_cast<std::size_t>(dataset.manifest.width)),
      height_(static_cast<std::size_t>(dataset.manifest.lines)) {
  const std::vector<std::uint32_t> numbers(width_);
  const std::vector<float> values(width_), ones(width_, 1.0f), steps(recorded_steps() ? width_ : 0);
  // Where a channel is missing: images of one order, no shift.
  nothing_ = {kNowhere, 0, numbers, numbers, values, values, ones, values, {steps, steps, steps, steps}};
  expanded_.fill(nothing_);
}

/// The crossings of a line side by side; 0 where a pixel has none of this rank.
void Layers::expand(const std::uint64_t* offset, std::size_t rank, Expanded& copy) const {
  const std::uint32_t* id_column = columns_.id;
  const float* opacity = columns_.opacity;
  const Column<std::uint32_t> order(columns_.order, nothing_.order[0]);
  const Column<float> u(columns_.u, nothing_.u[0]), v(columns_.v, nothing_.v[0]),
      shift(columns_.shift, nothing_.shift[0]);
  for (std::size_t i = 0; i < width_; ++i) {
    const std::size_t hit = offset[i] + rank;
    const bool there = hit < offset[i + 1];
    copy.id[i] = there ? id_column[hit] : 0;
    copy.order[i] = there ? order[hit] : 0;
    copy.u[i] = there ? u[hit] : 0;
    copy.v[i] = there ? v[hit] : 0;
    copy.shift[i] = there ? shift[hit] : 0;
    copy.opacity[i] = there ? opacity[hit] : 0;
  }
  for (std::size_t k = 0; recorded_steps() && k < 4; ++k)
    for (std::size_t i = 0; i < width_; ++i) {
      const std::size_t hit = offset[i] + rank;
      copy.duv[k][i] = hit < offset[i + 1] ? columns_.duv[k][hit] : 0;
    }
}

Layer Layers::at(std::ptrdiff_t row, std::size_t rank) {
  if (row < 0 || row >= static_cast<std::ptrdiff_t>(height_)) return nothing_.layer();
  const std::size_t line = static_cast<std::size_t>(row);
  const std::uint64_t* offset = offset_.data() + line * width_;
  // Step 1: as they lie in the dataset, if they lie side by side.
  if (rank == 0 && one_each_[line] != 0) {
    const auto from = [&](const auto* column, const auto& missing) {
      return column == nullptr ? missing.data() : column + offset[0];
    };
    const auto& duv = columns_.duv;
    return {columns_.id + offset[0],
            from(columns_.order, nothing_.order),
            from(columns_.u, nothing_.u),
            from(columns_.v, nothing_.v),
            from(columns_.shift, nothing_.shift),
            columns_.opacity + offset[0],
            {from(duv[0], nothing_.u), from(duv[1], nothing_.u), from(duv[2], nothing_.u),
             from(duv[3], nothing_.u)}};
  }
  // Step 2: else side by side in a copy.
  Expanded& copy = expanded_[line % 3];
  if (copy.row == line && copy.rank == rank) return copy.layer();
  copy.row = line;
  copy.rank = rank;
  expand(offset, rank, copy);
  return copy.layer();
}

/// The lines that footprints are found in: with those above and below, unless steps are recorded.
std::array<Layer, 3> Layers::around(std::size_t row, std::size_t rank, const Layer& here) {
  if (recorded_steps()) return {here, here, here};
  const auto line = static_cast<std::ptrdiff_t>(row);
  return {this->at(line - 1, rank), here, this->at(line + 1, rank)};
}

}  // namespace nullcone::postrender
