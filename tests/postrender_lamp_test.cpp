// Lamps that change, surfaces that are seen through, and what looks of lit surfaces need and keep.
#include <tbb/global_control.h>

#include <numbers>

#include "postrender/needed_channels.h"
#include "tests/postrender_lamps.h"

namespace nullcone::postrender {
namespace {

TEST(LitSurfaces, lamps_change_by_their_own_clock) {
  // The lamp's clock shows 100 + tau when the light of tau left.
  const auto at = [](const std::string& lamp, float t, float tau) {
    return light_of(under_sun(1, {{static_cast<float>(std::numbers::pi), 1, t, tau}}),
                    lambertian("", sun(lamp)), false)
        .r;
  };
  const std::string keys = R"("intensity":{"keyframes":[[100,1],[102,3]],"by":"tau"})";
  EXPECT_FLOAT_EQ(at(keys, 0, -50), 1);
  EXPECT_FLOAT_EQ(at(keys, 0, 0.5f), 1.5f);
  EXPECT_FLOAT_EQ(at(keys, 0, 7), 3);
  const std::string by_t = R"("intensity":{"keyframes":[[-2,1],[0,5]],"by":"t"})";
  EXPECT_FLOAT_EQ(at(by_t, -1, 0), 3);
  for (const char* off : {"black", "transparent"}) {
    const std::string blink =
        R"("blink":{"channel":"tau","period":2,"duty":0.5,"off":")" + std::string(off) + "\"}";
    EXPECT_FLOAT_EQ(at(blink, 0, 0.5f), 1);
    EXPECT_EQ(at(blink, 0, 1.5f), 0);
  }
  const std::string flash =
      R"("intensity":0,"time_slices":[{"channel":"tau","from":101,"to":102,"intensity":4},
    {"channel":"t","from":5,"fade":[2,0],"intensity":2}])";
  EXPECT_EQ(at(flash, 0, 0.5f), 0);
  EXPECT_FLOAT_EQ(at(flash, 0, 1.5f), 4);
  EXPECT_EQ(at(flash, 0, 2), 0);
  EXPECT_FLOAT_EQ(at(flash, 5.5f, 0), 1.5f);  // three quarters have come
}

TEST(LitSurfaces, textures_are_albedos) {
  Dataset data = flat_map(36, 18);
  data = lit_by(std::move(data), {{"sun"}}, {{{static_cast<float>(std::numbers::pi), 1}}});
  const std::string board =
      R"("texture":{"type":"checkerboard","counts":[6,3],"colors":[[1,0.5,0],[0,0.25,1]],
    "rotate_deg":[10,20,30]})";
  const Image lit = picture(data, lambertian(board, sun("")));
  EXPECT_EQ(lit.display, picture(data, R"({"objects":{"earth":{)" + board + "}}}").display);
  // By a darker lamp, at the same exposure.
  const Image dim = picture(data, lambertian(board, sun(R"("intensity":0.5)")));
  EXPECT_FLOAT_EQ(dim.exposed[0].g, 0.5f * lit.exposed[0].g);
}

TEST(LitSurfaces, fade_blink_and_let_through_as_others_do) {
  TestHit front, back;
  front.opacity = 0.5f;
  front.t = 1;
  back.id = 2;
  const Dataset data = lit_by(one_pixel({front, back}, {{"earth"}, {"moon"}}), {{"sun"}},
                              {{{static_cast<float>(std::numbers::pi), 1}}});
  const auto level = [&](const std::string& earth, const std::string& moon) {
    const std::string lit = R"({"surface":{"type":"lambertian"},"texture":{"type":"color","rgb":[1,1,1]})";
    return light_of(data, R"({"objects":{"earth":)" + lit + earth + R"(},"moon":)" + lit + moon + "}}}",
                    false)
        .r;
  };
  EXPECT_FLOAT_EQ(level("", ""), 1);
  EXPECT_FLOAT_EQ(level(R"(,"intensity":3)", ""), 2);
  EXPECT_FLOAT_EQ(level("", R"(,"intensity":3)"), 2);
  EXPECT_FLOAT_EQ(level(R"(,"opacity":0.5)", R"(,"intensity":3)"), 0.25f + 0.75f * 3);
  EXPECT_FLOAT_EQ(level(R"(,"blink":{"channel":"t","period":2,"off":"transparent"})", R"(,"intensity":3)"),
                  3);
  EXPECT_FLOAT_EQ(level(R"(,"time_slices":[{"channel":"t","from":1,"fade":[4,0],"intensity":3}])", ""),
                  0.5f * 2 + 0.5f);
  EXPECT_FLOAT_EQ(level(R"(,"intensity":{"keyframes":[[0,1],[2,5]],"by":"t"})", ""), 2);
  EXPECT_FLOAT_EQ(level(R"(,"opacity":0)", R"(,"opacity":0)"), 0);
}

TEST(LitSurfaces, only_they_are_lit) {
  const Dataset data = under_sun(1, {{1}});
  const std::string red = R"("texture":{"type":"color","rgb":[1,0,0]})";
  EXPECT_EQ(light_of(data, R"({"objects":{"earth":{)" + red + "}}}", false), (Rgb{1, 0, 0}));
  EXPECT_EQ(light_of(data, lambertian(red, sun(R"("on":false)")), false), Rgb{});
}

TEST(LitSurfaces, senseless_numbers_are_dark) {
  const Rgb usual = light_of(under_sun(1, {{1}, {}}), lambertian("", sun(kHot)));
  const float nan = std::nanf("");
  for (const TestLight& path :
       {TestLight{1, 0}, {1, -1}, {1, nan}, {1, INFINITY}, {nan, 1}, {-1, 1}, {0, nan}})
    for (const char* more :
         {"", R"("spectrum":{"type":"constant","from_nm":300,"to_nm":1000,"radiance":0.5})"}) {
      EXPECT_EQ(light_of(under_sun(1, {path}), lambertian(more, sun(kHot))), Rgb{})
          << path.E << " " << path.shift;
      EXPECT_EQ(light_of(under_sun(-1, {path}), lambertian(more, sun(kHot))), Rgb{})
          << path.E << " " << path.shift;
    }
  EXPECT_EQ(light_of(under_sun(1, {{1}, {1, nan}}), lambertian("", sun(kHot))), usual);
}

TEST(LitSurfaces, pictures_do_not_depend_on_threads_and_instruction_sets) {
  const auto data = [] {
    Dataset out = make_dataset(150, 60, {{"earth"}, {"moon"}}, [](int column, int row) {
      TestHit near, far;
      near.u = far.v = static_cast<float>(column) / 150;
      near.opacity = row % 3 == 0 ? 1.0f : 0.6f;
      near.shift = 0.97f + 0.001f * static_cast<float>(row);
      far.id = 2;
      return row % 5 == 0 ? std::vector{far} : std::vector{near, far};
    });
    out = lit_by(std::move(out), {{"sun"}, {"fire"}}, {{{}, {}}, {{}, {}}});
    for (std::size_t path = 0; path < 4; ++path)
      for (std::size_t i = 0; i < out.hits.count(); ++i) {
        LightPath& light = out.hits.light[path];
        light.E[i] = static_cast<float>((i * (path + 3)) % 11) / 10;
        light.shift[i] = 0.98f + static_cast<float>(i % 7) / 100;
        light.tau[i] = static_cast<float>(i % 5);
      }
    return out;
  };
  const std::string look = R"({"objects":{"earth":{"surface":{"type":"lambertian"},"spectrum":
      {"type":"gaussian","centre_nm":600,"fwhm_nm":200}},"moon":{"surface":{"type":"lambertian"}}},
    "lights":{"sun":{"spectrum":{"type":"black_body","temperature_K":5762}},
      "fire":{"spectrum":{"type":"sum","of":[{"type":"lines","lines":[[589,1e4]]},{"type":"equal_energy"}]},
      "blink":{"channel":"tau","period":3}}}})";
  const auto made = [&](std::size_t threads, const Kernel& kernel) {
    const tbb::global_control limit(tbb::global_control::max_allowed_parallelism, threads);
    const Dataset dataset = data();
    const Look parsed = look_of(look, dataset.manifest);
    return Renderer(dataset, kernel).render(parsed);
  };
  const Image one = made(1, *kernels().front());
  for (const Kernel* kernel : kernels()) EXPECT_EQ(made(3, *kernel).exposed, one.exposed) << kernel->isa;
  EXPECT_NE(one.exposed.front(), one.exposed.back());
}

TEST(LitSurfaces, what_is_kept_of_other_looks_never_shows) {
  Dataset data = lit_by(flat_map(40, 20), {{"sun"}}, {{{2, 1}}});
  const std::string board =
      R"("texture":{"type":"checkerboard","counts":[6,3],"colors":[[1,0.5,0],[0,0.25,1]]})";
  const auto look = [&](const std::string& lamp) {
    return look_of(lambertian(board, sun(lamp) + R"(,"exposure":{"white_cd_m2":1e9})"), data.manifest);
  };
  Renderer renderer(data);
  for (const std::string& lamp : std::vector<std::string>{
           kHot, kHot + R"(,"intensity":2)", kHot + R"(,"intensity":3)", kHot, "", R"("on":false)", kHot}) {
    const Image kept = renderer.render(look(lamp)), fresh = Renderer(data).render(look(lamp));
    EXPECT_EQ(kept.exposed, fresh.exposed) << lamp;
  }
  // The textures of such looks are looked up once.
  const Shading one = renderer.prepare(look(kHot)),
                other = renderer.prepare(look(kHot + R"(,"blink":{"channel":"tau","period":2})"));
  EXPECT_FALSE(one == other);
  EXPECT_TRUE(keeps_colors(one) && keeps_colors(other) && same_textures(one, other));
  EXPECT_TRUE(one == renderer.prepare(look(kHot)));
}

TEST(LitSurfaces, samples_are_lit_one_by_one) {
  TestHit hit;
  Dataset data = make_dataset(1, 1, {{"earth"}}, [&](int, int) { return std::vector(4, hit); });
  data.manifest.samples = 2;
  data.hits.channels = data.hits.channels | ChannelSet::of("sample");
  data.hits.sample = {0, 1, 2, 3};
  data = lit_by(std::move(data), {{"sun"}}, {{{static_cast<float>(std::numbers::pi), 1}}});
  data.hits.light[0].E[2] = 0;
  EXPECT_FLOAT_EQ(picture(data, lambertian("", "")).exposed[0].r, 0.75f);
}

TEST(LitSurfaces, need_the_channels_of_light) {
  const Dataset data = under_sun(1, {{1}, {1}});
  const auto needs = [&](const std::string& look) {
    return needed_channels(look_of(look, data.manifest), data.manifest);
  };
  EXPECT_TRUE(needs(lambertian("", "")).has("light"));
  EXPECT_TRUE(needs(lambertian("", "")).has("shift"));
  for (const std::string& look :
       std::vector<std::string>{"{}", lambertian("", sun(R"("on":false)")),
                                lambertian("", sun(R"("paths":[])")), lambertian(R"("opacity":0)", "")})
    EXPECT_FALSE(needs(look).has("light")) << look;
  // Wavelengths come from the light, not from the surface.
  const std::string unbeamed = R"(,"effects":{"searchlight":false})";
  EXPECT_TRUE(needs(lambertian("", sun(kHot) + unbeamed)).has("shift"));
  EXPECT_FALSE(needs(lambertian("", sun("") + unbeamed)).has("shift"));
  const std::string missing = complaint([&] {
    check_channels(look_of(lambertian("", ""), data.manifest), data.manifest, kDefaultChannels, "a.exr");
  });
  EXPECT_NE(missing.find("a.exr: has no channel 'light', which the look needs for /objects/earth/surface"),
            std::string::npos)
      << missing;
}

TEST(LitSurfaces, tell_what_is_wrong) {
  const Dataset data = under_sun(2, {{1, 0.75f}});
  const auto notes = [](const Dataset& of, const std::string& look) {
    Renderer renderer(of);
    renderer.render(look_of(look, of.manifest, NULLCONE_TEST_DATA));
    std::string out;
    for (const std::string& note : renderer.notes()) out += note + "\n";
    return out;
  };
  EXPECT_EQ(notes(data, lambertian("", sun(kHot))), "");
  EXPECT_NE(notes(one_pixel({{}}), lambertian("", "")).find("/objects/earth/surface: nothing lights it"),
            std::string::npos);
  const std::string table = R"("spectrum":{"type":"tabulated","file":"green_on_wood.csv"})";
  const std::string unknown = notes(under_sun(0.5, {{1, 0.75f}}), lambertian("", sun(table)));
  EXPECT_NE(unknown.find("/lights/sun/spectrum: the spectrum is known from 300"), std::string::npos)
      << unknown;
  EXPECT_NE(unknown.find("shifts from 0.375"), std::string::npos) << unknown;
  const std::string paint = R"("spectrum":{"type":"equal_energy"})";
  for (const auto& [look, words] :
       {std::pair{lambertian(paint, ""),
                  "/lights/sun: needs a spectrum, because objects/earth has a reflectance"},
        {lambertian(paint, sun(kHot) + R"(,"ambient":{})"), "/ambient: needs a spectrum"},
        {lambertian(R"("spectrum":{"type":"rgb"})", ""), "/objects/earth/spectrum/type: the spectrum of a"},
        {lambertian(R"("spectrum":{"type":"lines","lines":[[500,1]]})", ""), "cannot have lines"},
        {lambertian(
             R"("spectrum":{"type":"black_body","temperature_K":{"keyframes":[[0,300],[1,400]],"by":"t"}})",
             ""),
         "has no temperature"},
        {std::string(R"({"objects":{"earth":{"surface":{"type":"mirror"}}}})"),
         "/objects/earth/surface/type"},
        {lambertian("", R"("ambient":{"intensity":-1})"), "/ambient/intensity"},
        {lambertian("", R"("ambient":{"spectrum":{"type":"rgb"}})"), "/ambient/spectrum/type"},
        {lambertian("", sun(R"("time_slices":[{"channel":"t","texture":{}}])")),
         "/lights/sun/time_slices/0/texture"},
        {lambertian("", R"("legend":{"scale":{"object":"earth"}})"), "/legend/scale/object"}}) {
    const std::string found = complaint([&] { look_of(look, data.manifest); });
    EXPECT_NE(found.find(words), std::string::npos) << look << ": " << found;
  }
}

}  // namespace
}  // namespace nullcone::postrender
