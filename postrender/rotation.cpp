// Compiled once, for the baseline of the processor family: the same bits whatever the kernel.
#include "postrender/rotation.h"

#include <cmath>
#include <numbers>

#include "postrender/kernel_direction.h"

NULLCONE_KERNEL_BEGIN

/// atan2(y, x) / 2 pi, within 3e-8; 0 for (0, 0).
inline float turns_of(float y, float x) {
  const float ax = __builtin_fabsf(x), ay = __builtin_fabsf(y);
  const bool steep = ay > ax;
  const float small = steep ? ax : ay, large = steep ? ay : ax;
  const float slope = small / (large > 1e-30f ? large : 1e-30f);
  const bool wide = slope > 0.41421356f;
  const float a = wide ? (slope - 1) / (slope + 1) : slope, aa = a * a;
  const float series =
      a + a * aa *
              (-3.33329491539e-1f +
               aa * (1.99777106478e-1f + aa * (-1.38776856032e-1f + aa * 8.05374449538e-2f)));
  const float eighth = (wide ? 0.125f : 0.0f) + series * 0.15915494309f;
  const float quarter = steep ? 0.25f - eighth : eighth;
  const float half = x < 0 ? 0.5f - quarter : quarter;
  return y < 0 ? -half : half;
}

template <class Entry>
inline Point turned(const Entry& m, std::size_t i, const Point& p) {
  return {m(0, i) * p.x + m(1, i) * p.y + m(2, i) * p.z, m(3, i) * p.x + m(4, i) * p.y + m(5, i) * p.z,
          m(6, i) * p.x + m(7, i) * p.y + m(8, i) * p.z};
}

inline float longitude(const Point& p) { return 0.5f + turns_of(p.y, p.x); }
inline float distance_from_axis(const Point& p) { return __builtin_sqrtf(p.x * p.x + p.y * p.y); }
inline float latitude(const Point& p) { return 0.5f + 2 * turns_of(p.z, distance_from_axis(p)); }

inline float bounded(float x) {
  const float above = x > -kFarthest ? x : -kFarthest;
  return above < kFarthest ? above : kFarthest;
}

/// Steps as derivatives, exact also at the poles: there a longitude changes without bound.
template <class Entry>
void turn_derivatives(const Entry& m, std::size_t count, const float* __restrict u, const float* __restrict v,
                      float* __restrict du, float* __restrict dv) {
  for (std::size_t i = 0; i < count; ++i) {
    const Frame at = frame_at(u[i], v[i]);
    const Point p = turned(m, i, at.p), d = turned(m, i, step_along(at, du[i], dv[i]));
    const float r = distance_from_axis(p);
    const bool off_axis = r > 1e-6f;
    const float far = off_axis ? r : 1e-6f;
    const float cosine = off_axis ? p.x / far : 1.0f, sine = off_axis ? p.y / far : 0.0f;
    const float east = (cosine * d.y - sine * d.x) / (kTurn * far);
    const float north = (r * d.z - p.z * (cosine * d.x + sine * d.y)) / (0.5f * kTurn);
    const bool sure = known(du[i], dv[i]);
    du[i] = sure ? bounded(east) : kFarthest;
    dv[i] = sure ? bounded(north) : kFarthest;
  }
}

/// Steps as differences: from where the pixel's point is seen in the texture, (u_there, v_there), to where
/// its neighbour's is.
template <class Entry>
void turn_differences(const Entry& m, std::size_t count, const float* __restrict u, const float* __restrict v,
                      const float* __restrict u_there, const float* __restrict v_there, float* __restrict du,
                      float* __restrict dv) {
  for (std::size_t i = 0; i < count; ++i) {
    const Point to = turned(m, i, frame_at(u[i] + du[i], v[i] + dv[i]).p);
    const float east = longitude(to) - u_there[i];
    du[i] = east - nearest_of(east);
    dv[i] = latitude(to) - v_there[i];
  }
}

template <class Entry>
void turn_points(const Entry& m, std::size_t count, const float* __restrict u, const float* __restrict v,
                 float* __restrict u_there, float* __restrict v_there) {
  for (std::size_t i = 0; i < count; ++i) {
    const Point p = turned(m, i, frame_at(u[i], v[i]).p);
    u_there[i] = longitude(p);
    v_there[i] = latitude(p);
  }
}

/// Whole turns of u mean nothing, and would cost digits.
inline void bring_near(std::size_t count, float* __restrict u, float* __restrict v) {
  for (std::size_t i = 0; i < count; ++i) {
    const float x = finite_or_zero(u[i]);
    u[i] = x - floor_of(x);
    v[i] = finite_or_zero(v[i]);
  }
}

template <class Entry>
void turn_all(const Entry& m, std::size_t count, float* u, float* v, const postrender::Footprints& steps,
              bool recorded) {
  float u_there[postrender::kSegment], v_there[postrender::kSegment];
  bring_near(count, u, v);
  turn_points(m, count, u, v, u_there, v_there);
  if (steps.u_right != nullptr && recorded) {
    turn_derivatives(m, count, u, v, steps.u_right, steps.v_right);
    turn_derivatives(m, count, u, v, steps.u_down, steps.v_down);
  } else if (steps.u_right != nullptr) {
    turn_differences(m, count, u, v, u_there, v_there, steps.u_right, steps.v_right);
    turn_differences(m, count, u, v, u_there, v_there, steps.u_down, steps.v_down);
  }
  __builtin_memcpy(u, u_there, count * sizeof(float));
  __builtin_memcpy(v, v_there, count * sizeof(float));
}

NULLCONE_KERNEL_END

namespace nullcone::postrender {

namespace {

using Matrix = std::array<std::array<double, 3>, 3>;

/// Right-handed, about an axis of length 1 (Rodrigues).
Matrix about(const std::array<double, 3>& axis, double angle_deg) {
  const double angle = std::remainder(angle_deg, 360) * (std::numbers::pi / 180);
  const double s = std::sin(angle), c = std::cos(angle);
  Matrix out;
  for (std::size_t i = 0; i < 3; ++i)
    for (std::size_t j = 0; j < 3; ++j) out[i][j] = (i == j ? c : 0) + (1 - c) * axis[i] * axis[j];
  for (std::size_t i = 0; i < 3; ++i) {
    const std::size_t j = (i + 1) % 3, k = (i + 2) % 3;
    out[k][j] += s * axis[i];
    out[j][k] -= s * axis[i];
  }
  return out;
}

Matrix times(const Matrix& a, const Matrix& b) {
  Matrix out{};
  for (std::size_t i = 0; i < 3; ++i)
    for (std::size_t j = 0; j < 3; ++j)
      for (std::size_t k = 0; k < 3; ++k) out[i][j] += a[i][k] * b[k][j];
  return out;
}

}  // namespace

bool Rotation::about_z() const {
  if (axis) return (*axis)[0] == 0 && (*axis)[1] == 0;
  return about_deg[0].always(0) && about_deg[1].always(0);
}

double Rotation::turn(const Times& at) const {
  const double turns =
      axis ? std::copysign(1.0, (*axis)[2]) * about_deg[0].at(at) / 360 : about_deg[2].at(at) / 360;
  const double part = turns - std::floor(turns);
  return part < 1 ? part : 0;
}

bool Rotation::changes() const { return about_deg[0].keys || about_deg[1].keys || about_deg[2].keys; }

std::array<float, 9> Rotation::to_texture(const Times& at) const {
  const Matrix R =
      axis ? about(*axis, about_deg[0].at(at))
           : times(about({0, 0, 1}, about_deg[2].at(at)),
                   times(about({0, 1, 0}, about_deg[1].at(at)), about({1, 0, 0}, about_deg[0].at(at))));
  std::array<float, 9> out;
  for (std::size_t i = 0; i < 3; ++i)
    for (std::size_t j = 0; j < 3; ++j) out[3 * i + j] = static_cast<float>(R[j][i]);
  return out;
}

void rotate(const Matrices& matrices, std::size_t count, float* u, float* v, const Footprints& steps,
            bool recorded) {
  if (matrices.each == nullptr) {
    const auto all = [m = matrices.all](std::size_t entry, std::size_t) { return m[entry]; };
    host::turn_all(all, count, u, v, steps, recorded);
  } else {
    const auto each = [m = matrices.each->data()](std::size_t entry, std::size_t i) { return m[entry][i]; };
    host::turn_all(each, count, u, v, steps, recorded);
  }
}

}  // namespace nullcone::postrender
