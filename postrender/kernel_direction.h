// Directions from the texture coordinates of a sphere: u the longitude, 1/2 at +x and growing towards +y; v
// the latitude, 0 at -z and 1 at +z.
#pragma once

#include "postrender/lanes.h"

NULLCONE_KERNEL_BEGIN

constexpr float kTurn = 6.2831853072f;

struct Point {
  float x, y, z;
};

struct SineCosine {
  float sine, cosine;
};

/// Of 2 pi x, |x| < 1e5: polynomials on an eighth of a turn (Cephes), within 1e-7.
inline SineCosine of_turns(float x) {
  const float quarter = nearest_of(4 * x);
  const float a = (4 * x - quarter) * 1.5707963268f, aa = a * a;
  const float s = a + a * aa * (-1.6666654611e-1f + aa * (8.3321608736e-3f + aa * -1.9515295891e-4f));
  const float c =
      1 - 0.5f * aa +
      aa * aa * (4.166664568298827e-2f + aa * (-1.388731625493765e-3f + aa * 2.443315711809948e-5f));
  const auto q = static_cast<std::int32_t>(quarter);
  const bool swapped = (q & 1) != 0;
  const float sine = swapped ? c : s, cosine = swapped ? s : c;
  return {(q & 2) != 0 ? -sine : sine, ((q + 1) & 2) != 0 ? -cosine : cosine};
}

/// The direction of (u, v), and the derivatives that its change along both needs.
struct Frame {
  Point p;
  float sine, cosine, low;  ///< of the longitude; of the latitude the cosine
};
inline Frame frame_at(float u, float v) {
  const float within = v > 0 ? v : 0.0f, latitude = 0.5f * (within < 1 ? within : 1.0f) - 0.25f;
  const SineCosine along = of_turns(u - 0.5f), up = of_turns(latitude);
  return {{up.cosine * along.cosine, up.cosine * along.sine, up.sine}, along.sine, along.cosine, up.cosine};
}

/// How far the direction moves where (u, v) moves at this rate.
inline Point step_along(const Frame& at, float du, float dv) {
  const float along = kTurn * at.low * du, up = 0.5f * kTurn * dv;
  return {-along * at.sine - up * at.p.z * at.cosine, along * at.cosine - up * at.p.z * at.sine, up * at.low};
}

inline bool known(float du, float dv) {
  return (__builtin_fabsf(du) < kFarthest) & (__builtin_fabsf(dv) < kFarthest);
}

NULLCONE_KERNEL_END
