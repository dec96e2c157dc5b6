#include "postrender/placement.h"

#include <algorithm>
#include <cmath>

namespace nullcone::postrender {

namespace {

constexpr double kFarthest = 1e6;  ///< as in lanes.h

void rotate_in_space(const Rotation& rotation, std::span<const Times> times, const Coordinates& out) {
  if (!rotation.changes()) {
    rotate({rotation.to_texture({})}, out.count, out.u, out.v, out.steps, out.recorded);
    return;
  }
  std::array<std::array<float, kSegment>, 9> matrices;
  for (std::size_t i = 0; i < out.count; ++i) {
    const std::array<float, 9> matrix = rotation.to_texture(times[i]);
    for (std::size_t k = 0; k < 9; ++k) matrices[k][i] = matrix[k];
  }
  rotate({{}, &matrices}, out.count, out.u, out.v, out.steps, out.recorded);
}

/// A placement at one instant.
struct Now {
  double turn;
  std::array<double, 2> scale, offset;
};

Now at(const Placement& placement, const Times& times, bool turns) {
  return {turns ? placement.rotation->turn(times) : 0,
          {placement.scale[0].at(times), placement.scale[1].at(times)},
          {placement.offset[0].at(times), placement.offset[1].at(times)}};
}

double part_of_one(double x) { return x - std::floor(x); }

/// Never more than kFarthest, and never 0 times what is unknown.
float scaled(float step, double scale) {
  if (!(static_cast<double>(std::abs(step)) < kFarthest)) return step;
  return static_cast<float>(std::clamp(static_cast<double>(step) * scale, -kFarthest, kFarthest));
}

}  // namespace

std::optional<UvTransform> Placement::plain() const {
  for (const Number* number : {&offset[0], &offset[1], &scale[0], &scale[1]})
    if (number->keys) return {};
  double moved = offset[0].constant;
  if (rotation) {
    // Whole turns vanish only where the texture goes round a whole number of times.
    const double around = scale[0].constant;
    if (!rotation->about_z() || rotation->changes() || around != std::floor(around)) return {};
    moved = part_of_one(moved - around * rotation->turn({}));
  }
  return UvTransform{{static_cast<float>(moved), static_cast<float>(offset[1].constant)},
                     {static_cast<float>(scale[0].constant), static_cast<float>(scale[1].constant)}};
}

Clocks Placement::clocks() const {
  Clocks out;
  for (std::size_t i = 0; i < 2; ++i) {
    out.add(offset[i]);
    out.add(scale[i]);
  }
  if (rotation)
    for (const Number& angle : rotation->about_deg) out.add(angle);
  return out;
}

void place(const Placement& placement, std::span<const Times> times, const Coordinates& out) {
  const bool turns = placement.rotation && placement.rotation->about_z();
  if (placement.rotation && !turns) rotate_in_space(*placement.rotation, times, out);
  const bool changes = placement.clocks().any();
  Now now = at(placement, {}, turns);
  for (std::size_t i = 0; i < out.count; ++i) {
    if (changes) now = at(placement, times[i], turns);
    const auto u = static_cast<double>(out.u[i]), v = static_cast<double>(out.v[i]);
    const double turned = part_of_one((std::abs(u) < kFarthest ? u : 0) - now.turn);
    out.u[i] = static_cast<float>(part_of_one(turned * now.scale[0] + now.offset[0]));
    out.v[i] = static_cast<float>(v * now.scale[1] + now.offset[1]);
    if (out.steps.u_right == nullptr) continue;
    for (float* step : {out.steps.u_right, out.steps.u_down}) step[i] = scaled(step[i], now.scale[0]);
    for (float* step : {out.steps.v_right, out.steps.v_down}) step[i] = scaled(step[i], now.scale[1]);
  }
}

}  // namespace nullcone::postrender
