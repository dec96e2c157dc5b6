#include "apps/cryptomatte.h"

#include <murmurhash.h>

#include <algorithm>
#include <cstdio>
#include <nlohmann/json.hpp>

#include "core/base/error.h"

namespace nullcone {

namespace {

std::string hexadecimal(std::uint32_t number) {
  std::array<char, 9> text{};
  std::snprintf(text.data(), text.size(), "%08x", number);
  return text.data();
}

}  // namespace

std::uint32_t cryptomatte_hash(std::string_view name) {
  std::array<std::uint32_t, 1> hash{};
  lmmh_x86_32(name.data(), static_cast<unsigned>(name.size()), 0, hash.data());
  const std::uint32_t exponent = hash[0] >> 23 & 255;
  return exponent == 0 || exponent == 255 ? hash[0] ^ 1U << 23 : hash[0];
}

std::vector<std::pair<std::string, std::string>> cryptomatte_attributes(
    const std::string& layer, const std::vector<ObjectEntry>& objects) {
  nlohmann::ordered_json names = nlohmann::ordered_json::object();
  for (const ObjectEntry& object : objects) names[object.name] = hexadecimal(cryptomatte_hash(object.name));
  const std::string key = "cryptomatte/" + hexadecimal(cryptomatte_hash(layer)).substr(0, 7) + "/";
  return {{key + "name", layer},
          {key + "hash", "MurmurHash3_32"},
          {key + "conversion", "uint32_to_float32"},
          {key + "manifest", names.dump()}};
}

Coverages::Coverages(const Manifest& manifest, const std::string& place)
    : objects_(manifest.objects.size()),
      left_(static_cast<std::size_t>(manifest.samples) * static_cast<std::size_t>(manifest.samples)) {
  if (manifest.samples > 1 && !manifest.channels.has("sample"))
    throw InputError(place, "has several rays a pixel, but not the channel 'sample'");
}

const std::vector<Coverage>& Coverages::of(const Hits& hits, std::size_t pixel) & {
  found_.clear();
  std::ranges::fill(left_, 1.0);
  for (std::uint64_t k = hits.offset[pixel]; k < hits.offset[pixel + 1]; ++k) {
    const std::size_t sample = hits.sample.empty() ? 0 : hits.sample[k];
    const auto opacity = static_cast<double>(hits.A[k]);
    if (sample >= left_.size() || hits.id[k] < 1 || hits.id[k] > objects_ || !(opacity > 0)) continue;
    const double hidden = left_[sample] * std::min(opacity, 1.0);
    left_[sample] -= hidden;
    if (hidden > 0) add(hits.id[k], hidden);
  }
  for (Coverage& coverage : found_) coverage.share /= static_cast<double>(left_.size());
  std::ranges::sort(found_, [](const Coverage& a, const Coverage& b) {
    return a.share != b.share ? a.share > b.share : a.id < b.id;
  });
  return found_;
}

void Coverages::add(std::uint32_t id, double share) {
  const auto known = std::ranges::find(found_, id, &Coverage::id);
  if (known == found_.end())
    found_.push_back({id, share});
  else
    known->share += share;
}

}  // namespace nullcone
