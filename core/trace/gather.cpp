#include "core/trace/gather.h"

#include <algorithm>

namespace nullcone {

namespace {

/// The numbers of the crossings of each pixel: all samples of it, by Z.
class ByPixel {
 public:
  ByPixel(const TracedBand& band, const Camera& camera)
      : band_(band), samples_(static_cast<std::size_t>(camera.samples)) {
    wide_ = samples_ * static_cast<std::size_t>(camera.width);
    first_.assign(band.rays.size() + 1, 0);
    for (const HitRecord& hit : band.hits) ++first_[hit.pixel + 1];
    for (std::size_t i = 1; i < first_.size(); ++i) first_[i] += first_[i - 1];
  }
  /// Calls f(hit, sample) for the crossings of the pixel in column x of line y of the band.
  template <class F>
  void for_each(std::size_t x, std::size_t y, F&& f) {
    list_.clear();
    for (std::size_t row = 0; row < samples_; ++row)
      for (std::size_t column = 0; column < samples_; ++column) {
        const std::size_t ray = (y * samples_ + row) * wide_ + x * samples_ + column;
        for (std::size_t hit = first_[ray]; hit < first_[ray + 1]; ++hit)
          list_.push_back({hit, static_cast<std::uint32_t>(row * samples_ + column)});
      }
    if (samples_ > 1)
      std::ranges::stable_sort(
          list_, {}, [&](const Entry& entry) { return static_cast<float>(band_.hits[entry.hit].Z); });
    for (const Entry& entry : list_) f(entry.hit, entry.sample);
  }

 private:
  struct Entry {
    std::size_t hit;
    std::uint32_t sample;
  };
  const TracedBand& band_;
  std::size_t samples_, wide_;
  std::vector<std::size_t> first_;
  std::vector<Entry> list_;
};

float to_float(double x) { return static_cast<float>(x); }

void add_hit(const HitRecord& hit, std::uint32_t sample, float opacity, Hits& hits) {
  hits.Z.push_back(to_float(hit.Z));
  hits.A.push_back(opacity);
  hits.id.push_back(hit.id);
  hits.order.push_back(hit.order);
  hits.sample.push_back(sample);
  hits.u.push_back(to_float(hit.u));
  hits.v.push_back(to_float(hit.v));
  hits.shift.push_back(to_float(hit.shift));
  hits.t.push_back(to_float(hit.t));
  hits.tau.push_back(to_float(hit.tau));
  hits.mu.push_back(to_float(hit.mu));
}

/// Kernels know samples alone: changes from one to the next are 1/samples of those from pixel to pixel.
void add_detail(const HitDetail& detail, int samples, Hits& hits) {
  for (std::size_t i = 0; i < 4; ++i) hits.duv[i].push_back(to_float(samples * detail.duv[i]));
  for (std::size_t i = 0; i < 3; ++i) {
    hits.N[i].push_back(to_float(detail.N[i]));
    hits.K[i].push_back(to_float(detail.K[i]));
    hits.P[i].push_back(to_float(detail.P[i]));
  }
}

/// `lights`: one a path of `hits`.
void add_light(const HitLight* lights, Hits& hits) {
  for (LightPath& path : hits.light) {
    path.E.push_back(to_float(lights->E));
    path.shift.push_back(to_float(lights->shift));
    path.t.push_back(to_float(lights->t));
    path.tau.push_back(to_float(lights->tau));
    ++lights;
  }
}

/// All channels of what the scene can ask for.
Hits all_columns(const Lights& lights) {
  Hits out;
  out.channels = kAllChannels;
  std::vector<std::string> lamps;
  for (const Lamp& lamp : lights.lamps) lamps.push_back(lamp.name);
  set_lamps(out, lamps, lights.paths);
  return out;
}

}  // namespace

void Gathering::resize(std::size_t count) {
  hits.resize(count);
  if (with_details) details.resize(count);
  lights.resize(count * light_paths);
}

HitRoom Gathering::extend(std::size_t count) {
  kept_ = hits.size();
  resize(kept_ + count);
  return {hits.data() + kept_, with_details ? details.data() + kept_ : nullptr,
          light_paths > 0 ? lights.data() + kept_ * light_paths : nullptr, light_paths};
}

void Gathering::keep(std::size_t count) {
  resize(kept_ + count);
  for (std::size_t i = kept_; i < hits.size(); ++i) hits[i].pixel += first_pixel;
}

TracedBand trace_band(const Tracer& tracer, const Scene& scene, bool with_details, int first_line) {
  const Camera& camera = scene.camera;
  const Camera rays = sample_camera(camera);
  const int first = first_line * camera.samples,
            end = std::min(first_line + kBandLines, camera.height) * camera.samples;
  const auto width = static_cast<std::size_t>(rays.width);
  std::vector<RayRecord> records(width * static_cast<std::size_t>(end - first));
  Gathering sink;
  sink.with_details = with_details;
  sink.light_paths = scene.lights.all_paths();
  sink.hits.reserve(records.size());
  for (int line = first; line < end; line += kBandLines) {
    const int lines = std::min(kBandLines, end - line);
    const std::size_t before = width * static_cast<std::size_t>(line - first);
    sink.first_pixel = static_cast<std::uint32_t>(before);
    tracer.trace_band(line, lines,
                      {sink, std::span(records).subspan(before, width * static_cast<std::size_t>(lines))});
  }
  return {std::move(sink.hits), std::move(sink.details), std::move(sink.lights), std::move(records)};
}

Band gather(const TracedBand& band, const Scene& scene) {
  const Camera& camera = scene.camera;
  const auto width = static_cast<std::size_t>(camera.width);
  const std::size_t samples = static_cast<std::size_t>(camera.samples * camera.samples);
  Band out;
  out.hits = all_columns(scene.lights);
  const std::size_t paths = out.hits.light.size();
  for_each_channel([&](const ChannelInfo&, auto& column) { column.reserve(band.hits.size()); }, out.hits);
  ByPixel by_pixel(band, camera);
  for (std::size_t i = 0; i < band.rays.size() / samples; ++i) {
    by_pixel.for_each(i % width, i / width, [&](std::size_t hit, std::uint32_t sample) {
      add_hit(band.hits[hit], sample, to_float(scene.objects[band.hits[hit].id - 1].opacity), out.hits);
      if (!band.details.empty()) add_detail(band.details[hit], camera.samples, out.hits);
      add_light(band.lights.data() + hit * paths, out.hits);
    });
    out.hits.offset.push_back(out.hits.Z.size());
  }
  for_each_channel(  // what nobody asked for is dropped
      [&](const ChannelInfo& channel, auto& column) {
        if (!scene.records.channels.has(channel.group())) column = {};
      },
      out.hits);
  out.hits.channels = scene.records.channels;
  for (const RayRecord& ray : band.rays) {
    out.rays.status.push_back(ray.status);
    out.rays.steps.push_back(ray.steps);
    out.rays.error.push_back(ray.error);
    out.rays.drift.push_back(ray.drift);
  }
  return out;
}

}  // namespace nullcone
