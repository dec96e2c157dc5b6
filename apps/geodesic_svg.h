// A plane drawing with axes as a small SVG: lines, outlines, arrows and marks in the units of the data.
#pragma once

#include <array>
#include <string>
#include <vector>

namespace nullcone {

using PlanePoint = std::array<double, 2>;

struct Stroke {
  enum class Kind { line, dashed, outline, filled };
  Kind kind = Kind::line;
  std::string color, label;          ///< without a label it is not in the legend
  std::vector<PlanePoint> points{};  ///< points that are not finite interrupt a line
  bool arrow = false;                ///< half way along
};

struct Mark {
  std::string color, label;
  PlanePoint at;
  bool filled;
};

/// The part of the plane that is shown.
struct Frame {
  PlanePoint least, most;

  void include(const PlanePoint& point);
  bool empty() const { return !(least[0] <= most[0] && least[1] <= most[1]); }
  double size() const;
  static Frame nothing();
};

struct Drawing {
  std::string title, subtitle;
  Frame frame = Frame::nothing();
  std::vector<Stroke> strokes;                   ///< later ones lie above earlier ones
  std::vector<std::array<PlanePoint, 2>> field;  ///< small arrows below all else
  std::string field_label;
  std::vector<Mark> marks;
};

/// The SVG text. Both axes have the same scale; the shorter one shows more than the frame if need be.
std::string to_svg(const Drawing& drawing);

}  // namespace nullcone
