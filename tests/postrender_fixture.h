// Small datasets, looks and picture files for the tests of postrender/.
#pragma once

#include <gtest/gtest.h>

#include <cmath>
#include <filesystem>
#include <fstream>
#include <functional>
#include <nlohmann/json.hpp>
#include <string>
#include <vector>

#include "core/base/error.h"
#include "core/record/dataset.h"
#include "postrender/develop.h"
#include "postrender/look.h"
#include "postrender/renderer.h"
#include "tests/test_folder.h"

namespace nullcone::postrender {

using test::TestFolder;

/// One crossing, with harmless defaults.
struct TestHit {
  std::uint32_t id = 1;
  float u = 0.5f, v = 0.5f, shift = 1, t = -1, tau = 0, opacity = 1;
  std::uint32_t order = 0;
};

/// A dataset whose crossings at (column, row) are those that `at` gives, nearest first.
inline Dataset make_dataset(int width, int height, const std::vector<ObjectEntry>& objects,
                            const std::function<std::vector<TestHit>(int, int)>& at) {
  Dataset out;
  out.manifest.set_size(width, height);
  out.manifest.objects = objects;
  Hits& hits = out.hits;
  for (int row = 0; row < height; ++row)
    for (int column = 0; column < width; ++column) {
      float Z = 1;
      for (const TestHit& hit : at(column, row)) {
        hits.Z.push_back(Z++);
        hits.A.push_back(hit.opacity);
        hits.id.push_back(hit.id);
        hits.order.push_back(hit.order);
        hits.u.push_back(hit.u);
        hits.v.push_back(hit.v);
        hits.shift.push_back(hit.shift);
        hits.t.push_back(hit.t);
        hits.tau.push_back(hit.tau);
        hits.mu.push_back(1);
      }
      hits.offset.push_back(hits.Z.size());
      out.rays.status.push_back(0);
      out.rays.steps.push_back(1);
      out.rays.error.push_back(0);
      out.rays.drift.push_back(0);
    }
  return out;
}

/// One pixel with the given crossings.
inline Dataset one_pixel(const std::vector<TestHit>& hits,
                         const std::vector<ObjectEntry>& objects = {{"earth"}}) {
  return make_dataset(1, 1, objects, [&](int, int) { return hits; });
}

/// A picture-filling object "earth": u to the right from 0 to 1, v upwards from 0 to 1.
inline Dataset flat_map(int width, int height) {
  return make_dataset(width, height, {{"earth"}}, [=](int column, int row) {
    TestHit hit;
    hit.u = (static_cast<float>(column) + 0.5f) / static_cast<float>(width);
    hit.v = 1 - (static_cast<float>(row) + 0.5f) / static_cast<float>(height);
    return std::vector{hit};
  });
}

inline Look look_of(const std::string& text, const Manifest& manifest, const std::string& folder = "") {
  return parse_look(nlohmann::json::parse(text), {"look.json", "", folder}, manifest);
}

/// The picture of `data` under the look `text`.
inline Image picture(Dataset data, const std::string& text, const std::string& folder = "") {
  const Look look = look_of(text, data.manifest, folder);
  return Renderer(std::move(data)).render(look);
}

/// What is seen of one colour with the frequency ratio g, the same with every instruction set.
inline Rgb seen(const Light& light, Rgb color, float g) {
  TestHit hit;
  hit.shift = g;
  const Dataset data = one_pixel({hit});
  const Shading shading = {{{ColorTexture{color}, light}}, {{0, 0, {}}}, {}, {}};
  const bool physical = has_physical(shading);
  Rgb first;
  for (const Kernel* kernel : kernels()) {
    Rgbx line_display, line_physical;
    LineShader(data, lines_with_one_each(data), shading, *kernel).shade(0, &line_display, &line_physical);
    const Rgb found = physical ? line_physical : line_display;
    if (kernel == kernels().front()) first = found;
    EXPECT_EQ(found, first) << kernel->isa;
  }
  return first;
}

/// A spectrum as a look writes it.
inline SpectrumLook spectrum_of(const std::string& text, const std::string& folder = "") {
  const nlohmann::json document = nlohmann::json::parse(text);
  return parse_spectrum(JsonObject(document, "look.json", ""), {"look.json", "", folder});
}

/// What is seen of a spectrum behind one colour, by a table over [g/2, 2g].
inline Rgb seen(const std::string& spectrum, Rgb color, float g, Effects effects = {}) {
  const float at = g > 0 && g < INFINITY ? g : 1;
  return seen(LightTables().get(spectrum_of(spectrum), effects, standard_observer(), {at / 2, 2 * at}), color,
              g);
}

/// One colour, developed with every instruction set alike.
inline Image developed(Rgb display, const DevelopLook& look) {
  Image first;
  for (const Kernel* kernel : kernels()) {
    const Rgbx line = display;
    Image image;
    set_size(image, 1, 1, {});
    LineDeveloper(look, *kernel).develop(&line, nullptr, 0, 1, image);
    if (kernel == kernels().front()) first = image;
    EXPECT_EQ(image.display, first.display) << kernel->isa;
  }
  return first;
}

/// What `f` complains about, or "" when it does not throw an InputError.
template <class F>
std::string complaint(F&& f) {
  try {
    f();
  } catch (const InputError& error) {
    return error.what();
  }
  return "";
}

inline nlohmann::json reference_case(const std::string& id) {
  std::ifstream in(NULLCONE_TEST_DATA "/reference_cases.json");
  const nlohmann::json all = nlohmann::json::parse(in);
  for (const nlohmann::json& one : all.at("cases"))
    if (one.at("id") == id) return one;
  ADD_FAILURE() << "no reference case " << id;
  return {};
}

inline void expect_color(Rgb found, Rgb expected, float tolerance) {
  EXPECT_NEAR(found.r, expected.r, tolerance);
  EXPECT_NEAR(found.g, expected.g, tolerance);
  EXPECT_NEAR(found.b, expected.b, tolerance);
}

}  // namespace nullcone::postrender
