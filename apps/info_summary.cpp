#include <array>
#include <limits>

#include "apps/info.h"
#include "apps/info_quality.h"
#include "core/base/json.h"

namespace nullcone {

namespace {

/// Counts and ranges of the crossings and endings that have passed by.
class Counts {
 public:
  explicit Counts(const Manifest& manifest) : manifest_(manifest), objects_(manifest.objects.size()) {}

  void add(const Band& band) {
    const Hits& hits = band.hits;
    crossings_ += hits.count();
    for (std::size_t i = 0; i + 1 < hits.offset.size(); ++i)
      most_ = std::max(most_, hits.offset[i + 1] - hits.offset[i]);
    for (const std::uint32_t id : hits.id)
      if (id >= 1 && id <= objects_.size()) ++objects_[id - 1];
    for (const std::uint32_t status : band.rays.status)
      if (status < status_.size()) ++status_[status];
    std::size_t range = 0;
    for_each_channel([&](const ChannelInfo&, const auto& column) { widen(ranges_[range++], column); }, hits);
  }

  Report crossings() const {
    Report ranges = Report::object();
    std::size_t next = 0;
    for (std::size_t i = 0; i < kHitChannelInfo.size(); ++i) {
      if (!manifest_.channels.has(i)) continue;
      const auto [least, most] = ranges_[next++];
      if (!(least <= most)) continue;
      const bool whole = kHitChannelInfo[i].whole;
      const auto value = [whole](double x) {
        return whole ? Report(static_cast<std::uint32_t>(x)) : Report(x);
      };
      ranges[std::string(kHitChannelInfo[i].name)] = {value(least), value(most)};
    }
    return {{"count", crossings_}, {"max_per_pixel", most_}, {"ranges", ranges}};
  }

  Report statuses() const {
    Report out = Report::object();
    for (std::size_t i = 0; i < status_.size(); ++i) out[std::string(kStatusNames[i])] = status_[i];
    return out;
  }

  Report objects() const {
    Report out = Report::array();
    for (std::size_t i = 0; i < objects_.size(); ++i)
      out.push_back({{"name", manifest_.objects[i].name},
                     {"id", i + 1},
                     {"hits", objects_[i]},
                     {"tau_origin", manifest_.objects[i].tau_origin}});
    return out;
  }

 private:
  /// Least and greatest finite value.
  using Range = std::pair<double, double>;
  static void widen(Range& range, const auto& column) {
    for (const auto value : column) {
      const auto x = static_cast<double>(value);
      if (std::isfinite(x)) range = {std::min(range.first, x), std::max(range.second, x)};
    }
  }

  static constexpr double kNone = std::numeric_limits<double>::infinity();
  const Manifest& manifest_;
  std::uint64_t crossings_ = 0, most_ = 0;
  std::vector<std::uint64_t> objects_;
  std::array<std::uint64_t, kStatusNames.size()> status_{};
  std::vector<Range> ranges_ = std::vector<Range>(kHitChannelInfo.size(), {kNone, -kNone});
};

}  // namespace

Report summary(DatasetReader& reader, std::size_t worst) {
  const Manifest& m = reader.manifest();
  const Report scene = parse_json(m.scene, "manifest: scene");  // refuses what is nested too deep to print
  const Report setting =
      m.setting.empty() ? Report(nullptr) : Report(parse_json(m.setting, "manifest: setting"));
  Counts counts(m);
  Quality quality(m, worst);
  for_each_run(m, [&](int first, int lines) {
    const Band band = reader.band(first, lines);
    counts.add(band);
    quality.add(band.rays);
  });
  return {{"width", m.width},
          {"height", m.height},
          {"window", {{"first_line", m.first_line}, {"lines", m.lines}, {"traced_lines", m.traced_lines}}},
          {"partial", m.partial()},
          {"samples", m.samples},
          {"metric", m.metric},
          {"metric_parameters", scene.is_object() && scene.contains("metric") ? scene["metric"] : Report()},
          {"setting", setting},
          {"channels", channel_names(m.channels)},
          {"hits", counts.crossings()},
          {"status", counts.statuses()},
          {"objects", counts.objects()},
          {"quality", quality.report()},
          {"payload", {{"hits", m.hits_sha256}, {"rays", m.rays_sha256}}},
          {"scene_sha256", m.scene_sha256},
          {"isa", m.isa},
          {"core_seconds", m.core_seconds},
          {"seconds", m.seconds},
          {"version", m.version},
          {"host", m.host},
          {"format", m.format},
          {"scene", scene}};
}

}  // namespace nullcone
