// Maps of all directions on the faces of a polyhedron about the observer, which lie side by side in the
// picture: each shows what is seen through it.
#pragma once

#include "core/base/projections.h"

NULLCONE_KERNEL_BEGIN

/// A flat map from places in a cell of the picture, parts of it to the right and down from its top left
/// corner, to points of a face. Components along forward, left and up.
struct Face {
  Vec3<double> corner, right, down;
};

/// A row of equal cells. Where `halved`, each has two faces, below and above its diagonal from the top left;
/// else one.
template <std::size_t N>
struct Faces {
  std::array<Face, N> face;
  bool halved;

  constexpr int cells() const { return static_cast<int>(halved ? N / 2 : N); }
};

/// Right, left, up, down, front, back, each upright as seen from inside; up and down have their edges with
/// the front below and above. So Direct3D's and ffmpeg's v360 (c6x1) have them too.
inline constexpr Faces<6> kCube{{{{{{1, -1, 1}}, {{-2, 0, 0}}, {{0, 0, -2}}},
                                  {{{-1, 1, 1}}, {{2, 0, 0}}, {{0, 0, -2}}},
                                  {{{-1, 1, 1}}, {{0, -2, 0}}, {{2, 0, 0}}},
                                  {{{1, 1, -1}}, {{0, -2, 0}}, {{-2, 0, 0}}},
                                  {{{1, 1, 1}}, {{0, -2, 0}}, {{0, 0, -2}}},
                                  {{{-1, -1, 1}}, {{0, 2, 0}}, {{0, 0, -2}}}}},
                                false};

constexpr Face triangle(const Vec3<double>& corner, const std::array<Vec3<double>, 2>& right,
                        const std::array<Vec3<double>, 2>& down) {
  Face out{corner, {}, {}};
  for (std::size_t i = 0; i < 3; ++i)
    out.right.c[i] = right[1].c[i] - right[0].c[i], out.down.c[i] = down[1].c[i] - down[0].c[i];
  return out;
}

/// M. Borchers, Interaktive und stereoskopische Visualisierung in der speziellen Relativitaetstheorie,
/// Tuebingen 2005, A.3: the observer stands in the middle of a regular tetrahedron; each face is sheared to
/// half a square, and two squares make the picture. His matrix (A.11) takes the face ABC, straight ahead,
/// with its corner B at the top, to the half below the diagonal, B at the top left. The other faces follow as
/// the tetrahedron unrolls: above B D B, below A C A; so all neighbours in the picture are neighbours in the
/// sky, those at the left and the right edge too.
constexpr Faces<4> tetrahedron() {
  constexpr double kRoot2Thirds = 0x1.e2b7dddfefa67p-2, kRoot6Thirds = 0x1.a20bd700c2c3dp-1;
  constexpr Vec3<double> A{{1.0 / 3, kRoot6Thirds, -kRoot2Thirds}}, B{{1.0 / 3, 0, 2 * kRoot2Thirds}},
      C{{1.0 / 3, -kRoot6Thirds, -kRoot2Thirds}}, D{{-1, 0, 0}};
  return {{triangle(B, {A, C}, {B, A}), triangle(B, {B, D}, {D, C}), triangle(D, {C, A}, {D, C}),
           triangle(D, {D, B}, {B, A})},
          true};
}
inline constexpr Faces<4> kTetrahedron = tetrahedron();

/// The unit look direction at the place (x + dx, y + dy), parts of the picture to the right and down from its
/// top left corner, on the face to which (x, y) belongs.
template <class S, std::size_t N>
Vec3<S> look_on_faces(const Faces<N>& faces, const CameraAxes<S>& axes, const S& x, const S& y, const S& dx,
                      const S& dy) {
  const S cells(faces.cells()), cell = max(S(0.0), min(floor(x * cells), cells - S(1.0)));
  const S to_right = x * cells - cell;
  const S number = faces.halved ? cell + cell + select(to_right > y, S(1.0), S(0.0)) : cell;
  const S right = to_right + dx * cells, down = y + dy;
  const auto point = [&](const Face& face) {
    return convert<S>(face.corner) + right * convert<S>(face.right) + down * convert<S>(face.down);
  };
  Vec3<S> P = point(faces.face[0]);
  for (std::size_t i = 1; i < N; ++i)
    P = select(number == S(static_cast<double>(i)), point(faces.face[i]), P);
  return normalised(P[0] * axes.forward + P[1] * axes.left + P[2] * axes.up);
}

/// The inverse: the place of a look direction whose components are those along forward, left and up. As parts
/// of the picture, from its centre to the left and upwards.
template <std::size_t N>
Vec<double, 2> place_on_faces(const Faces<N>& faces, const Vec3<double>& look) {
  std::size_t seen = 0;
  Vec3<double> normal{};
  double most = 0;
  for (std::size_t i = 0; i < N; ++i) {  // all faces are equally far: the one seen through is the most ahead
    const Face& face = faces.face[i];
    Vec3<double> outwards = normalised(cross(face.right, face.down));
    if (dot(outwards, face.corner) < 0) outwards = -outwards;
    if (const double ahead = dot(outwards, look); ahead > most) most = ahead, seen = i, normal = outwards;
  }
  const Face& face = faces.face[seen];
  const Vec3<double> P = (dot(normal, face.corner) / most) * look - face.corner;
  const double area = dot(normal, cross(face.right, face.down));
  const double right = dot(normal, cross(P, face.down)) / area,
               down = dot(normal, cross(face.right, P)) / area;
  const double cell = static_cast<double>(faces.halved ? seen / 2 : seen);
  return {{0.5 - (cell + right) / faces.cells(), 0.5 - down}};
}

NULLCONE_KERNEL_END
