// The channels of a dataset: the one table of their names, types, units, ranges and meanings.
#pragma once

#include <array>
#include <cstddef>
#include <cstdint>
#include <string_view>

namespace nullcone {

struct ChannelInfo {
  std::string_view name;  ///< in files; what stands before a dot is the name of its group
  bool whole;             ///< uint, else float
  std::string_view unit, range, meaning;
  int since = 1;  ///< version of the format that has it first

  constexpr std::string_view group() const { return name.substr(0, name.find('.')); }
};

/// Channels of the deep part `hits`, one value a crossing; in the order of hashes and listings.
inline constexpr std::array kHitChannelInfo = {
    ChannelInfo{"Z", false, "scene", "0 to inf", "affine distance along the ray, k.u = 1 at the camera"},
    ChannelInfo{"A", false, "1", "0 to 1", "opacity"},
    ChannelInfo{"id", true, "1", "from 1", "number of the object in the manifest"},
    ChannelInfo{"order", true, "1", "from 0", "caustics passed: rank of the image; odd images are mirrored"},
    ChannelInfo{"sample", true, "1", "0 to samples^2 - 1",
                "which ray of the pixel: row by row from the top left", 2},
    ChannelInfo{"uv.U", false, "1", "0 to 1", "texture coordinate"},
    ChannelInfo{"uv.V", false, "1", "0 to 1", "texture coordinate, upwards"},
    ChannelInfo{"shift", false, "1", "from 0", "frequency ratio g = observed / emitted; above 1 is blue"},
    ChannelInfo{"t", false, "scene", "-inf to inf", "coordinate time of emission minus that of observation"},
    ChannelInfo{"tau", false, "scene", "-inf to inf",
                "the object's proper time minus tau_origin in the manifest"},
    ChannelInfo{"mu", false, "1", "0 to 1",
                "cosine of the emission angle from the normal, in the surface's rest frame"},
    ChannelInfo{"duv.Ux", false, "1/pixel", "any", "change of uv.U one pixel to the right", 2},
    ChannelInfo{"duv.Vx", false, "1/pixel", "any", "change of uv.V one pixel to the right", 2},
    ChannelInfo{"duv.Uy", false, "1/pixel", "any", "change of uv.U one pixel down", 2},
    ChannelInfo{"duv.Vy", false, "1/pixel", "any", "change of uv.V one pixel down", 2},
    ChannelInfo{"N.X", false, "1", "-1 to 1",
                "unit normal on the side that is seen, in the object's rest frame along its axes", 2},
    ChannelInfo{"N.Y", false, "1", "-1 to 1", "its y component", 2},
    ChannelInfo{"N.Z", false, "1", "-1 to 1", "its z component", 2},
    ChannelInfo{"K.X", false, "1", "-1 to 1",
                "unit direction of emission in the surface's rest frame along the object's axes", 2},
    ChannelInfo{"K.Y", false, "1", "-1 to 1", "its y component", 2},
    ChannelInfo{"K.Z", false, "1", "-1 to 1", "its z component", 2},
    ChannelInfo{"P.X", false, "scene", "any", "chart coordinate x minus that of the observation", 2},
    ChannelInfo{"P.Y", false, "scene", "any", "chart coordinate y minus that of the observation", 2},
    ChannelInfo{"P.Z", false, "scene", "any", "chart coordinate z minus that of the observation", 2},
};

/// What is known of the light that reaches a crossing from one lamp along one path; channels of `hits` named
/// light.<lamp>.<path>.<name>, behind all others, lamp by lamp and path by path (from 0, the brightest
/// first).
inline constexpr std::array kLightChannelInfo = {
    ChannelInfo{"E", false, "1/scene^2", "from 0, finite",
                "irradiance of a lamp of intensity 1 without its powers of g: cos(alpha)/|det D| times what "
                "gets through; "
                "0: no such path, or in shadow",
                3},
    ChannelInfo{"shift", false, "1", "above 0, finite",
                "frequency ratio g = at the surface / emitted by the lamp", 3},
    ChannelInfo{"t", false, "scene", "finite",
                "coordinate time at which the lamp emitted minus that of observation", 3},
    ChannelInfo{"tau", false, "scene", "finite",
                "the lamp's proper time then, minus its tau_origin in the manifest", 3},
};

/// Channels of the flat part `rays`, one value a ray.
inline constexpr std::array kRayChannelInfo = {
    ChannelInfo{"status", true, "1", "0 to 8", "how the ray ended (see Status)"},
    ChannelInfo{"steps", true, "1", "from 0", "evaluations of the path, or attempts of a step"},
    ChannelInfo{"error", false, "1", "from 0",
                "estimated relative error at the end of the ray; 0 for closed forms"},
    ChannelInfo{"drift", false, "1", "from 0",
                "|g^mn p_m p_n| at the end of the ray, frequency 1 at the camera; 0 for closed forms"},
};

/// Some of the channels of `hits`.
struct ChannelSet {
  std::uint32_t bits = 0;  ///< bit i: number i of kHitChannelInfo; the last bit: all channels of light

  static constexpr std::uint32_t kLight = 1U << 31;

  constexpr bool has(std::size_t channel) const { return (bits >> channel & 1U) != 0; }
  /// Whether it has all channels of the group ("uv", "N", "shift", …).
  constexpr bool has(std::string_view group) const { return (of(group).bits & ~bits) == 0; }
  constexpr ChannelSet operator|(ChannelSet other) const { return {bits | other.bits}; }
  constexpr ChannelSet operator&(ChannelSet other) const { return {bits & other.bits}; }
  constexpr bool operator==(const ChannelSet&) const = default;

  /// The channels of a group; none for an unknown name.
  static constexpr ChannelSet of(std::string_view group) {
    ChannelSet out{group == "light" ? kLight : 0};
    for (std::size_t i = 0; i < kHitChannelInfo.size(); ++i)
      if (kHitChannelInfo[i].group() == group) out.bits |= 1U << i;
    return out;
  }
};

/// What every dataset has.
inline constexpr ChannelSet kLeastChannels = ChannelSet::of("Z") | ChannelSet::of("A") | ChannelSet::of("id");
/// What post-rendering needs, and all that files of format 1 have: 40 bytes a crossing.
inline constexpr ChannelSet kDefaultChannels =
    kLeastChannels | ChannelSet::of("order") | ChannelSet::of("uv") | ChannelSet::of("shift") |
    ChannelSet::of("t") | ChannelSet::of("tau") | ChannelSet::of("mu");
/// What takes more work to find than the others.
inline constexpr ChannelSet kDetailChannels =
    ChannelSet::of("duv") | ChannelSet::of("N") | ChannelSet::of("K") | ChannelSet::of("P");
inline constexpr ChannelSet kAllChannels = {((1U << kHitChannelInfo.size()) - 1) | ChannelSet::kLight};

}  // namespace nullcone
