#include <array>
#include <bit>
#include <limits>

#include "apps/info.h"
#include "apps/info_quality.h"
#include "core/base/json.h"

namespace nullcone {

namespace {

/// Counts and ranges of the crossings and endings that have passed by.
class Counts {
 public:
  /// `cap`: E that a caustic may have at most.
  Counts(const Manifest& manifest, double cap)
      : manifest_(manifest),
        objects_(manifest.objects.size()),
        paths_(static_cast<std::size_t>(std::max(manifest.light_paths, 1))),
        cap_(static_cast<double>(static_cast<float>(cap))),
        lit_(manifest.lights.size()),
        capped_(manifest.lights.size()) {
    const Hits shape = empty_hits(manifest);
    for_each_channel(
        [&](const ChannelInfo& channel, const auto&) {
          ranges_.push_back({std::string(channel.name), channel.whole, kNone, -kNone});
        },
        shape);
  }

  void add(const Band& band) {
    const Hits& hits = band.hits;
    crossings_ += hits.count();
    for (std::size_t i = 0; i + 1 < hits.offset.size(); ++i)
      most_ = std::max(most_, hits.offset[i + 1] - hits.offset[i]);
    for (const std::uint32_t id : hits.id)
      if (id >= 1 && id <= objects_.size()) ++objects_[id - 1];
    for (std::size_t i = 0; i < hits.light.size(); ++i)
      for (const float E : hits.light[i].E) {
        lit_[i / paths_] += E > 0;
        capped_[i / paths_] += static_cast<double>(E) >= cap_;
      }
    for (const std::uint32_t status : band.rays.status)
      if (status < status_.size()) ++status_[status];
    std::size_t range = 0;
    for_each_channel(
        [&](const ChannelInfo&, const auto& column) {
          ranges_[range].widen(column, lit(hits, range));
          ++range;
        },
        hits);
  }

  Report crossings() const {
    Report ranges = Report::object();
    for (const Range& range : ranges_) {
      if (!(range.least <= range.most)) continue;
      const auto value = [&](double x) {
        return range.whole ? Report(static_cast<std::uint32_t>(x)) : Report(x);
      };
      ranges[range.channel] = {value(range.least), value(range.most)};
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

  Report lights() const {
    Report out = Report::array();
    for (std::size_t i = 0; i < manifest_.lights.size(); ++i)
      out.push_back({{"name", manifest_.lights[i].name},
                     {"tau_origin", manifest_.lights[i].tau_origin},
                     {"lit", lit_[i]},
                     {"capped", capped_[i]}});
    return out;
  }

 private:
  /// Least and greatest finite value of a channel.
  struct Range {
    std::string channel;
    bool whole;
    double least, most;

    /// `where`: only values count beside which this is not 0.
    void widen(const auto& column, const std::vector<float>* where) {
      for (std::size_t i = 0; i < column.size(); ++i) {
        const auto x = static_cast<double>(column[i]);
        if (std::isfinite(x) && (!where || (*where)[i] != 0))
          least = std::min(least, x), most = std::max(most, x);
      }
    }
  };
  /// The channel E beside number `channel`, where that tells of light which need not be there.
  static const std::vector<float>* lit(const Hits& hits, std::size_t channel) {
    constexpr std::size_t kEach = kLightChannelInfo.size();
    const std::size_t first =
        static_cast<std::size_t>(std::popcount(hits.channels.bits & ~ChannelSet::kLight));
    if (channel < first || (channel - first) % kEach == 0) return nullptr;
    return &hits.light[(channel - first) / kEach].E;
  }

  static constexpr double kNone = std::numeric_limits<double>::infinity();
  const Manifest& manifest_;
  std::uint64_t crossings_ = 0, most_ = 0;
  std::vector<std::uint64_t> objects_;
  std::size_t paths_;
  double cap_;
  std::vector<std::uint64_t> lit_,
      capped_;  ///< by lamp: paths with light, and such that are as bright as may be
  std::array<std::uint64_t, kStatusNames.size()> status_{};
  std::vector<Range> ranges_;
};

double cap_of(const Report& setting) {
  const Report::json_pointer place("/lights/cap");
  return setting.is_object() && setting.contains(place) && setting.at(place).is_number()
             ? setting.at(place).get<double>()
             : std::numeric_limits<double>::infinity();
}

}  // namespace

Report summary(DatasetReader& reader, std::size_t worst) {
  const Manifest& m = reader.manifest();
  const Report scene = parse_json(m.scene, "manifest: scene");  // refuses what is nested too deep to print
  const Report setting =
      m.setting.empty() ? Report(nullptr) : Report(parse_json(m.setting, "manifest: setting"));
  Counts counts(m, cap_of(setting));
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
          {"channels", channel_names(empty_hits(m))},
          {"hits", counts.crossings()},
          {"status", counts.statuses()},
          {"objects", counts.objects()},
          {"lights", counts.lights()},
          {"light_paths", m.light_paths},
          {"light_doubts", m.effort.light_doubts},
          {"quality", quality.report()},
          {"payload", {{"hits", m.hits_sha256}, {"rays", m.rays_sha256}}},
          {"scene_sha256", m.scene_sha256},
          {"isa", m.isa},
          {"core_seconds", m.effort.core_seconds},
          {"seconds", m.effort.seconds},
          {"version", m.version},
          {"host", m.host},
          {"format", m.format},
          {"scene", scene}};
}

}  // namespace nullcone
