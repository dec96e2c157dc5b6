// Scenes for films, and what is seen on them, crossing by crossing.
#pragma once

#include <gtest/gtest.h>

#include <nlohmann/json.hpp>

#include "tests/traced.h"

namespace nullcone::test {

using nlohmann::json;

inline const json kAllChannels = {{"differentials", true},
                                  {"channels", {"order", "uv", "shift", "t", "tau", "mu", "N", "K", "P"}}};

/// A film of square pixels, `extent` wide, that looks along `forward`.
inline json film(double extent, int width, int height, const json& forward = {1, 0, 0}) {
  return {
      {"type", "orthographic"}, {"extent", extent}, {"resolution", {width, height}}, {"forward", forward}};
}

inline json placed(const json& shape, const json& centre, const char* name = "it") {
  return {{"name", name}, {"shape", shape}, {"placing", {{"type", "coordinate"}, {"centre", centre}}}};
}

inline json scene_of(const std::string& metric, const json& camera, const std::vector<json>& objects) {
  return {{"metric", {{"name", metric}}},
          {"observer", {{"event", {0, 0, 0, 0}}}},
          {"camera", camera},
          {"objects", objects},
          {"records", kAllChannels}};
}

struct Seen {
  HitRecord hit;
  HitDetail detail;
  double x, y;  ///< picture coordinates
};

inline std::vector<Seen> seen(const Traced& traced) {
  std::vector<Seen> out;
  traced.for_each_hit([&](const HitRecord& hit, std::size_t x, std::size_t y) {
    const TracedBand& band = traced.bands[y / kBandLines];
    const auto i = static_cast<std::size_t>(&hit - band.hits.data());
    out.push_back({hit, band.details.at(i), static_cast<double>(x) + 0.5, static_cast<double>(y) + 0.5});
  });
  return out;
}

inline host::Vec3<double> place_of(const Traced& traced, const Seen& one) {
  return host::place_on_film(traced.scene.camera, one.x, one.y);
}

inline void expect_no_doubts(const Traced& traced) {
  EXPECT_EQ(traced.rays_with(Status::step_limit) + traced.rays_with(Status::not_finite), 0U);
}

}  // namespace nullcone::test
