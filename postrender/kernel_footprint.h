// How far the texture coordinates move from pixel to pixel: as recorded (duv), or else from neighbouring
// records.
//
// A neighbour counts when its crossing of the same rank met the same object by an image of the same order. Of
// the two neighbours along a direction the nearer one in (u, v) is taken, so that the edge between two images
// of an object does not look like a steep texture. Where no neighbour counts, the step is zero.
#pragma once

#include "postrender/kernel.h"
#include "postrender/lanes.h"

NULLCONE_KERNEL_BEGIN

struct Step {
  float u, v, square;
};

constexpr float kNoNeighbour = __builtin_inff();

/// From column i of one scan line to column j of another.
inline Step step_between(const postrender::Layer& a, std::size_t i, const postrender::Layer& b,
                         std::size_t j) {
  const bool counts = (a.id[i] == b.id[j]) & (a.order[i] == b.order[j]);
  const float u = b.u[j] - a.u[i];
  // The seam: u = 0 and u = 1 are the same line.
  const float du = u - nearest_of(u), dv = b.v[j] - a.v[i];
  return {counts ? du : 0.0f, counts ? dv : 0.0f, counts ? du * du + dv * dv : kNoNeighbour};
}

inline void steps_to_the_right(const postrender::Layer& line, std::size_t width, std::size_t first,
                               std::size_t count, const postrender::Footprints& out) {
  // Step i leads from column first + i - 1 to first + i; those over the ends of the line lead nowhere.
  float u[postrender::kSegment + 1], v[postrender::kSegment + 1], square[postrender::kSegment + 1];
  u[0] = u[count] = v[0] = v[count] = 0;
  square[0] = square[count] = kNoNeighbour;
  const std::size_t last = first + count < width ? count : count - 1;
  for (std::size_t i = first == 0 ? 1 : 0; i <= last; ++i) {
    const Step step = step_between(line, first + i - 1, line, first + i);
    u[i] = step.u;
    v[i] = step.v;
    square[i] = step.square;
  }
  float* __restrict u_right = out.u_right;
  float* __restrict v_right = out.v_right;
  for (std::size_t i = 0; i < count; ++i) {
    const bool next = square[i + 1] < square[i];
    u_right[i] = next ? u[i + 1] : u[i];
    v_right[i] = next ? v[i + 1] : v[i];
  }
}

inline void steps_down(const std::array<postrender::Layer, 3>& lines, std::size_t first, std::size_t count,
                       const postrender::Footprints& out) {
  // First here, because the compiler cannot tell the results from so many columns and would not make a vector
  // loop.
  float u[postrender::kSegment], v[postrender::kSegment];
  const postrender::Layer above = lines[0], here = lines[1], below = lines[2];
  for (std::size_t i = 0; i < count; ++i) {
    const std::size_t at = first + i;
    const Step up = step_between(above, at, here, at), down = step_between(here, at, below, at);
    const bool next = down.square < up.square;
    u[i] = next ? down.u : up.u;
    v[i] = next ? down.v : up.v;
  }
  __builtin_memcpy(out.u_down, u, count * sizeof(float));
  __builtin_memcpy(out.v_down, v, count * sizeof(float));
}

void footprints(const std::array<postrender::Layer, 3>& lines, std::size_t width, std::size_t first,
                std::size_t count, const postrender::Footprints& out) {
  steps_to_the_right(lines[1], width, first, count, out);
  steps_down(lines, first, count, out);
}

/// Unknown steps (infinite or not numbers) become endless ones: they blur a texture fully.
inline void bounded_steps(const float* __restrict recorded, std::size_t count, float* __restrict out) {
  for (std::size_t i = 0; i < count; ++i) {
    const bool known = __builtin_fabsf(recorded[i]) < kFarthest;
    out[i] = known ? recorded[i] : kFarthest;
  }
}

void recorded_footprints(const postrender::Layer& line, std::size_t first, std::size_t count,
                         const postrender::Footprints& out) {
  bounded_steps(line.duv[0] + first, count, out.u_right);
  bounded_steps(line.duv[1] + first, count, out.v_right);
  bounded_steps(line.duv[2] + first, count, out.u_down);
  bounded_steps(line.duv[3] + first, count, out.v_down);
}

NULLCONE_KERNEL_END
