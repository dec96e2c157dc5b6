#include "apps/geodesic_svg.h"

#include <algorithm>
#include <cmath>
#include <cstdio>
#include <limits>

namespace nullcone {

namespace {

constexpr double kLongSide = 560, kLeft = 64, kTop = 62, kBottom = 52, kLegend = 190;

std::string printf_text(const char* format, auto... values) {
  std::array<char, 200> text{};
  const int length = std::snprintf(text.data(), text.size(), format, values...);
  return {text.data(), std::min(text.size() - 1, static_cast<std::size_t>(std::max(length, 0)))};
}

std::string escaped(const std::string& text) {
  std::string out;
  for (const char c : text) {
    if (c == '&')
      out += "&amp;";
    else if (c == '<')
      out += "&lt;";
    else if (c == '>')
      out += "&gt;";
    else if (c == '"')
      out += "&quot;";
    else
      out += c;
  }
  return out;
}

/// A tenth of a pixel, without a trailing ".0".
std::string pixels(double x) {
  std::string out = printf_text("%.1f", x);
  if (out.ends_with(".0")) out.resize(out.size() - 2);
  return out == "-0" ? "0" : out;
}

std::string text_at(double x, double y, const std::string& attributes, const std::string& text) {
  return "<text x=\"" + pixels(x) + "\" y=\"" + pixels(y) + "\"" + attributes + ">" + escaped(text) +
         "</text>\n";
}

bool is_finite(const PlanePoint& p) { return std::isfinite(p[0]) && std::isfinite(p[1]); }

/// Leaves out what lies within a twentieth of a pixel of the line through its neighbours (Douglas & Peucker
/// 1973).
void simplify(const std::vector<PlanePoint>& points, std::size_t from, std::size_t to,
              std::vector<PlanePoint>& out) {
  const double dx = points[to][0] - points[from][0], dy = points[to][1] - points[from][1],
               length = std::hypot(dx, dy);
  double farthest = 0.05;
  std::size_t corner = from;
  for (std::size_t i = from + 1; i < to; ++i) {
    const double x = points[i][0] - points[from][0], y = points[i][1] - points[from][1];
    const double off = length > 1e-9 ? std::fabs(x * dy - y * dx) / length : std::hypot(x, y);
    // Beyond the ends of the chord counts too: a path that turns back.
    const double along = length > 1e-9 ? (x * dx + y * dy) / length : 0;
    const double away = std::max({off, -along, along - length});
    if (away > farthest) farthest = away, corner = i;
  }
  if (corner != from) {
    simplify(points, from, corner, out);
    simplify(points, corner, to, out);
  } else {
    out.push_back(points[to]);
  }
}

/// From the units of the data to pixels.
class Canvas {
 public:
  explicit Canvas(const Drawing& drawing) {
    Frame frame = drawing.frame;
    if (frame.empty()) frame = {{-1, -1}, {1, 1}};
    double width = frame.most[0] - frame.least[0], height = frame.most[1] - frame.least[1];
    const double tiny = 1e-9 * std::max({std::fabs(frame.least[0]), std::fabs(frame.most[0]),
                                         std::fabs(frame.least[1]), std::fabs(frame.most[1]), 1e-290});
    const double longer = std::max({width, height, tiny}) * 1.08;  // a margin
    const double wide = std::max(width * 1.08, 0.4 * longer), high = std::max(height * 1.08, 0.4 * longer);
    const double x = 0.5 * (frame.least[0] + frame.most[0]), y = 0.5 * (frame.least[1] + frame.most[1]);
    scale_ = kLongSide / longer;
    shown_ = {{x - 0.5 * wide, y - 0.5 * high}, {x + 0.5 * wide, y + 0.5 * high}};
    width_ = wide * scale_, height_ = high * scale_;
  }

  const Frame& shown() const { return shown_; }
  double width() const { return width_; }
  double height() const { return height_; }
  double x(double value) const { return kLeft + (value - shown_.least[0]) * scale_; }
  double y(double value) const { return kTop + (shown_.most[1] - value) * scale_; }
  /// Kept within what every viewer's numbers hold.
  PlanePoint operator()(const PlanePoint& p) const {
    return {std::clamp(x(p[0]), -1e5, 1e5), std::clamp(y(p[1]), -1e5, 1e5)};
  }

 private:
  double scale_, width_, height_;
  Frame shown_{};
};

std::string path_of(const Stroke& stroke, const Canvas& canvas) {
  std::string out;
  const bool closed = stroke.kind == Stroke::Kind::outline || stroke.kind == Stroke::Kind::filled;
  for (std::size_t from = 0; from < stroke.points.size();) {
    std::vector<PlanePoint> piece, kept;
    for (; from < stroke.points.size() && is_finite(stroke.points[from]); ++from)
      piece.push_back(canvas(stroke.points[from]));
    ++from;
    if (piece.size() < 2) continue;
    if (closed) piece.push_back(piece.front());
    kept.push_back(piece.front());
    simplify(piece, 0, piece.size() - 1, kept);
    if (closed) kept.pop_back();
    for (std::size_t i = 0; i < kept.size(); ++i)
      out += (i == 0 ? "M" : i == 1 ? "L" : " ") + pixels(kept[i][0]) + " " + pixels(kept[i][1]);
    if (closed) out += "Z";
  }
  return out;
}

std::string style_of(const Stroke& stroke) {
  const std::string line = " stroke=\"" + stroke.color + "\"";
  switch (stroke.kind) {
    case Stroke::Kind::line:
      return line + " stroke-width=\"1.6\"";
    case Stroke::Kind::dashed:
      return line + " stroke-dasharray=\"5 4\"";
    case Stroke::Kind::outline:
      return line;
    case Stroke::Kind::filled:
      return line + " fill=\"" + stroke.color + "\" fill-opacity=\".25\"";
  }
  return line;
}

/// A small triangle at `tip`, along (dx, dy) in pixels.
std::string arrow_head(const PlanePoint& tip, double dx, double dy, double size, const std::string& color) {
  const double length = std::hypot(dx, dy), ux = size * dx / length, uy = size * dy / length;
  const auto corner = [&](double along, double across) {
    return pixels(tip[0] + along * ux - across * uy) + " " + pixels(tip[1] + along * uy + across * ux);
  };
  return "<path d=\"M" + corner(0.5, 0) + "L" + corner(-0.5, 0.4) + " " + corner(-0.5, -0.4) + "Z\" fill=\"" +
         color + "\" stroke=\"none\"/>\n";
}

std::string arrow_half_way(const Stroke& stroke, const Canvas& canvas) {
  const std::size_t i = stroke.points.size() / 2;
  if (i == 0 || !is_finite(stroke.points[i]) || !is_finite(stroke.points[i - 1])) return "";
  const PlanePoint from = canvas(stroke.points[i - 1]), to = canvas(stroke.points[i]);
  if (from == to) return "";
  return arrow_head(to, to[0] - from[0], to[1] - from[1], 9, stroke.color);
}

std::string field_arrows(const Drawing& drawing, const Canvas& canvas) {
  std::string shafts, heads;
  for (const auto& [from, to] : drawing.field) {
    const PlanePoint a = canvas(from), b = canvas(to);
    if (!is_finite(a) || !is_finite(b) || std::hypot(b[0] - a[0], b[1] - a[1]) < 1) continue;
    shafts += "M" + pixels(a[0]) + " " + pixels(a[1]) + "L" + pixels(b[0]) + " " + pixels(b[1]);
    heads += arrow_head(b, b[0] - a[0], b[1] - a[1], 5, "#9aa5b1");
  }
  return shafts.empty() ? "" : "<path d=\"" + shafts + "\" stroke=\"#9aa5b1\"/>\n" + heads;
}

/// 1, 2 or 5 times a power of ten, so that at most eight of them fit.
double tick_step(double range) {
  const double rough = range / 8, power = std::pow(10, std::floor(std::log10(rough)));
  for (const double factor : {1.0, 2.0, 5.0})
    if (rough <= factor * power) return factor * power;
  return 10 * power;
}

std::string axes(const Canvas& canvas) {
  const Frame& shown = canvas.shown();
  const double step = tick_step(std::max(shown.most[0] - shown.least[0], shown.most[1] - shown.least[1]));
  const double right = kLeft + canvas.width(), bottom = kTop + canvas.height();
  std::string grid, labels;
  for (std::size_t axis = 0; axis < 2; ++axis) {
    const double first = std::ceil(shown.least[axis] / step), last = std::floor(shown.most[axis] / step);
    const double largest = std::max({std::fabs(first), std::fabs(last), 1.0});
    const int digits = std::min(17, 1 + static_cast<int>(std::ceil(std::log10(largest))) + 1);
    for (double n = first; n <= last && last - first < 100; ++n) {
      const std::string label = printf_text("%.*g", digits, n == 0 ? 0.0 : n * step);
      const double at = axis == 0 ? canvas.x(n * step) : canvas.y(n * step);
      if (axis == 0) {
        grid += "M" + pixels(at) + " " + pixels(kTop) + "V" + pixels(bottom);
        labels += text_at(at, bottom + 16, " text-anchor=\"middle\"", label);
      } else {
        grid += "M" + pixels(kLeft) + " " + pixels(at) + "H" + pixels(right);
        labels += text_at(kLeft - 6, at + 4, " text-anchor=\"end\"", label);
      }
    }
  }
  return "<path d=\"" + grid + "\" stroke=\"#e4e7eb\"/>\n" + "<g fill=\"#333\" stroke=\"none\">\n" + labels +
         text_at(0.5 * (kLeft + right), bottom + 36, " text-anchor=\"middle\" font-style=\"italic\"", "x") +
         text_at(14, 0.5 * (kTop + bottom), " font-style=\"italic\"", "y") + "</g>\n";
}

struct Legend {
  double x, y = kTop + 8;
  std::string svg{};

  void add(const std::string& symbol, const std::string& label) {
    svg += symbol + text_at(x + 28, y + 4, " fill=\"#333\" stroke=\"none\"", label);
    y += 19;
  }
};

std::string circle(double x, double y, const std::string& color, bool filled) {
  return "<circle cx=\"" + pixels(x) + "\" cy=\"" + pixels(y) + "\" r=\"4\" stroke=\"" + color +
         "\" fill=\"" + (filled ? color : "#fff") + "\"/>\n";
}

Legend legend_of(const Drawing& drawing, double x) {
  Legend legend{x};
  for (const Stroke& stroke : drawing.strokes) {
    if (stroke.label.empty()) continue;
    const bool area = stroke.kind == Stroke::Kind::filled;
    legend.add("<path d=\"M" + pixels(x) + " " + pixels(legend.y - (area ? 5 : 0)) +
                   (area ? "h20v10h-20Z\"" : "h20\"") + style_of(stroke) + "/>\n",
               stroke.label);
  }
  if (!drawing.field.empty())
    legend.add("<path d=\"M" + pixels(legend.x) + " " + pixels(legend.y) + "h16\" stroke=\"#9aa5b1\"/>\n" +
                   arrow_head({legend.x + 17, legend.y}, 1, 0, 6, "#9aa5b1"),
               drawing.field_label);
  for (const Mark& mark : drawing.marks)
    if (!mark.label.empty()) legend.add(circle(legend.x + 10, legend.y, mark.color, mark.filled), mark.label);
  return legend;
}

}  // namespace

void Frame::include(const PlanePoint& point) {
  if (!is_finite(point)) return;
  for (std::size_t i = 0; i < 2; ++i) {
    least[i] = std::min(least[i], point[i]);
    most[i] = std::max(most[i], point[i]);
  }
}

double Frame::size() const { return empty() ? 0 : std::max(most[0] - least[0], most[1] - least[1]); }

Frame Frame::nothing() {
  constexpr double kHuge = std::numeric_limits<double>::infinity();
  return {{kHuge, kHuge}, {-kHuge, -kHuge}};
}

std::string to_svg(const Drawing& drawing) {
  const Canvas canvas(drawing);
  const double right = kLeft + canvas.width(), bottom = kTop + canvas.height();
  const Legend legend = legend_of(drawing, right + 18);
  const std::string box = "x=\"" + pixels(kLeft) + "\" y=\"" + pixels(kTop) + "\" width=\"" +
                          pixels(canvas.width()) + "\" height=\"" + pixels(canvas.height()) + "\"";
  const int width = static_cast<int>(std::ceil(right + kLegend)),
            height = static_cast<int>(std::ceil(std::max(bottom + kBottom, legend.y + 8)));
  std::string out = printf_text(
      "<svg xmlns=\"http://www.w3.org/2000/svg\" width=\"%d\" height=\"%d\" viewBox=\"0 0 %d %d\" "
      "font-family=\"DejaVu Sans, Helvetica, Arial, sans-serif\" ",
      width, height, width, height);
  out +=
      "font-size=\"12\" fill=\"none\" stroke-linejoin=\"round\">\n<rect width=\"100%\" height=\"100%\" "
      "fill=\"#fff\"/>\n";
  out += text_at(kLeft, 26, " font-size=\"16\" fill=\"#111\"", drawing.title);
  out += text_at(kLeft, 46, " fill=\"#555\"", drawing.subtitle);
  out += axes(canvas) + "<clipPath id=\"c\"><rect " + box + "/></clipPath>\n<g clip-path=\"url(#c)\">\n" +
         field_arrows(drawing, canvas);
  for (const Stroke& stroke : drawing.strokes) {
    const std::string path = path_of(stroke, canvas);
    if (!path.empty()) out += "<path d=\"" + path + "\"" + style_of(stroke) + "/>\n";
    if (stroke.arrow) out += arrow_half_way(stroke, canvas);
  }
  for (const Mark& mark : drawing.marks)
    if (is_finite(mark.at)) {
      const PlanePoint at = canvas(mark.at);
      out += circle(at[0], at[1], mark.color, mark.filled);
    }
  return out + "</g>\n<rect " + box + " stroke=\"#333\"/>\n" + legend.svg + "</svg>\n";
}

}  // namespace nullcone
