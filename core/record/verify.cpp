#include <algorithm>
#include <limits>
#include <nlohmann/json.hpp>

#include "core/base/json.h"
#include "core/record/dataset.h"

namespace nullcone {

namespace {

/// The fingerprints of format 1: the offsets (uint64) of all pixels, then whole columns.
std::pair<std::string, std::string> old_fingerprints(const Dataset& dataset) {
  Sha256 hits, rays;
  hits.add(std::span(dataset.hits.offset));
  for_each_channel([&](const ChannelInfo&, const auto& column) { hits.add(std::span(column)); },
                   dataset.hits);
  for_each_channel([&](const ChannelInfo&, const auto& column) { rays.add(std::span(column)); },
                   dataset.rays);
  return {hits.digits(), rays.digits()};
}

/// The numbers that may stand in a channel, by its range in the table.
struct Bounds {
  double least = -kUnbounded, most = kUnbounded;
  static constexpr double kUnbounded = std::numeric_limits<double>::infinity();

  explicit Bounds(std::string_view range) {
    constexpr auto kGreatest = static_cast<double>(std::numeric_limits<float>::max());
    if (range.ends_with("finite")) least = -kGreatest, most = kGreatest;
    if (range.starts_with("above 0")) least = static_cast<double>(std::numeric_limits<float>::denorm_min());
    if (range.starts_with("0 to ") || range.starts_with("from 0")) least = 0;
    if (range.starts_with("-1 to ")) least = -1;
    if (range.ends_with(" to 1")) most = 1;
    if (range.ends_with(" to 8")) most = static_cast<double>(kStatusNames.size() - 1);
  }
  bool hold(double x) const { return x >= least && x <= most; }  // not for NaN
};

}  // namespace

Verifier::Verifier(const Manifest& manifest) : manifest_(manifest) {
  old_.manifest = manifest;
  old_.hits = empty_hits(manifest);
  try {
    nlohmann::json scene = parse_json(manifest.scene, "manifest: scene");
    scene.erase("look");
    if (sha256(canonical_json(scene)) != manifest.scene_sha256)
      once("manifest: SHA-256 of the scene differs from the one beside it");
  } catch (const std::exception& error) {
    once(error.what());
  }
}

void Verifier::once(const std::string& fault) {
  if (std::find(faults_.begin(), faults_.end(), fault) == faults_.end()) faults_.push_back(fault);
}

void Verifier::add(const Band& band) {
  const std::size_t width = static_cast<std::size_t>(manifest_.width),
                    samples = static_cast<std::size_t>(manifest_.samples) *
                              static_cast<std::size_t>(manifest_.samples);
  const auto& offset = band.hits.offset;
  const std::size_t pixels = offset.empty() ? 0 : offset.size() - 1;
  if (offset.empty() || offset[0] != 0 || pixels % width != 0)
    return once("hits: the number of pixels is not width x lines");
  if (!std::is_sorted(offset.begin(), offset.end())) return once("hits: the counts a pixel are not counts");
  if (channel_names(band.hits) != channel_names(empty_hits(manifest_)))
    return once("hits: the channels are not those of the manifest");
  const std::size_t before = faults_.size();
  const auto check = [&](const char* part, std::size_t expected) {
    return [this, part, expected](const ChannelInfo& channel, const auto& column) {
      const std::string name = part + std::string(channel.name);
      if (column.size() != expected) return once(name + " has a wrong length");
      const Bounds bounds(channel.range);
      for (const auto value : column)
        if (!bounds.hold(static_cast<double>(value)))
          return once(name + " is out of range: expected " + std::string(channel.range));
    };
  };
  for_each_channel(check("hits: channel ", band.hits.count()), band.hits);
  for_each_channel(check("rays: channel ", pixels * samples), band.rays);
  if (faults_.size() == before) check_values(band);
  if (manifest_.format == 1)
    old_.append(band);
  else
    hash_.add(band);
  lines_ += static_cast<int>(pixels / width);
}

void Verifier::check_values(const Band& band) {
  const Hits& hits = band.hits;
  for (const std::uint32_t id : hits.id)
    if (id < 1 || id > manifest_.objects.size()) once("hits: an id names no object of the manifest");
  if (manifest_.format < 4 &&
      std::ranges::find(band.rays.status, static_cast<std::uint32_t>(Status::outside)) !=
          band.rays.status.end())
    once("rays: a status is 'outside', which files have from format 4 on");
  const auto samples = static_cast<std::uint32_t>(manifest_.samples * manifest_.samples);
  for (const std::uint32_t sample : hits.sample)
    if (sample >= samples) once("hits: a sample is not one of the pixel's " + std::to_string(samples));
  for (std::size_t i = 0; i + 1 < hits.offset.size(); ++i)
    for (std::uint64_t k = hits.offset[i] + 1; k < hits.offset[i + 1]; ++k)
      if (!(hits.Z[k - 1] <= hits.Z[k])) {
        const auto width = static_cast<std::size_t>(manifest_.width);
        once("hits: the crossings of pixel " + std::to_string(i % width) + "," +
             std::to_string(static_cast<std::size_t>(manifest_.first_line + lines_) + i / width) +
             " are not sorted by Z");
        return;
      }
}

std::vector<std::string> Verifier::faults() {
  if (lines_ != manifest_.lines) once("hits: the number of pixels is not width x lines");
  const auto [hits, rays] =
      manifest_.format == 1 ? old_fingerprints(old_) : std::pair(hash_.hits(), hash_.rays());
  if (hits != manifest_.hits_sha256) once("hits: SHA-256 differs from the one in the header");
  if (rays != manifest_.rays_sha256) once("rays: SHA-256 differs from the one in the header");
  return faults_;
}

std::vector<std::string> verify(const Dataset& dataset) {
  Verifier verifier(dataset.manifest);
  if (dataset.hits.offset.size() != dataset.pixels() + 1)
    return {"hits: the number of pixels is not width x lines"};
  if (!std::is_sorted(dataset.hits.offset.begin(), dataset.hits.offset.end()))
    return {"hits: the counts a pixel are not counts"};
  std::vector<std::string> lengths;
  const auto check = [&](std::size_t expected) {
    return [&lengths, expected](const ChannelInfo& channel, const auto& column) {
      if (column.size() != expected)
        lengths.push_back("channel " + std::string(channel.name) + " has a wrong length");
    };
  };
  for_each_channel(check(dataset.hits.count()), dataset.hits);
  for_each_channel(check(dataset.manifest.rays()), dataset.rays);
  if (!lengths.empty()) return lengths;
  for_each_band(dataset.manifest.lines,
                [&](int first, int lines) { verifier.add(dataset.band(first, lines)); });
  return verifier.faults();
}

}  // namespace nullcone
