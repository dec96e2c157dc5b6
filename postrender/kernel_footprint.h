// How far the texture coordinates move from pixel to pixel, from the records alone.
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

/// Steps i of `scratch` lead from column i - 1 to i; the first and the last lead nowhere.
inline void steps_to_the_right(const postrender::Layer& line, std::size_t width,
                               const postrender::Footprints& out, float* __restrict scratch) {
  float* __restrict u = scratch;
  float* __restrict v = scratch + width + 1;
  float* __restrict square = scratch + 2 * (width + 1);
  u[0] = u[width] = v[0] = v[width] = 0;
  square[0] = square[width] = kNoNeighbour;
  for (std::size_t i = 1; i < width; ++i) {
    const Step step = step_between(line, i - 1, line, i);
    u[i] = step.u;
    v[i] = step.v;
    square[i] = step.square;
  }
  float* __restrict u_right = out.u_right;
  float* __restrict v_right = out.v_right;
  for (std::size_t i = 0; i < width; ++i) {
    const bool next = square[i + 1] < square[i];
    u_right[i] = next ? u[i + 1] : u[i];
    v_right[i] = next ? v[i + 1] : v[i];
  }
}

inline void steps_down(const std::array<postrender::Layer, 3>& lines, std::size_t width,
                       const postrender::Footprints& out) {
  float* __restrict u_down = out.u_down;
  float* __restrict v_down = out.v_down;
  const postrender::Layer above = lines[0], here = lines[1], below = lines[2];
  for (std::size_t i = 0; i < width; ++i) {
    const Step up = step_between(above, i, here, i), down = step_between(here, i, below, i);
    const bool next = down.square < up.square;
    u_down[i] = next ? down.u : up.u;
    v_down[i] = next ? down.v : up.v;
  }
}

void footprints(const std::array<postrender::Layer, 3>& lines, std::size_t width,
                const postrender::Footprints& out, float* scratch) {
  steps_to_the_right(lines[1], width, out, scratch);
  steps_down(lines, width, out);
}

NULLCONE_KERNEL_END
