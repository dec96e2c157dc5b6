// The scenes of docs/illumination.md: what is lit there, and by what, is what the page says.
#include <gtest/gtest.h>

#include <cmath>
#include <fstream>
#include <iterator>
#include <numbers>

#include "tests/traced.h"

namespace nullcone::test {
namespace {

std::string text_of_scene(const std::string& name) {
  std::ifstream in(std::string(NULLCONE_SOURCE) + "/scenes/" + name);
  return {std::istreambuf_iterator<char>(in), {}};
}
Traced trace_lit(const std::string& name) { return trace_text(text_of_scene(name)); }

/// f(hit, its light by path) for every hit of one object.
template <class F>
void for_each_lit(const Traced& traced, std::uint32_t id, F&& f) {
  const auto paths = static_cast<std::size_t>(traced.scene.lights.all_paths());
  for (const TracedBand& band : traced.bands)
    for (std::size_t i = 0; i < band.hits.size(); ++i)
      if (band.hits[i].id == id) f(band.hits[i], std::span(band.lights).subspan(i * paths, paths));
}

std::size_t count_of(const Traced& traced, std::uint32_t id) {
  std::size_t out = 0;
  for_each_lit(traced, id, [&](const HitRecord&, std::span<const HitLight>) { ++out; });
  return out;
}

/// Unit normal of a sphere in its own frame.
Triple normal_at(const HitRecord& hit) {
  const double longitude = 2 * std::numbers::pi * (hit.u - 0.5), latitude = std::numbers::pi * (hit.v - 0.5);
  return {std::cos(latitude) * std::cos(longitude), std::cos(latitude) * std::sin(longitude),
          std::sin(latitude)};
}

TEST(LitScenes, a_lamp_beyond_the_horizon_is_not_seen_but_lights) {
  const Traced traced = trace_lit("goedel_lit_aligned.json");
  EXPECT_EQ(count_of(traced, 2), 0u);  // its bulb
  std::size_t lit = 0, averted = 0, twice = 0;
  for_each_lit(traced, 1, [&](const HitRecord& hit, std::span<const HitLight> light) {
    lit += light[0].E > 0;
    averted += light[0].E > 0 && normal_at(hit)[0] < -0.2;  // the lamp stands in the direction +x
    twice += light[1].E > 0;
    EXPECT_GE(light[0].E, light[1].E);
    if (light[0].E > 0) {
      EXPECT_NEAR(light[0].shift, 1, 1e-12);  // all at rest with the dust
      EXPECT_LT(light[0].t, hit.t + 1e-9);
    }
  });
  EXPECT_GT(lit, 1000u);
  EXPECT_GT(averted, 100u);
  EXPECT_GT(twice, 10u);
}

TEST(LitScenes, a_lamp_at_the_side_is_seen_too) {
  const Traced traced = trace_lit("goedel_lit_side.json");
  EXPECT_GT(count_of(traced, 2), 10u);
  std::size_t lit = 0;
  for_each_lit(traced, 1, [&](const HitRecord&, std::span<const HitLight> light) { lit += light[0].E > 0; });
  EXPECT_GT(lit, 1000u);
}

TEST(LitScenes, the_falling_sphere_is_lit_with_delays_and_shifts) {
  const Traced moving = trace_lit("goedel_lit_moving.json"), frozen = trace_lit("goedel_lit_frozen.json");
  double least = 10, most = 0, first = 0;
  for_each_lit(moving, 1, [&](const HitRecord& hit, std::span<const HitLight> light) {
    if (light[0].E == 0) return;
    least = std::min(least, light[0].shift), most = std::max(most, light[0].shift);
    first = std::min(first, light[0].t - hit.t);
  });
  EXPECT_LT(least, 0.8);
  EXPECT_GT(most, 1.1);
  EXPECT_LT(first, -0.3);  // the light's delay on its way to the sphere
  for_each_lit(frozen, 1, [&](const HitRecord&, std::span<const HitLight> light) {
    if (light[0].E == 0) return;
    EXPECT_NEAR(light[0].shift, 1, 1e-12);
  });
}

TEST(LitScenes, the_wall_is_blue_ahead_of_the_lamp_and_red_behind) {
  const Traced traced = trace_lit("lamp_flyby.json");
  double ahead = 0, behind = 10;
  std::size_t shadow = 0;
  for_each_lit(traced, 1, [&](const HitRecord&, std::span<const HitLight> light) {
    shadow += light[0].E == 0;
    if (light[0].E == 0) return;
    ahead = std::max(ahead, light[0].shift), behind = std::min(behind, light[0].shift);
  });
  EXPECT_NEAR(ahead, std::sqrt(1.9 / 0.1), 0.1);  // nearly the Doppler factors along the line of flight
  EXPECT_NEAR(behind, std::sqrt(0.1 / 1.9), 0.05);
  EXPECT_GT(shadow, 1000u);  // of the column
}

TEST(LitScenes, every_instruction_set_sees_the_same_light) {
  const std::string text = text_of_scene("goedel_lit_moving.json");
  std::string hash;
  for (const std::string_view isa : instruction_sets()) {
    Scene scene = read_scene(text, "test", metric_descriptions());
    const Dataset dataset = trace_scene(find_spacetime("goedel", isa), scene, "test");
    EXPECT_TRUE(hash.empty() || dataset.manifest.hits_sha256 == hash) << isa;
    hash = dataset.manifest.hits_sha256;
    EXPECT_FALSE(dataset.hits.light.empty());
  }
}

}  // namespace
}  // namespace nullcone::test
