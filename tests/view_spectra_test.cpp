// What the viewer tells of a pixel: its records, and the spectra emitted and observed there.
#include "apps/info.h"
#include "apps/view/inspect.h"
#include "tests/dataset_fixture.h"
#include "tests/postrender_fixture.h"

namespace nullcone::view {
namespace {

using nlohmann::ordered_json;
using postrender::TestHit;

/// Planck's law in W m^-2 sr^-1 nm^-1, with the radiation constants of CODATA 2018.
double planck(double nm, double T) {
  const double m = 1e-9 * nm;
  return 1e-9 * 1.191042972397188e-16 / (std::pow(m, 5) * std::expm1(1.438776877503933e-2 / (m * T)));
}

ordered_json inspected(const Dataset& data, const std::string& look) {
  return inspect_pixel(data, postrender::look_of(look, data.manifest), 0, 0);
}

/// The spectra of one pixel with the given crossings; the clock of "earth" begins at 10.
ordered_json spectra(const std::vector<TestHit>& hits, const std::string& look) {
  return inspected(postrender::one_pixel(hits, {{"earth", 10}, {"moon", 0}}), look)["spectra"];
}

ordered_json spectrum(const TestHit& hit, const std::string& earth, const std::string& effects = "{}") {
  const ordered_json found =
      spectra({hit}, R"({"objects":{"earth":)" + earth + R"(},"effects":)" + effects + "}");
  EXPECT_EQ(found.size(), 1u) << earth;
  return found.empty() ? ordered_json::object() : found[0];
}

TestHit with_shift(float g) {
  TestHit out;
  out.shift = g;
  return out;
}

TestHit at_time(float t, float tau = 0) {
  TestHit out;
  out.t = t, out.tau = tau;
  return out;
}

/// `expected(nm)` at all wavelengths, to a relative 1e-9.
template <class F>
void expect_values(const ordered_json& found, const char* which, F&& expected) {
  const ordered_json& nm = found["wavelength_nm"];
  ASSERT_EQ(nm.size(), 141u);
  ASSERT_EQ(found[which].size(), nm.size());
  EXPECT_EQ(nm.front(), 300.0);
  EXPECT_EQ(nm.back(), 1000.0);
  for (std::size_t i = 0; i < nm.size(); ++i) {
    const double value = expected(nm[i].get<double>());
    ASSERT_NEAR(found[which][i].get<double>(), value, 1e-9 * std::abs(value)) << which << " " << nm[i];
  }
}

constexpr const char* kHot = R"({"spectrum":{"type":"black_body","temperature_K":5000}})";

TEST(ViewSpectra, OfABlackBodyFollowTheEffects) {
  const float g = 0.7F;
  const double d = static_cast<double>(g);
  const auto emitted = [](double nm) { return planck(nm, 5000); };
  const ordered_json both = spectrum(with_shift(g), kHot);
  expect_values(both, "emitted", emitted);
  expect_values(both, "observed", [&](double nm) { return planck(nm, d * 5000); });
  EXPECT_EQ(both["unit"], "W m^-2 sr^-1 nm^-1");
  EXPECT_EQ(both["object"], "earth");
  EXPECT_EQ(both["hit"], 0);
  EXPECT_EQ(both["g"], g);
  EXPECT_EQ(both["lines"].size(), 0u);
  const auto observed = [&](const char* effects, auto&& expected) {
    expect_values(spectrum(with_shift(g), kHot, effects), "observed", expected);
  };
  observed(R"({"searchlight":false})", [&](double nm) { return planck(nm, d * 5000) / std::pow(d, 5); });
  observed(R"({"doppler":false})", [&](double nm) { return std::pow(d, 4) * emitted(nm); });
  observed(R"({"doppler":false,"searchlight":false})", emitted);
  observed(R"({"radiance_exponents":{"spectral":3}})",
           [&](double nm) { return planck(nm, d * 5000) / (d * d); });
}

TEST(ViewSpectra, AreDarkWithoutAFrequencyRatio) {
  for (const float g : {0.0F, -1.0F, NAN, INFINITY}) {
    const ordered_json found = spectrum(with_shift(g), kHot);
    expect_values(found, "observed", [](double) { return 0; });
    expect_values(found, "emitted", [](double nm) { return planck(nm, 5000); });
  }
  for (const float g : {1e-45F, 3e38F})  // numbers all the same
    EXPECT_EQ(spectrum(with_shift(g), kHot).dump().find("null"), std::string::npos) << g;
}

TEST(ViewSpectra, HaveLinesApart) {
  const char* sodium = R"({"spectrum":{"type":"sum","of":[{"type":"lines","lines":[[600,2],[400,1]]},
                                                          {"type":"equal_energy","radiance":3}]}})";
  const double g = static_cast<double>(0.8F);
  const ordered_json both = spectrum(with_shift(0.8F), sodium);
  expect_values(both, "observed", [&](double) { return 3 * std::pow(g, 5); });
  ASSERT_EQ(both["lines"].size(), 2u);
  const ordered_json& line = both["lines"][0];
  EXPECT_EQ(line["emitted_nm"], 600.0);
  EXPECT_EQ(line["strength"], 2.0);
  EXPECT_NEAR(line["observed_nm"].get<double>(), 600 / g, 1e-9);
  // g^5 of the radiance in intervals that are 1/g as wide: g^4 in all.
  EXPECT_NEAR(line["observed_strength"].get<double>(), 2 * std::pow(g, 4), 1e-12);
  const ordered_json still = spectrum(with_shift(0.8F), sodium, R"({"doppler":false})")["lines"][1];
  EXPECT_EQ(still["observed_nm"], 400.0);
  EXPECT_NEAR(still["observed_strength"].get<double>(), std::pow(g, 4), 1e-12);
}

TEST(ViewSpectra, AreThoseOfTheTimeOfEmission) {
  const char* slices = R"({"spectrum":{"type":"black_body","temperature_K":5000},"time_slices":[
    {"channel":"t","from":-2,"to":-1,"spectrum":{"type":"black_body","temperature_K":3000}},
    {"channel":"tau","from":12,"to":14,"fade":1,"spectrum":{"type":"equal_energy","radiance":2}}]})";
  const auto at = [&](float t, float tau, auto&& expected) {
    expect_values(spectrum(at_time(t, tau), slices), "emitted", expected);
  };
  at(-3, 0, [](double nm) { return planck(nm, 5000); });
  at(-1.5F, 0, [](double nm) { return planck(nm, 3000); });
  at(-1.5F, 3, [](double nm) { return planck(nm, 3000); });  // the first slice that holds wins
  at(-3, 3, [](double) { return 2; });                       // 13 by its own clock
  at(-3, 4, [](double nm) { return 0.5 * 2 + 0.5 * planck(nm, 5000); });
}

TEST(ViewSpectra, FollowKeyframes) {
  const char* cooling = R"({"spectrum":{"type":"black_body",
    "temperature_K":{"keyframes":[[10,4000],[14,2000]],"by":"tau"}}})";
  const ordered_json found = spectrum(at_time(0, 1), cooling);  // 11 by its own clock
  expect_values(found, "emitted", [](double nm) { return planck(nm, 3500); });
  const char* brighter =
      R"({"spectrum":{"type":"equal_energy","radiance":{"keyframes":[[-2,1],[0,3]],"by":"t"}},
          "intensity":{"keyframes":[[-2,10],[0,20]],"by":"t"}})";
  expect_values(spectrum(at_time(-1.5F), brighter), "emitted", [](double) { return 1.5 * 12.5; });
}

TEST(ViewSpectra, AreTimesIntensityAndBlink) {
  const char* lamp = R"({"spectrum":{"type":"equal_energy","radiance":2},"intensity":3,
                         "blink":{"channel":"t","period":1,"duty":0.5}})";
  expect_values(spectrum(at_time(-0.75F), lamp), "observed", [](double) { return 6; });
  expect_values(spectrum(at_time(-0.25F), lamp), "observed", [](double) { return 0; });
}

TEST(ViewSpectra, OfThreeSpectraNeedOneColour) {
  const std::string channels =
      R"("spectrum":{"type":"channels","spectra":[{"type":"equal_energy","radiance":1},
    {"type":"equal_energy","radiance":10},{"type":"equal_energy","radiance":100}]})";
  const std::string blue = R"({"texture":{"type":"color","rgb":[1,0,1]},)" + channels + "}";
  expect_values(spectrum({}, blue), "emitted", [](double) { return 101; });
  const ordered_json rgb =
      spectrum({}, R"({"texture":{"type":"color","rgb":[1,1,1]},"spectrum":{"type":"rgb"}})");
  EXPECT_EQ(rgb["unit"], "relative");
  EXPECT_GT(rgb["emitted"][50], 0);
  const std::string board =
      R"({"texture":{"type":"checkerboard","counts":[2,2],"colors":[[1,0,0],[0,1,0]]},)";
  EXPECT_EQ(spectra({{}}, R"({"objects":{"earth":)" + board + channels + "}}}").size(), 0u);
}

TEST(ViewSpectra, AreOnlyOfWhatHasSome) {
  TestHit moon;
  moon.id = 2;
  const ordered_json found = spectra({{}, moon, {}}, R"({"objects":{"moon":)" + std::string(kHot) + "}}");
  ASSERT_EQ(found.size(), 1u);
  EXPECT_EQ(found[0]["hit"], 1);
  EXPECT_EQ(found[0]["object"], "moon");
  for (const char* none : {R"({"type":"display"})", R"({"type":"total_radiance"})"})
    EXPECT_EQ(spectra({{}}, R"({"objects":{"earth":{"spectrum":)" + std::string(none) + "}}}").size(), 0u);
  EXPECT_EQ(spectra({{}}, R"({"objects":{"earth":{"surface":{"type":"lambertian"},
                              "spectrum":{"type":"equal_energy"}}}})")
                .size(),
            0u);
  EXPECT_EQ(spectra(std::vector<TestHit>(100), R"({"objects":{"earth":)" + std::string(kHot) + "}}").size(),
            32u);
  Dataset data = postrender::one_pixel({{}});
  data.hits.channels.bits &= ~ChannelSet::of("shift").bits;
  data.hits.shift.clear();
  const std::string look = R"({"objects":{"earth":)" + std::string(kHot) + "}";
  EXPECT_EQ(inspected(data, look + "}")["spectra"].size(), 0u);
  const ordered_json still =
      inspected(data, look + R"(,"effects":{"doppler":false,"searchlight":false}})")["spectra"];
  ASSERT_EQ(still.size(), 1u);
  EXPECT_TRUE(still[0]["g"].is_null());
}

TEST(ViewSpectra, ReachAsFarAsTheSensor) {
  const ordered_json found =
      spectra({{}}, R"({"sensor":"infrared","objects":{"earth":)" + std::string(kHot) + "}}");
  EXPECT_EQ(found[0]["wavelength_nm"].back(), 1400.0);
}

using ViewPixel = test::DatasetFile;

TEST_F(ViewPixel, HasTheRecordsOfTheFile) {
  Dataset data = test::sample();
  data.manifest.height = 9, data.manifest.first_line = 3;  // a window of a larger picture
  fingerprint(data);
  test::write(path, data);
  DatasetReader reader(path);
  const std::string hot(kHot);
  const postrender::Look look =
      postrender::look_of(R"({"objects":{"earth":)" + hot + R"(,"moon":)" + hot + "}}", data.manifest);
  for (int y = 3; y < 7; ++y)
    for (int x = 0; x < 6; ++x) {
      ordered_json found = inspect_pixel(data, look, x, y);
      ASSERT_EQ(found["spectra"].size(), found["hits"].size());
      for (std::size_t i = 0; i < found["hits"].size(); ++i) {
        EXPECT_EQ(found["spectra"][i]["object"], found["hits"][i]["object"]);
        EXPECT_EQ(found["spectra"][i]["g"].dump(), found["hits"][i]["shift"].dump());
      }
      found.erase("spectra");
      EXPECT_EQ(found.dump(), pixel_records(reader, x, y).dump()) << x << " " << y;
    }
  for (const auto& [x, y] : {std::pair{6, 3}, {-1, 3}, {0, 2}, {0, 7}})
    EXPECT_THROW(inspect_pixel(data, look, x, y), InputError) << x << " " << y;
  data.rays = {};
  EXPECT_TRUE(inspect_pixel(data, look, 1, 4)["rays"].is_null());
}

TEST(ViewPixelSamples, AreThoseOfThePixel) {
  Dataset data;
  data.manifest.set_size(3, 2);
  data.manifest.samples = 2;
  data.hits.offset.assign(7, 0);
  for (std::uint32_t ray = 0; ray < 24; ++ray) {
    data.rays.status.push_back(1), data.rays.steps.push_back(ray);
    data.rays.error.push_back(0), data.rays.drift.push_back(0);
  }
  const ordered_json rays = inspect_pixel(data, {}, 1, 1)["rays"];  // rows of 6 rays, 2 a line
  ASSERT_EQ(rays.size(), 4u);
  const std::uint32_t expected[] = {14, 15, 20, 21};
  for (std::size_t i = 0; i < 4; ++i) EXPECT_EQ(rays[i]["steps"], expected[i]);
}

}  // namespace
}  // namespace nullcone::view
