// Which face of which primitive of a solid is the surface near a point, and what it is like. One lane.
#pragma once

#include "core/scene/solid.h"
#include "core/trace/facet.h"

NULLCONE_KERNEL_BEGIN

/// A face of a primitive. Box: 2 axis + (1 on the positive side); cylinder: 0 side, 4 bottom, 5 top; else 0.
struct SolidFace {
  double distance = 0;  ///< from it, to first order; positive outside
  const Primitive* primitive = nullptr;
  std::size_t number = 0;
  bool reversed = false;  ///< its outside is inside

  SolidFace turned_over() const { return {-distance, primitive, number, !reversed}; }
};

inline SolidFace face_near(const Primitive& primitive, const Vec3<double>& X) {
  Vec3<double> Y;
  for (std::size_t i = 0; i < 3; ++i)
    Y[i] = dot(convert<double>(primitive.axes[i]), X - convert<double>(primitive.centre)) / primitive.half[i];
  const double rho = sqrt(Y[0] * Y[0] + Y[1] * Y[1]);
  const auto slab = [&](std::size_t i) -> SolidFace {
    return {primitive.half[i] * (abs(Y[i]) - 1), &primitive, 2 * i + (Y[i] < 0 ? 0 : 1)};
  };
  const auto outermost = [](const SolidFace& a, const SolidFace& b) {
    return a.distance < b.distance ? b : a;
  };
  switch (primitive.type) {
    case PrimitiveType::box:
      return outermost(slab(2), outermost(slab(0), slab(1)));
    case PrimitiveType::cylinder:
      return outermost(SolidFace{primitive.half[0] * (rho - 1), &primitive}, slab(2));
    case PrimitiveType::ellipsoid: {
      Vec3<double> slope{};
      for (std::size_t i = 0; i < 3; ++i) slope[i] = 2 * Y[i] / primitive.half[i];
      return {(dot(Y, Y) - 1) / max(norm(slope), 1e-300), &primitive};
    }
    default:
      return {0, &primitive};
  }
}

/// The face that decides whether X is inside.
inline SolidFace face_near(const Primitive* primitives, const SolidStep* steps, std::size_t count,
                           const Vec3<double>& X) {
  std::array<SolidFace, Solid::kMostDepth> stack;
  std::size_t top = 0;
  for (std::size_t i = 0; i < count; ++i) {
    if (steps[i].join == Join::take) {
      stack[top++] = face_near(primitives[steps[i].primitive], X);
      continue;
    }
    const SolidFace upper = stack[--top], a = stack[--top];
    const SolidFace b = steps[i].join == Join::subtract ? upper.turned_over() : upper;
    const bool nearest = steps[i].join == Join::unite;
    stack[top++] = (a.distance < b.distance) == nearest ? a : b;
  }
  return stack[0];
}

/// Texture coordinates of the face of a box: a cell of an atlas in three columns, x, y and z: above those on
/// the positive side, below the others. In each cell u runs to the right and v upwards as the face is seen
/// from outside, with +z up, or +y on the faces across z.
inline void lay_out_box(std::size_t axis, double side, FacetNumbers& out) {
  const double within = 0.5 * (1 - 1e-6);
  const double column = axis == 0 ? 0.5 : axis == 1 ? 1.5 : 2.5, row = 0.5 + 0.25 * side;
  out.at_u = column / 3, out.at_v = row;
  out.by_u[axis == 0 ? 1 : 0] = (axis == 1 ? -side : side) / 6;
  out.by_v[axis == 2 ? 1 : 2] = 0.25;
  out.range_u = {(column - within) / 3, (column + within) / 3};
  out.range_v = {row - 0.5 * within, row + 0.5 * within};
}

/// Of a cylinder: v runs from the middle of the bottom (0) over its edge (1/3) up the side and over the edge
/// of the top (2/3) to its middle (1). Of a tube: from 0 up to 1. Of a disk or ring: from its inner edge (0,
/// or its middle) to the outer edge (1). u is always the longitude.
inline void lay_out_round(const SolidFace& face, FacetNumbers& out) {
  const bool tube = face.primitive->type == PrimitiveType::tube;
  if (face.primitive->type == PrimitiveType::disk) {
    const double hole = face.primitive->hole;
    out.chart = Chart::polar, out.at_v = -hole / (1 - hole), out.by_v = {1 / (1 - hole), 0, 0};
  } else if (face.number == 0) {
    out.chart = Chart::tube, out.at_v = 0.5, out.by_v = {0, 0, tube ? 0.5 : 1.0 / 6};
  } else {
    const bool top = face.number == 5;
    out.chart = Chart::polar, out.at_v = top ? 1 : 0, out.by_v = {top ? -1.0 / 3 : 1.0 / 3, 0, 0};
  }
}

inline FacetNumbers numbers_of(const SolidFace& face) {
  const Primitive& primitive = *face.primitive;
  FacetNumbers out;
  out.centre = primitive.centre;
  for (std::size_t i = 0; i < 3; ++i)
    for (std::size_t k = 0; k < 3; ++k) out.rows[i][k] = primitive.axes[i][k] / primitive.half[i];
  const double sign = face.reversed ? -1 : 1;
  const bool box = primitive.type == PrimitiveType::box, cap = face.number >= 4;
  if (box || cap) {
    const double side = face.number % 2 == 0 ? -1 : 1;
    out.linear[face.number / 2] = sign * side, out.constant = -sign;
    if (box) lay_out_box(face.number / 2, side, out);
  } else if (primitive.type == PrimitiveType::disk) {
    out.linear[2] = 1;
  } else {
    out.square = {sign, sign, primitive.type == PrimitiveType::ellipsoid ? sign : 0.0};
    out.constant = -sign;
  }
  if (primitive.type == PrimitiveType::ellipsoid)
    out.chart = Chart::sphere;
  else if (!box)
    lay_out_round(face, out);
  return out;
}

NULLCONE_KERNEL_END
