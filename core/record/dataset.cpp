#include "core/record/dataset.h"

#include <algorithm>
#include <bit>
#include <cmath>

namespace nullcone {

static_assert(std::endian::native == std::endian::little,
              "payload hashes are defined over little-endian bytes");

namespace {

template <class T>
std::vector<T> part(const std::vector<T>& column, std::size_t first, std::size_t count) {
  const auto begin = column.begin() + static_cast<std::ptrdiff_t>(first);
  return {begin, begin + static_cast<std::ptrdiff_t>(count)};
}

constexpr auto kExtend = [](const ChannelInfo&, auto& to, const auto& from) {
  to.insert(to.end(), from.begin(), from.end());
};

}  // namespace

Hits empty_hits(const Manifest& manifest, ChannelSet wanted) {
  Hits out;
  out.channels = manifest.channels & wanted;
  if (!out.channels.has("light")) return out;
  std::vector<std::string> lamps;
  for (const ObjectEntry& lamp : manifest.lights) lamps.push_back(lamp.name);
  set_lamps(out, lamps, manifest.light_paths);
  return out;
}

Band Dataset::band(int first, int count) const {
  const std::size_t width = static_cast<std::size_t>(manifest.width),
                    begin = width * static_cast<std::size_t>(first);
  const std::size_t samples =
      static_cast<std::size_t>(manifest.samples) * static_cast<std::size_t>(manifest.samples);
  Band out;
  out.hits = empty_like(hits);
  out.hits.offset = part(hits.offset, begin, width * static_cast<std::size_t>(count) + 1);
  const std::uint64_t at = out.hits.offset.front(), crossings = out.hits.offset.back() - at;
  for (std::uint64_t& offset : out.hits.offset) offset -= at;
  for_each_channel([&](const ChannelInfo&, auto& to, const auto& from) { to = part(from, at, crossings); },
                   out.hits, hits);
  for_each_channel(
      [&](const ChannelInfo&, auto& to, const auto& from) {
        to = part(from, begin * samples, width * static_cast<std::size_t>(count) * samples);
      },
      out.rays, rays);
  return out;
}

void Dataset::append(const Band& band) {
  const std::uint64_t before = hits.count();
  for (std::size_t i = 1; i < band.hits.offset.size(); ++i)
    hits.offset.push_back(before + band.hits.offset[i]);
  for_each_channel(kExtend, hits, band.hits);
  for_each_channel(kExtend, rays, band.rays);
}

void PayloadHash::add(const Band& band) {
  std::vector<std::uint32_t> counts(band.hits.offset.size() - 1);
  for (std::size_t i = 0; i < counts.size(); ++i)
    counts[i] = static_cast<std::uint32_t>(band.hits.offset[i + 1] - band.hits.offset[i]);
  hits_.add(std::span<const std::uint32_t>(counts));
  for_each_channel([&](const ChannelInfo&, const auto& column) { hits_.add(std::span(column)); }, band.hits);
  for_each_channel([&](const ChannelInfo&, const auto& column) { rays_.add(std::span(column)); }, band.rays);
}

void fingerprint(Dataset& dataset) {
  PayloadHash hash;
  for_each_band(dataset.manifest.lines, [&](int first, int lines) { hash.add(dataset.band(first, lines)); });
  dataset.manifest.hits_sha256 = hash.hits();
  dataset.manifest.rays_sha256 = hash.rays();
}

}  // namespace nullcone
