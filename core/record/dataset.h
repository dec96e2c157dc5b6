// A dataset: records and the manifest that says how they came to be.
#pragma once

#include <algorithm>
#include <cstdint>
#include <string>
#include <vector>

#include "core/base/camera.h"
#include "core/base/sha256.h"
#include "core/record/hits.h"

namespace nullcone {

/// An object by its number in `Hits::id` (its place in the list, from 1).
struct ObjectEntry {
  std::string name;       ///< matches [A-Za-z][A-Za-z0-9_-]{0,31}
  double tau_origin = 0;  ///< proper time at which the channel `tau` is 0
  bool operator==(const ObjectEntry&) const = default;
};

inline constexpr int kNewestFormat = 4;

/// What only the end of tracing tells.
struct Effort {
  double core_seconds = 0, seconds = 0;  ///< of all processors, and from start to end
  std::uint64_t light_doubts = 0;        ///< how often a lamp's light on a crossing may have been missed

  Effort& operator+=(const Effort& more) {
    core_seconds += more.core_seconds, seconds += more.seconds, light_doubts += more.light_doubts;
    return *this;
  }
};

/// How a dataset came to be; stored as JSON in the header of the file.
struct Manifest {
  int format = 2;                 ///< version of the file format: the least that holds the content
  int width = 0, height = 0;      ///< of the whole picture, in pixels
  int first_line = 0, lines = 0;  ///< the window of the picture that is here: scan lines, all of each
  int traced_lines = 0;           ///< of the window; fewer than `lines` where tracing was interrupted
  int samples = 1;                ///< rays a pixel, along each side
  ChannelSet channels = kDefaultChannels;
  std::string scene;         ///< canonical JSON of the whole scene, its look included
  std::string scene_sha256;  ///< of the canonical scene without its look
  std::string metric;
  std::string
      setting;  ///< JSON: metric_parameters, camera, observation, paths, as they were with all defaults
  std::vector<ObjectEntry> objects;
  std::vector<ObjectEntry> lights = {};  ///< lamps whose light is recorded; see set_lights()
  int light_paths = 0;                   ///< paths a lamp; 0 without lamps
  std::string version, isa, host;
  Effort effort;
  std::string hits_sha256, rays_sha256;  ///< see PayloadHash

  /// Light that is recorded, where there are lamps: that takes format 3.
  void set_lights(std::vector<ObjectEntry> lamps, int paths) {
    if (lamps.empty()) return;
    lights = std::move(lamps);
    light_paths = paths;
    channels = channels | ChannelSet::of("light");
    format = std::max(format, 3);
  }
  /// A whole picture.
  void set_size(int w, int h) {
    width = w;
    height = lines = traced_lines = h;
  }
  std::size_t pixels() const { return static_cast<std::size_t>(width) * static_cast<std::size_t>(lines); }
  std::size_t rays() const {
    return pixels() * static_cast<std::size_t>(samples) * static_cast<std::size_t>(samples);
  }
  bool partial() const { return traced_lines < lines; }
};

/// Empty columns for those of the manifest's channels that are `wanted`.
Hits empty_hits(const Manifest& manifest, ChannelSet wanted = kAllChannels);

/// The bands of a window, in order: f(first, lines), where `first` counts within the window.
template <class F>
void for_each_band(int lines, F&& f) {
  for (int first = 0; first < lines; first += kBandLines) f(first, std::min(kBandLines, lines - first));
}

/// Records of some scan lines; `hits.offset` begins at 0.
struct Band {
  Hits hits;
  Rays rays;
};

struct Dataset {
  Manifest manifest;
  Hits hits;
  Rays rays;

  std::size_t pixels() const { return manifest.pixels(); }
  /// Scan lines `first` to `first + lines` of the window.
  Band band(int first, int lines) const;
  /// Puts a band behind those that are there.
  void append(const Band& band);
};

/// Fingerprints of records: SHA-256 over all bands of kBandLines scan lines from the top; of each, the counts
/// of crossings a pixel (uint32) and then the channels in the order of channels.h, little endian. So they can
/// be made band by band, and those of a picture do not depend on how it was cut.
class PayloadHash {
 public:
  void add(const Band& band);
  std::string hits() { return hits_.digits(); }
  std::string rays() { return rays_.digits(); }

 private:
  Sha256 hits_, rays_;
};

/// Sets the fingerprints in the manifest.
void fingerprint(Dataset& dataset);

/// Looks for faults, band by band; each is one line.
class Verifier {
 public:
  explicit Verifier(const Manifest& manifest);
  void add(const Band& band);
  /// After the last band: all faults, empty when counts, channels, values and fingerprints agree.
  std::vector<std::string> faults();

 private:
  void check_values(const Band& band);
  void once(const std::string& fault);

  const Manifest& manifest_;
  PayloadHash hash_;
  Dataset old_;  ///< all of it, for format 1
  int lines_ = 0;
  std::vector<std::string> faults_;
};

/// Faults of a dataset in memory.
std::vector<std::string> verify(const Dataset& dataset);

}  // namespace nullcone
