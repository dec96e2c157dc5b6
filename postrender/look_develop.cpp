#include "postrender/look_develop.h"

#include <nlohmann/json.hpp>

namespace nullcone::postrender {

namespace {

void parse_exposure(JsonObject in, DevelopLook& develop) {
  if (in.has("white_cd_m2")) {
    const nlohmann::json& white = in.at("white_cd_m2");
    if (white.is_string() && white == "auto") {
      develop.white_cd_m2.reset();
    } else if (white.is_number()) {
      develop.white_cd_m2 = in.number("white_cd_m2", 1e-20, 1e20);
    } else {
      in.refuse("white_cd_m2", "expected a number in cd/m^2, or \"auto\"");
    }
  } else {
    in.note("white_cd_m2", "auto");
  }
  develop.ev = in.number_or("ev", 0, -64, 64);
  in.finish();
}

void parse_tone(JsonObject in, DevelopLook& develop) {
  if (in.word("curve", {"linear", "exponential"}, "linear") == "exponential") {
    develop.curve = DevelopLook::Curve::exponential;
    develop.k = in.number_or("k", 1, 1e-6, 1e6);
  }
  in.finish();
}

}  // namespace

DevelopLook parse_develop(JsonObject& look) {
  DevelopLook out;
  parse_exposure(look.object_or_empty("exposure"), out);
  parse_tone(look.object_or_empty("tone"), out);
  if (look.word("gamut", {"hue_preserving", "clip"}, "hue_preserving") == "clip")
    out.gamut = DevelopLook::Gamut::clip;
  return out;
}

}  // namespace nullcone::postrender
