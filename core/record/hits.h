// Records: what every ray met, as a structure of arrays, and where each channel stands in it.
#pragma once

#include <array>
#include <concepts>
#include <cstdint>
#include <string>
#include <tuple>
#include <type_traits>
#include <utility>
#include <vector>

#include "core/base/channels.h"
#include "core/base/status.h"

namespace nullcone {

/// Light from one lamp along one path: the channels light.<lamp>.<path>.*, one value a crossing.
struct LightPath {
  std::string prefix;  ///< "light.<lamp>.<path>."
  std::vector<float> E, shift, t, tau;
};

/// All crossings of all pixels, pixel by pixel (row by row from the top left), nearest first.
/// The crossings of pixel i stand at offset[i] … offset[i + 1] − 1 of every column that is recorded; the
/// others are empty.
struct Hits {
  ChannelSet channels = kDefaultChannels;
  std::vector<std::uint64_t> offset = {0};  ///< pixels + 1 entries
  std::vector<float> Z, A;
  std::vector<std::uint32_t> id, order, sample;
  std::vector<float> u, v, shift, t, tau, mu;
  std::array<std::vector<float>, 4> duv;      ///< du/dx, dv/dx, du/dy, dv/dy
  std::array<std::vector<float>, 3> N, K, P;  ///< normal, direction of emission, place

  std::vector<LightPath> light;  ///< lamp by lamp, path by path; empty unless channels.has("light")

  std::size_t count() const { return offset.empty() ? 0 : offset.back(); }
};

/// One entry a ray: a pixel, or a sample of it; row by row from the top left.
struct Rays {
  std::vector<std::uint32_t> status, steps;
  std::vector<float> error, drift;
};

/// All columns, in the order of kHitChannelInfo or kRayChannelInfo.
template <class Table>
requires std::same_as<std::remove_const_t<Table>, Hits>
auto columns(Table& h) {
  return std::tie(h.Z, h.A, h.id, h.order, h.sample, h.u, h.v, h.shift, h.t, h.tau, h.mu, h.duv[0], h.duv[1],
                  h.duv[2], h.duv[3], h.N[0], h.N[1], h.N[2], h.K[0], h.K[1], h.K[2], h.P[0], h.P[1], h.P[2]);
}
template <class Table>
requires std::same_as<std::remove_const_t<Table>, Rays>
auto columns(Table& rays) { return std::tie(rays.status, rays.steps, rays.error, rays.drift); }

inline const ChannelInfo& info_of(const Hits&, std::size_t channel) { return kHitChannelInfo[channel]; }
inline const ChannelInfo& info_of(const Rays&, std::size_t channel) { return kRayChannelInfo[channel]; }
inline bool has_channel(const Hits& hits, std::size_t channel) { return hits.channels.has(channel); }
inline bool has_channel(const Rays&, std::size_t) { return true; }

/// Columns of the light from these lamps, empty; further tables can then be filled beside it.
inline void set_lamps(Hits& hits, const std::vector<std::string>& lamps, int paths) {
  hits.light.clear();
  for (const std::string& lamp : lamps)
    for (int path = 0; path < paths; ++path)
      hits.light.push_back({"light." + lamp + "." + std::to_string(path) + ".", {}, {}, {}, {}});
  hits.channels = hits.light.empty() ? ChannelSet{hits.channels.bits & ~ChannelSet::kLight}
                                     : hits.channels | ChannelSet::of("light");
}
/// Columns of the same channels, empty.
inline Hits empty_like(const Hits& hits) {
  Hits out;
  out.channels = hits.channels;
  for (const LightPath& path : hits.light) out.light.push_back({path.prefix, {}, {}, {}, {}});
  return out;
}

/// All columns of a path, in the order of kLightChannelInfo.
template <class Path>
requires std::same_as<std::remove_const_t<Path>, LightPath>
auto columns(Path& path) { return std::tie(path.E, path.shift, path.t, path.tau); }

/// Calls f(info, column, other columns…) for every channel of light that `hits` holds; the names in `info`
/// are whole (light.<lamp>.<path>.E) and end with the call.
template <class F, class Table, class... Others>
void for_each_light_channel(F&& f, Table& hits, Others&... others) {
  for (std::size_t i = 0; i < hits.light.size(); ++i) {
    const auto visit = [&]<std::size_t k>(std::integral_constant<std::size_t, k>) {
      const std::string name = hits.light[i].prefix + std::string(kLightChannelInfo[k].name);
      ChannelInfo info = kLightChannelInfo[k];
      info.name = name;
      f(info, std::get<k>(columns(hits.light[i])), std::get<k>(columns(others.light.at(i)))...);
    };
    [&]<std::size_t... k>(std::index_sequence<k...>) {
      (visit(std::integral_constant<std::size_t, k>{}), ...);
    }
    (std::make_index_sequence<kLightChannelInfo.size()>{});
  }
}

/// Calls f(info, column, other columns…) for every channel that `table` holds, with the columns of the other
/// tables that stand at the same place; of Hits the channels of light come last.
template <class F, class Table, class... Others>
void for_each_channel(F&& f, Table& table, Others&... others) {
  const auto visit = [&]<std::size_t i>(std::integral_constant<std::size_t, i>) {
    if (has_channel(table, i))
      f(info_of(table, i), std::get<i>(columns(table)), std::get<i>(columns(others))...);
  };
  const auto all = [&]<std::size_t... i>(std::index_sequence<i...>) {
    (visit(std::integral_constant<std::size_t, i>{}), ...);
  };
  all(std::make_index_sequence<std::tuple_size_v<decltype(columns(table))>>{});
  if constexpr (std::same_as<std::remove_const_t<Table>, Hits>) for_each_light_channel(f, table, others...);
}

/// The channels of `hits` in their order, by name.
inline std::vector<std::string> channel_names(const Hits& hits) {
  std::vector<std::string> out;
  for_each_channel([&](const ChannelInfo& channel, const auto&) { out.emplace_back(channel.name); }, hits);
  return out;
}

}  // namespace nullcone
