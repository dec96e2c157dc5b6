#include "postrender/icc_profile.h"

#include <lcms2.h>

#include <algorithm>
#include <array>
#include <memory>
#include <string>

#include "core/base/error.h"
#include "postrender/color_space.h"

namespace nullcone::postrender {

namespace {

struct Close {
  void operator()(void* profile) const { cmsCloseProfile(profile); }
  void operator()(cmsToneCurve* curve) const { cmsFreeToneCurve(curve); }
  void operator()(cmsMLU* text) const { cmsMLUfree(text); }
};
using Profile = std::unique_ptr<void, Close>;
using Curve = std::unique_ptr<cmsToneCurve, Close>;

Curve transfer_curve(bool linear) {
  // The parameters of a "type 4" curve: Y = (a X + b)^g from d on, c X below.
  constexpr std::array<double, 5> kSrgb = {2.4, 1 / 1.055, 0.055 / 1.055, 1 / 12.92, 0.04045};
  return Curve(linear ? cmsBuildGamma(nullptr, 1) : cmsBuildParametricToneCurve(nullptr, 4, kSrgb.data()));
}

void describe(const Profile& profile, const std::string& text) {
  const std::unique_ptr<cmsMLU, Close> description(cmsMLUalloc(nullptr, 1));
  cmsMLUsetASCII(description.get(), "en", "US", text.c_str());
  cmsWriteTag(profile.get(), cmsSigProfileDescriptionTag, description.get());
}

cmsCIExyY xyY(const Chromaticity& c) { return {c.x, c.y, 1}; }

std::vector<std::uint8_t> bytes_of(const Profile& profile) {
  cmsUInt32Number size = 0;
  std::vector<std::uint8_t> out;
  if (profile && cmsSaveProfileToMem(profile.get(), nullptr, &size)) out.resize(size);
  if (out.empty() || !cmsSaveProfileToMem(profile.get(), out.data(), &size))
    throw WorkError("ICC profile", "cannot be made");
  // The header's date of creation, which would make every file another one: the first of January 2000.
  constexpr std::array<std::uint8_t, 12> kDate = {0x07, 0xd0, 0, 1, 0, 1};
  std::ranges::copy(kDate, out.begin() + 24);
  return out;
}

}  // namespace

std::vector<std::uint8_t> icc_profile(OutputSpace space, bool linear) {
  if (space == OutputSpace::xyz) return {};
  const Primaries p = primaries_of(space);
  const cmsCIExyY white = xyY(p.white);
  const cmsCIExyYTRIPLE primaries = {xyY(p.red), xyY(p.green), xyY(p.blue)};
  const Curve curve = transfer_curve(linear);
  const std::array<cmsToneCurve*, 3> curves = {curve.get(), curve.get(), curve.get()};
  const Profile profile(cmsCreateRGBProfile(&white, &primaries, curves.data()));
  const std::string name = space == OutputSpace::display_p3 ? "Display P3" : linear ? "Rec. 709" : "sRGB";
  if (profile) describe(profile, linear ? "Linear " + name : name);
  return bytes_of(profile);
}

}  // namespace nullcone::postrender
