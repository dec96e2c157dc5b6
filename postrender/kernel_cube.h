// Cube maps along a run of pixels: looked up by direction, on faces with a border of one texel (cube_map.h).
#pragma once

#include "postrender/kernel_direction.h"
#include "postrender/kernel_texture.h"

NULLCONE_KERNEL_BEGIN

inline float dot(const float* axis, const Point& p) { return axis[0] * p.x + axis[1] * p.y + axis[2] * p.z; }

/// The face through which a direction is seen: the one whose middle is the nearest.
inline std::int32_t face_of(const postrender::CubeView& cube, const Point& p) {
  std::int32_t face = 0;
  float most = dot(cube.faces[0].ahead, p);
  for (std::int32_t i = 1; i < 6; ++i) {
    const float ahead = dot(cube.faces[i].ahead, p);
    face = ahead > most ? i : face;
    most = ahead > most ? ahead : most;
  }
  return face;
}

/// Look-ups of a block: the face, the place on it from -1 to 1 to the right and down, and the level.
struct CubeLookUps {
  std::int32_t face[kBlock];
  float right[kBlock], down[kBlock], level[kBlock];
};

/// The square of how far the place on a face moves, in its half widths, where the direction moves by `step`.
inline float moved(const postrender::CubeFaceView& face, float right, float down, float ahead,
                   const Point& step) {
  const float away = dot(face.ahead, step);
  const float r = (dot(face.right, step) - right * away) / ahead;
  const float d = (dot(face.down, step) - down * away) / ahead;
  return r * r + d * d;
}

inline Point step_of(const Frame& at, float u, float v, float du, float dv, bool recorded) {
  if (recorded) return step_along(at, du, dv);
  const Point to = frame_at(u + du, v + dv).p;
  return {to.x - at.p.x, to.y - at.p.y, to.z - at.p.z};
}

inline void place_on_cube(const postrender::CubeView& cube, const postrender::Run& run, std::size_t first,
                          std::size_t count, CubeLookUps& out) {
  const float half = 0.5f * static_cast<float>(cube.levels[0].width - 2), last_level = cube.last_level;
  const postrender::Footprints& f = run.footprints;
  for (std::size_t i = 0; i < count; ++i) {
    const std::size_t at = first + i;
    const float all_u = finite_or_zero(run.u[at]), u = all_u - floor_of(all_u), v = finite_or_zero(run.v[at]);
    const Frame frame = frame_at(u, v);
    const std::int32_t number = face_of(cube, frame.p);
    const postrender::CubeFaceView& face = cube.faces[number];
    const float ahead = dot(face.ahead, frame.p);
    const float right = dot(face.right, frame.p) / ahead, down = dot(face.down, frame.p) / ahead;
    out.face[i] = number;
    out.right[i] = right < -1 ? -1.0f : right > 1 ? 1.0f : right;
    out.down[i] = down < -1 ? -1.0f : down > 1 ? 1.0f : down;
    out.level[i] = 0;
    if (!cube.mipmap) continue;
    if (!known(f.u_right[at], f.v_right[at]) || !known(f.u_down[at], f.v_down[at])) {
      out.level[i] = last_level;
      continue;
    }
    const float a =
        moved(face, right, down, ahead, step_of(frame, u, v, f.u_right[at], f.v_right[at], cube.recorded));
    const float b =
        moved(face, right, down, ahead, step_of(frame, u, v, f.u_down[at], f.v_down[at], cube.recorded));
    const float longest = (a < b ? b : a) * half * half;
    const float level = half_log2(longest > 1 ? longest : 1.0f);
    out.level[i] = level < last_level ? level : last_level;
  }
}

/// Where the four texels around a look-up stand in a level, whose faces have a border of one texel.
inline void find_corner(const postrender::CubeView& cube, const CubeLookUps& at, std::size_t i,
                        std::int32_t level, Corners& out) {
  constexpr std::int32_t kLast = postrender::kTile - 1;
  const postrender::LevelView& view = cube.levels[6 * level + at.face[i]];
  const auto side = static_cast<float>(view.width - 2);
  const float x = (0.5f * at.right[i] + 0.5f) * side + 0.5f, y = (0.5f * at.down[i] + 0.5f) * side + 0.5f;
  const auto column = static_cast<std::int32_t>(x), row = static_cast<std::int32_t>(y);
  out.s[i] = x - static_cast<float>(column);
  out.t[i] = y - static_cast<float>(row);
  out.place[i] = view.first + (column >> 3) * postrender::kTileTexels + (column & kLast) +
                 (row >> 3) * view.row_of_tiles + (row & kLast) * postrender::kTileRow;
}

void cube_colors(const postrender::CubeView& cube, const postrender::Run& run, postrender::Rgbx* out) {
  static_assert(postrender::kTile == 8);
  CubeLookUps at;
  Corners fine, coarse;
  for (std::size_t first = 0; first < run.count; first += kBlock) {
    const std::size_t count = run.count - first < kBlock ? run.count - first : kBlock;
    place_on_cube(cube, run, first, count, at);
    for (std::size_t i = 0; i < count; ++i) {
      const auto level = static_cast<std::int32_t>(at.level[i]);
      find_corner(cube, at, i, level, fine);
      if (static_cast<float>(level) != at.level[i]) find_corner(cube, at, i, level + 1, coarse);
    }
    fetch_early(cube.texels, fine, 0, count);
    for (std::size_t i = 0; i < count; ++i) {
      const auto level = static_cast<float>(static_cast<std::int32_t>(at.level[i]));
      store(cube.unit * (level != at.level[i] ? trilinear(cube.texels, fine, coarse, i, at.level[i] - level)
                                              : bilinear(cube.texels, fine, i)),
            out + first + i);
    }
  }
}

NULLCONE_KERNEL_END
