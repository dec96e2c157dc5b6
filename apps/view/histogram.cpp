#include "apps/view/histogram.h"

#include <algorithm>
#include <cmath>
#include <limits>
#include <vector>

#include "apps/view/named_object.h"
#include "core/base/error.h"

namespace nullcone::view {

namespace {

constexpr int kMostBins = 1024;

const std::vector<float>& column_of(const Dataset& dataset, const std::string& channel) {
  if (channel != "t" && channel != "tau")
    throw InputError("channel", "expected t or tau, got '" + printable(channel, 40) + "'");
  if (!dataset.hits.channels.has(channel))
    throw InputError("channel", "the dataset has no channel '" + channel +
                                    "'; trace with records.channels that include it");
  return channel == "t" ? dataset.hits.t : dataset.hits.tau;
}

/// From the least to the greatest; of some width also where there is one time only, or none.
struct Range {
  double from = std::numeric_limits<double>::infinity(), to = -from;

  void add(double x) { from = std::min(from, x), to = std::max(to, x); }
  void widen() {
    if (from > to) from = 0, to = 1;
    if (from < to) return;
    const double half = 0.5 * std::max(1.0, 1e-6 * std::abs(from));
    from -= half, to += half;
  }
};

}  // namespace

nlohmann::ordered_json emission_histogram(const Dataset& dataset, const std::string& object,
                                          const std::string& channel, int bins) {
  const std::uint32_t id = number_of_object(dataset.manifest, object);
  const std::vector<float>& times = column_of(dataset, channel);
  if (bins < 1 || bins > kMostBins)
    throw InputError("bins", "expected a whole number from 1 to " + std::to_string(kMostBins));
  const std::vector<std::uint32_t>& ids = dataset.hits.id;
  // Step 1: what there is.
  Range range;
  std::uint64_t finite = 0, other = 0;
  for (std::size_t hit = 0; hit < ids.size(); ++hit) {
    if (ids[hit] != id) continue;
    const double time = static_cast<double>(times[hit]);
    std::isfinite(time) ? ++finite : ++other;
    if (std::isfinite(time)) range.add(time);
  }
  range.widen();
  // Step 2: how often.
  std::vector<std::uint64_t> counts(static_cast<std::size_t>(bins));
  const double per_time = bins / (range.to - range.from);
  for (std::size_t hit = 0; hit < ids.size(); ++hit) {
    const double time = static_cast<double>(times[hit]);
    if (ids[hit] != id || !std::isfinite(time)) continue;
    const auto bin = static_cast<std::size_t>((time - range.from) * per_time);
    ++counts[std::min(bin, counts.size() - 1)];
  }
  const double origin = channel == "tau" ? dataset.manifest.objects[id - 1].tau_origin : 0;
  return {{"channel", channel},      {"from", range.from + origin},
          {"to", range.to + origin}, {"counts", counts},
          {"finite", finite},        {"other", other}};
}

}  // namespace nullcone::view
