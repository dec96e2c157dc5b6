// A dataset: records and the manifest that says how they came to be.
#pragma once

#include <cstdint>
#include <string>
#include <vector>

#include "core/record/hits.h"

namespace nullcone {

/// An object by its number in `Hits::id` (its place in the list, from 1).
struct ObjectEntry {
  std::string name;       ///< matches [A-Za-z][A-Za-z0-9_-]{0,31}
  double tau_origin = 0;  ///< proper time at which the channel `tau` is 0
  bool operator==(const ObjectEntry&) const = default;
};

/// How a dataset came to be; stored as JSON in the header of the file.
struct Manifest {
  int format = 1;  ///< version of the file format
  int width = 0, height = 0;
  std::string scene;         ///< canonical JSON of the whole scene, its look included
  std::string scene_sha256;  ///< of the canonical scene without its look
  std::string metric;
  std::vector<ObjectEntry> objects;
  std::string version, isa, host;
  double core_seconds = 0;
  std::string hits_sha256, rays_sha256;  ///< of all channels, in the order of hits.h
};

struct Dataset {
  Manifest manifest;
  Hits hits;
  Rays rays;

  std::size_t pixels() const {
    return static_cast<std::size_t>(manifest.width) * static_cast<std::size_t>(manifest.height);
  }
};

/// SHA-256 over the per-pixel counts and all columns (little endian), in the order of the table of channels.
std::string payload_sha256(const Hits& hits);
std::string payload_sha256(const Rays& rays);

/// Faults of a dataset, one line each; empty when counts, channels and hashes agree.
std::vector<std::string> verify(const Dataset& dataset);

}  // namespace nullcone
