#include "core/scene/read_solid.h"

#include <algorithm>
#include <cmath>

#include "core/scene/read_placing.h"

namespace nullcone {

namespace {

double radius_about_origin(const Primitive& p) {
  const double centre = std::hypot(p.centre[0], p.centre[1], p.centre[2]);
  switch (p.type) {
    case PrimitiveType::ellipsoid:
      return centre + std::max({p.half[0], p.half[1], p.half[2]});
    case PrimitiveType::box:
      return centre + std::hypot(p.half[0], p.half[1], p.half[2]);
    case PrimitiveType::disk:
      return centre + p.half[0];
    default:
      return centre + std::hypot(p.half[0], p.half[2]);
  }
}

double read_length(JsonObject& shape, std::string_view key) {
  return shape.number(key, kLeastLength, kLargest);
}

Primitive round_about_z(PrimitiveType type, double radius, double half_height) {
  Primitive out;
  out.type = type;
  out.half = {radius, radius, half_height};
  return out;
}

Primitive read_primitive(JsonObject& shape, const std::string& type) {
  Primitive out;
  if (type == "sphere") {
    out.half.fill(read_length(shape, "radius"));
  } else if (type == "ellipsoid") {
    std::ranges::copy(shape.numbers("semi_axes", 3, kLeastLength, kLargest), out.half.begin());
  } else if (type == "box") {
    out.type = PrimitiveType::box;
    std::ranges::copy(shape.numbers("edges", 3, kLeastLength, kLargest), out.half.begin());
    for (double& edge : out.half) edge *= 0.5;
  } else if (type == "cylinder") {
    const bool open = shape.boolean("open", false);
    out = round_about_z(open ? PrimitiveType::tube : PrimitiveType::cylinder, read_length(shape, "radius"),
                        0.5 * read_length(shape, "height"));
  } else {
    out = round_about_z(PrimitiveType::disk, read_length(shape, "radius"), 1);
    if (type == "ring") out.hole = read_length(shape, "inner_radius") / out.half[0];
    if (out.hole >= 1) shape.refuse("inner_radius", "expected less than the radius");
  }
  return out;
}

/// A shape and those that it is made of, as steps in postfix order.
class SolidReader {
 public:
  explicit SolidReader(Solid& solid) : solid_(solid) {}

  /// Returns the radius of a ball about the origin that holds what was added.
  double add(JsonObject& shape, const std::string& type, bool taken_away, std::size_t depth) {
    if (type != "union" && type != "intersection" && type != "difference")
      return take(shape, type, taken_away, depth > 0);
    if (depth + 1 == Solid::kMostDepth) shape.refuse("of", "is nested too deep; expected at most 15 levels");
    std::vector<JsonObject> parts = shape.objects("of");
    if (parts.size() < 2) shape.refuse("of", "expected at least two shapes");
    const Join join = type == "union"          ? Join::unite
                      : type == "intersection" ? Join::intersect
                                               : Join::subtract;
    double ball = add_part(parts[0], taken_away, depth);
    for (std::size_t i = 1; i < parts.size(); ++i) {
      const double part = add_part(parts[i], taken_away != (join == Join::subtract), depth);
      if (join == Join::unite) ball = std::max(ball, part);
      if (join == Join::intersect) ball = std::min(ball, part);
      solid_.steps.push_back({join, 0, false});
    }
    return ball;
  }

 private:
  double add_part(JsonObject& part, bool taken_away, std::size_t depth) {
    const std::string type =
        part.word("type", {"sphere", "ellipsoid", "box", "cylinder", "union", "intersection", "difference"});
    const double out = add(part, type, taken_away, depth + 1);
    part.finish();
    return out;
  }

  /// Parts say where they stand in the frame of the whole; what is whole says so in its placing.
  double take(JsonObject& shape, const std::string& type, bool taken_away, bool is_part) {
    if (solid_.primitives.size() == Solid::kMostPrimitives)
      shape.refuse("type", "is one body too many; expected at most 64 in an object");
    Primitive primitive = read_primitive(shape, type);
    if (is_part) {
      if (!primitive.closed()) shape.refuse("open", "expected a closed shape among those that are joined");
      std::ranges::copy(shape.numbers_or("centre", {0, 0, 0}, -kLargest, kLargest), primitive.centre.begin());
      primitive.axes = read_directions(shape);
    }
    const auto number = static_cast<std::uint32_t>(solid_.primitives.size());
    solid_.steps.push_back({Join::take, number, taken_away});
    solid_.primitives.push_back(primitive);
    return radius_about_origin(primitive);
  }

  Solid& solid_;
};

}  // namespace

std::shared_ptr<const Solid> read_solid(JsonObject& shape, const std::string& type) {
  auto out = std::make_shared<Solid>();
  out->ball = SolidReader(*out).add(shape, type, false, 0);
  return out;
}

}  // namespace nullcone
