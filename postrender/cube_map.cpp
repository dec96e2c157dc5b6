#include "postrender/cube_map.h"

#include <algorithm>
#include <cmath>
#include <span>

#include "core/base/error.h"
#include "core/base/faces.h"
#include "postrender/texture_file.h"

namespace nullcone::postrender {

namespace {

using Direction = host::Vec3<double>;

/// The direction of a place on a face: 0 to 1 to the right and down, or a little beyond.
Direction direction_of(std::size_t face, double right, double down) {
  const host::Face& of = host::kCube.face[face];
  return of.corner + right * of.right + down * of.down;
}

/// The face that is seen in a direction, and the place on it.
struct FacePlace {
  std::size_t face;
  double right, down;
};
FacePlace place_of(const Direction& direction) {
  const auto place = host::place_on_faces(host::kCube, direction);
  const double along = 6 * (0.5 - place[0]), face = std::clamp(std::floor(along), 0.0, 5.0);
  return {static_cast<std::size_t>(face), along - face, 0.5 - place[1]};
}

/// An edge of a face, as parts of the face.
struct Edge {
  double right, down;              ///< of its first end
  double along_right, along_down;  ///< from end to end
  double out_right, out_down;      ///< outwards
};
constexpr std::array<Edge, 4> kEdges = {
    {{0, 0, 1, 0, 0, -1}, {0, 1, 1, 0, 0, 1}, {0, 0, 0, 1, -1, 0}, {1, 0, 0, 1, 1, 0}}};

/// Colours of the row of texels beside an edge, linear between their centres.
Rgb beside_edge(const TextureLevel& face, const Edge& edge, double along) {
  const int n = face.width;
  const double at = std::clamp(along * n - 0.5, 0.0, n - 1.0);
  const int low = std::min(static_cast<int>(at), std::max(n - 2, 0)), high = std::min(low + 1, n - 1);
  const auto texel = [&](int k) {
    const int i = edge.along_right > 0 ? k : edge.out_right > 0 ? n - 1 : 0;
    const int j = edge.along_down > 0 ? k : edge.out_down > 0 ? n - 1 : 0;
    return face.texel(i, j);
  };
  return mix(texel(low), texel(high), static_cast<float>(at - low));
}

/// The edge of a face on which a place lies that is just within it.
const Edge& edge_at(const FacePlace& place) {
  const std::array<double, 4> distance = {place.down, 1 - place.down, place.right, 1 - place.right};
  return kEdges[static_cast<std::size_t>(std::ranges::min_element(distance) - distance.begin())];
}

/// The colour on an edge at its node k, between two texels of one face and two of the other. Texels' centres
/// lie nearer to the corner of the cube than the node does, in the ratio of their depths: so look aside.
Rgb on_edge(const CubeFaces& level, std::size_t face, const Edge& edge, int k) {
  constexpr double kOut = 1e-9;
  const int n = level[0].width;
  const double along = (k + 0.5) / n, drawn_in = 0.5 + (along - 0.5) * (1 - 0.5 / n);
  const FacePlace there =
      place_of(direction_of(face, edge.right + along * edge.along_right + kOut * edge.out_right,
                            edge.down + along * edge.along_down + kOut * edge.out_down));
  const Edge& other = edge_at(there);
  const double along_other = other.along_right > 0 ? there.right : there.down;
  const bool turned = (along_other - 0.5) * (along - 0.5) < 0;
  return 0.5f * (beside_edge(level[face], edge, drawn_in) +
                 beside_edge(level[there.face], other, turned ? 1 - drawn_in : drawn_in));
}

/// The colour in a corner of the cube: of three faces.
Rgb in_corner(const CubeFaces& level, std::size_t face, int right, int down) {
  constexpr double kOut = 1e-9;
  const int n = level[0].width;
  const auto texel = [&](const FacePlace& place) {
    return level[place.face].texel(place.right > 0.5 ? n - 1 : 0, place.down > 0.5 ? n - 1 : 0);
  };
  const double r = right, d = down, out_r = 2 * r - 1, out_d = 2 * d - 1;
  // Each of the two leaves the face across one edge alone.
  const FacePlace beside = place_of(direction_of(face, r + kOut * out_r, d - 3 * kOut * out_d));
  const FacePlace beyond = place_of(direction_of(face, r - 3 * kOut * out_r, d + kOut * out_d));
  return (1.0f / 3) * (texel({face, r, d}) + texel(beside) + texel(beyond));
}

/// A face with its border. On the edge, halfway between the border and the outermost texels, stands what both
/// faces have in common, and in the corner what all three have.
TextureLevel bordered(const CubeFaces& level, std::size_t face) {
  const TextureLevel& inner = level[face];
  const int n = inner.width;
  TextureLevel out{n + 2, n + 2, {}};
  out.texels.resize(static_cast<std::size_t>((n + 2) * (n + 2)));
  for (int j = 0; j < n; ++j)
    for (int i = 0; i < n; ++i) out.texels[out.place(i + 1, j + 1)] = inner.texel(i, j);
  for (const Edge& edge : kEdges)
    for (int k = 0; k < n; ++k) {
      const int i = edge.along_right > 0 ? k + 1 : edge.out_right > 0 ? n + 1 : 0;
      const int j = edge.along_down > 0 ? k + 1 : edge.out_down > 0 ? n + 1 : 0;
      const Rgb inside = out.texel(i - static_cast<int>(edge.out_right), j - static_cast<int>(edge.out_down));
      out.texels[out.place(i, j)] = 2.0f * on_edge(level, face, edge, k) - inside;
    }
  for (const int right : {0, 1})
    for (const int down : {0, 1}) {
      const int i = right * (n + 1), j = down * (n + 1), in_i = right ? n : 1, in_j = down ? n : 1;
      out.texels[out.place(i, j)] = 4.0f * in_corner(level, face, right, down) - out.texel(in_i, in_j) -
                                    out.texel(in_i, j) - out.texel(i, in_j);
    }
  return out;
}

TextureLevel part_of(const TextureLevel& strip, int face) {
  const int n = strip.height;
  TextureLevel out{n, n, {}};
  for (int j = 0; j < n; ++j)
    for (int i = 0; i < n; ++i) out.texels.push_back(strip.texel(face * n + i, j));
  return out;
}

std::string size_of(const TextureLevel& picture) {
  return std::to_string(picture.width) + " x " + std::to_string(picture.height);
}

}  // namespace

CubeFaces read_cube_faces(const std::vector<std::string>& files, const std::vector<std::string>& pointers) {
  CubeFaces out;
  if (files.size() == 1) {
    const TextureLevel strip = read_texture(files[0], pointers[0]);
    if (strip.width != 6 * strip.height)
      throw InputError(files[0] + ": " + pointers[0],
                       "is " + size_of(strip) + "; expected six square faces side by side, 6 n x n");
    for (int face = 0; face < 6; ++face) out[static_cast<std::size_t>(face)] = part_of(strip, face);
    return out;
  }
  for (std::size_t face = 0; face < 6; ++face) {
    out[face] = read_texture(files[face], pointers[face]);
    const int n = out[0].width;
    if (out[face].width != n || out[face].height != n)
      throw InputError(files[face] + ": " + pointers[face],
                       "is " + size_of(out[face]) + "; expected a square, as large as all other faces");
  }
  return out;
}

Pyramid make_cube(CubeFaces faces) {
  const int exponent = normalising_exponent(faces);
  std::array<std::vector<TextureLevel>, 6> halved;
  for (std::size_t face = 0; face < 6; ++face) halved[face] = halvings(std::move(faces[face]));
  std::vector<TextureLevel> levels;
  for (std::size_t level = 0; level < halved[0].size(); ++level) {
    CubeFaces at;
    for (std::size_t face = 0; face < 6; ++face) at[face] = std::move(halved[face][level]);
    for (std::size_t face = 0; face < 6; ++face) levels.push_back(bordered(at, face));
  }
  return tiled(levels, exponent);
}

}  // namespace nullcone::postrender
