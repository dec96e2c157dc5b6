#include "core/record/dataset.h"

#include <algorithm>
#include <bit>
#include <cmath>
#include <nlohmann/json.hpp>
#include <span>

#include "core/base/json.h"
#include "core/base/sha256.h"

namespace nullcone {

static_assert(std::endian::native == std::endian::little,
              "payload hashes are defined over little-endian bytes");

namespace {

void check_columns(const Dataset& dataset, std::vector<std::string>& faults) {
  const std::size_t pixels = dataset.pixels(), count = dataset.hits.count();
  if (dataset.hits.offset.size() != pixels + 1)
    faults.push_back("hits: the number of pixels is not width x height");
  if (!std::is_sorted(dataset.hits.offset.begin(), dataset.hits.offset.end()))
    faults.push_back("hits: the counts a pixel are not counts");
  for_each_channel(dataset.hits, kHitChannels, [&](const auto& channel, const auto& column) {
    if (column.size() != count)
      faults.push_back("hits: channel " + std::string(channel.name) + " has a wrong length");
  });
  for_each_channel(dataset.rays, kRayChannels, [&](const auto& channel, const auto& column) {
    if (column.size() != pixels)
      faults.push_back("rays: channel " + std::string(channel.name) + " has a wrong length");
  });
}

void check_values(const Dataset& dataset, std::vector<std::string>& faults) {
  const Hits& hits = dataset.hits;
  for (const std::uint32_t id : hits.id)
    if (id < 1 || id > dataset.manifest.objects.size()) {
      faults.push_back("hits: an id names no object of the manifest");
      break;
    }
  for (std::size_t i = 0; i + 1 < hits.offset.size(); ++i)
    for (std::uint64_t k = hits.offset[i] + 1; k < hits.offset[i + 1]; ++k)
      if (!(hits.Z[k - 1] <= hits.Z[k])) {
        faults.push_back("hits: the crossings of pixel " + std::to_string(i) + " are not sorted by Z");
        return;
      }
}

void check_scene(const Manifest& manifest, std::vector<std::string>& faults) {
  try {
    nlohmann::json scene = parse_json(manifest.scene, "manifest: scene");
    scene.erase("look");
    if (sha256(canonical_json(scene)) != manifest.scene_sha256)
      faults.push_back("manifest: SHA-256 of the scene differs from the one beside it");
  } catch (const std::exception& error) {
    faults.emplace_back(error.what());
  }
}

}  // namespace

std::string payload_sha256(const Hits& hits) {
  Sha256 hash;
  hash.add(std::span(hits.offset));
  for_each_channel(hits, kHitChannels, [&](const auto&, const auto& column) { hash.add(std::span(column)); });
  return hash.digits();
}

std::string payload_sha256(const Rays& rays) {
  Sha256 hash;
  for_each_channel(rays, kRayChannels, [&](const auto&, const auto& column) { hash.add(std::span(column)); });
  return hash.digits();
}

std::vector<std::string> verify(const Dataset& dataset) {
  std::vector<std::string> faults;
  check_columns(dataset, faults);
  if (!faults.empty()) return faults;
  check_values(dataset, faults);
  check_scene(dataset.manifest, faults);
  if (payload_sha256(dataset.hits) != dataset.manifest.hits_sha256)
    faults.push_back("hits: SHA-256 differs from the one in the header");
  if (payload_sha256(dataset.rays) != dataset.manifest.rays_sha256)
    faults.push_back("rays: SHA-256 differs from the one in the header");
  return faults;
}

}  // namespace nullcone
