// Records: what every ray met, as a structure of arrays, and the one table that names each channel.
#pragma once

#include <array>
#include <cstdint>
#include <string_view>
#include <tuple>
#include <vector>

#include "core/base/status.h"

namespace nullcone {

/// All crossings of all pixels, pixel by pixel (row by row from the top left), nearest first.
/// The crossings of pixel i stand at offset[i] … offset[i + 1] − 1 of every column.
struct Hits {
  std::vector<std::uint64_t> offset = {0};  ///< pixels + 1 entries
  std::vector<float> Z, A;
  std::vector<std::uint32_t> id, order;
  std::vector<float> u, v, shift, t, tau, mu;

  std::size_t count() const { return offset.empty() ? 0 : offset.back(); }
};

/// One entry a pixel.
struct Rays {
  std::vector<std::uint32_t> status, steps;
  std::vector<float> error, drift;
};

/// A channel: its name in files, its meaning, and where it stands in memory.
template <class Column>
struct Channel {
  std::string_view name;
  std::string_view meaning;
  Column column;  ///< pointer to member
};

template <class Column>
Channel(std::string_view, std::string_view, Column) -> Channel<Column>;

/// The channels of the deep part `hits`, in the order of hashes and listings.
inline constexpr std::tuple kHitChannels = {
    Channel{"Z", "affine distance along the ray, k.u = 1 at the camera (scene units)", &Hits::Z},
    Channel{"A", "opacity, 0 to 1", &Hits::A},
    Channel{"id", "number of the object in the manifest, from 1", &Hits::id},
    Channel{"order", "caustics passed: rank of the image; odd images are mirrored", &Hits::order},
    Channel{"uv.U", "texture coordinate, 0 to 1", &Hits::u},
    Channel{"uv.V", "texture coordinate, 0 to 1, upwards", &Hits::v},
    Channel{"shift", "frequency ratio g = observed / emitted; above 1 is blue", &Hits::shift},
    Channel{"t", "coordinate time of emission minus that of observation (scene units)", &Hits::t},
    Channel{"tau", "the object's proper time minus tau_origin in the manifest (scene units)", &Hits::tau},
    Channel{"mu", "cosine of the emission angle from the outward normal, in the surface's rest frame",
            &Hits::mu},
};

/// The channels of the flat part `rays`.
inline constexpr std::tuple kRayChannels = {
    Channel{"status", "how the ray ended (see Status)", &Rays::status},
    Channel{"steps", "evaluations of the path", &Rays::steps},
    Channel{"error", "sum of the accepted local error estimates, relative; 0 for closed forms", &Rays::error},
    Channel{"drift", "|H| / E^2 at the end of the ray; 0 for closed forms", &Rays::drift},
};

/// Calls f(channel, vector) for every column of `table` (Hits or Rays).
template <class Table, class Channels, class F>
void for_each_channel(Table& table, const Channels& channels, F&& f) {
  std::apply([&](const auto&... channel) { (f(channel, table.*channel.column), ...); }, channels);
}

}  // namespace nullcone
