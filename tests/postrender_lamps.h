// Datasets with recorded light of lamps, and looks for them.
#pragma once

#include <string>
#include <vector>

#include "tests/postrender_fixture.h"

namespace nullcone::postrender {

/// Light along one path to one crossing.
struct TestLight {
  float E = 0, shift = 1, t = 0, tau = 0;
};

/// The same light on every crossing: of each lamp (by name and tau_origin) along each path, path by path.
inline Dataset lit_by(Dataset data, const std::vector<ObjectEntry>& lamps,
                      const std::vector<std::vector<TestLight>>& light) {
  std::vector<std::string> names;
  for (const ObjectEntry& lamp : lamps) names.push_back(lamp.name);
  data.manifest.lights = lamps;
  data.manifest.light_paths = static_cast<int>(light.front().size());
  set_lamps(data.hits, names, data.manifest.light_paths);
  data.manifest.channels = data.hits.channels;
  std::size_t i = 0;
  for (const std::vector<TestLight>& paths : light)
    for (const TestLight& path : paths) {
      LightPath& to = data.hits.light[i++];
      to.E.assign(data.hits.count(), path.E);
      to.shift.assign(data.hits.count(), path.shift);
      to.t.assign(data.hits.count(), path.t);
      to.tau.assign(data.hits.count(), path.tau);
    }
  return data;
}

/// A pixel that sees a surface with the shift g, lit by "sun"; beside it another one, so that tables hold
/// more than the shifts that are asked for.
inline Dataset under_sun(float g, const std::vector<TestLight>& paths) {
  TestHit hit, other;
  hit.shift = g;
  other.shift = 1.05f * g;
  Dataset out = lit_by(make_dataset(2, 1, {{"earth"}},
                                    [&](int column, int) { return std::vector{column == 0 ? hit : other}; }),
                       {{"sun", 100}}, {paths});
  for (LightPath& path : out.hits.light) path.shift[1] *= 1.05f;
  return out;
}

/// The light of the first pixel, in linear sRGB; the same with every instruction set.
inline Rgb light_of(const Dataset& data, const std::string& look, bool physical = true) {
  Rgb first;
  Renderer renderer(data);
  const Shading shading = renderer.prepare(look_of(look, data.manifest, NULLCONE_TEST_DATA));
  for (const Kernel* kernel : kernels()) {
    std::vector<Rgbx> display(static_cast<std::size_t>(data.manifest.width)),
        in_cd_m2(static_cast<std::size_t>(data.manifest.width));
    LineShader(data, lines_with_one_each(data), shading, *kernel).shade(0, display.data(), in_cd_m2.data());
    const Rgb found = physical ? in_cd_m2[0] : display[0];
    if (kernel == kernels().front()) first = found;
    EXPECT_EQ(found, first) << kernel->isa;
  }
  return first;
}

inline std::string lambertian(const std::string& more, const std::string& rest) {
  return R"({"objects":{"earth":{"surface":{"type":"lambertian"})" + (more.empty() ? "" : "," + more) + "}}" +
         (rest.empty() ? "" : "," + rest) + "}";
}

inline std::string sun(const std::string& more) { return R"("lights":{"sun":{)" + more + "}}"; }

inline const std::string kHot = R"("spectrum":{"type":"black_body","temperature_K":5762})";

}  // namespace nullcone::postrender
