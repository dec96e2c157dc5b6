#include "apps/geodesic_picture.h"

#include <algorithm>
#include <cmath>

#include "apps/geodesic_killing.h"
#include "apps/geodesic_outline.h"
#include "core/record/whole_file.h"

namespace nullcone {

namespace {

/// Points of the ray, in the order of lambda, dense enough that no bend is lost: intervals are halved until
/// no point lies off the chord of its neighbours by more than 1/2000 of the picture.
std::vector<GeodesicPoint> sampled(const Ray& ray, double from, double to) {
  std::vector<double> lambda = evenly_spaced(from, to, 201);
  for (int round = 0;; ++round) {
    std::vector<GeodesicPoint> points = ray.at(lambda);
    Frame frame = Frame::nothing();
    for (const GeodesicPoint& p : points) frame.include({p.event[1], p.event[2]});
    std::vector<double> more;
    for (std::size_t i = 1; i + 1 < points.size(); ++i) {
      const auto across = [&](std::size_t j, std::size_t c) {
        return points[j].event[c] - points[i - 1].event[c];
      };
      const double dx = across(i + 1, 1), dy = across(i + 1, 2);
      const double off = std::fabs(across(i, 1) * dy - across(i, 2) * dx);
      if (!(off > 5e-4 * frame.size() * std::hypot(dx, dy))) continue;
      more.push_back(0.5 * (lambda[i - 1] + lambda[i]));
      more.push_back(0.5 * (lambda[i] + lambda[i + 1]));
    }
    if (more.empty() || round == 12 || lambda.size() > 2000) return points;
    lambda.insert(lambda.end(), more.begin(), more.end());
    std::sort(lambda.begin(), lambda.end());
    lambda.erase(std::unique(lambda.begin(), lambda.end()), lambda.end());
  }
}

/// From dark blue through green to yellow: part of the way from 0 to 1.
std::string shade(double part) {
  constexpr std::array<std::array<double, 3>, 5> kStops = {
      {{68, 1, 84}, {59, 82, 139}, {33, 145, 140}, {94, 201, 98}, {220, 190, 30}}};
  const double at = part * 4;
  const auto stop = std::min<std::size_t>(3, static_cast<std::size_t>(at));
  std::string out = "#";
  for (std::size_t i = 0; i < 3; ++i) {
    const double value =
        kStops[stop][i] + (at - static_cast<double>(stop)) * (kStops[stop + 1][i] - kStops[stop][i]);
    std::array<char, 8> text{};
    std::snprintf(text.data(), text.size(), "%02x", static_cast<unsigned>(std::lround(value)) & 0xFFU);
    out += text.data();
  }
  return out;
}

std::string number_text(double x) {
  std::array<char, 32> text{};
  std::snprintf(text.data(), text.size(), "%.4g", x);
  return text.data();
}

/// Families of more than 12 name the first, every so many, and the last.
std::string label_of(const Inquiry& inquiry, std::size_t i) {
  const std::size_t n = inquiry.members.size(), each = (n + 11) / 12;
  if (inquiry.traced) return "ray of light";
  if (n == 1) return inquiry.parameter_name.empty() ? "geodesic" : "one of one";
  if (i % each != 0 && i + 1 != n) return "";
  const std::string value = number_text(inquiry.members[i].parameter);
  return inquiry.parameter_name == "eta" ? "η = " + value : value + "°";
}

std::string parameters_text(const Inquiry& inquiry) {
  const MetricDescription metric = inquiry.spacetime->description();
  std::string out(metric.name);
  for (std::size_t i = 0; i < metric.parameters.size(); ++i) {
    const MetricParameter& p = metric.parameters[i];
    const double value = inquiry.parameters[i];
    out += std::string(", ") + std::string(p.name) + " = ";
    out += p.words[0].empty() ? number_text(value) : std::string(p.words[static_cast<std::size_t>(value)]);
  }
  return out;
}

/// Adds the rays; arrows show how light and particles move, into the future.
double add_rays(const Inquiry& inquiry, Drawing& drawing) {
  double last_time = 0;
  const std::size_t n = inquiry.members.size();
  for (std::size_t i = 0; i < n; ++i) {
    auto points = sampled(inquiry.members[i].ray, inquiry.plot_from, inquiry.plot_to);
    last_time = points.back().event[0];
    Stroke stroke{Stroke::Kind::line,
                  n == 1 ? "#c8281e" : shade(static_cast<double>(i) / static_cast<double>(n - 1)),
                  label_of(inquiry, i),
                  {},
                  true};
    if (inquiry.traced) std::reverse(points.begin(), points.end());
    for (const GeodesicPoint& p : points) {
      stroke.points.push_back({p.event[1], p.event[2]});
      drawing.frame.include(stroke.points.back());
    }
    drawing.strokes.push_back(std::move(stroke));
  }
  return last_time;
}

void add_marks(const Inquiry& inquiry, Drawing& drawing) {
  const bool labelled = inquiry.members.size() == 1 || inquiry.parameter_name != "eta";
  const std::size_t marks = labelled ? 1 : inquiry.members.size();
  for (std::size_t i = 0; i < marks; ++i) {
    const Event& at = inquiry.members[i].ray.event;
    const std::string traced = inquiry.traced && has_film(inquiry.traced->scene.camera) ? "film" : "observer";
    const std::string label = inquiry.traced ? traced : i == 0 ? "event, λ = 0" : "";
    drawing.marks.push_back({labelled ? "#111" : drawing.strokes[drawing.strokes.size() - marks + i].color,
                             label,
                             {at[1], at[2]},
                             false});
  }
  if (!inquiry.traced) return;
  const auto& traced = *inquiry.traced;
  const auto end = inquiry.members[0].ray.at(inquiry.plot_to).event;
  const std::string_view status = kStatusNames[traced.record.status];
  const bool met = !traced.hits.empty() && std::isfinite(traced.hits.back().Z);
  drawing.marks.push_back(
      {"#c8281e", met ? "crossing" : std::string(status) + " (end)", {end[1], end[2]}, true});
}

/// The Killing field on a grid over the frame; the longest arrow is as long as the grid is wide.
void add_field(const Inquiry& inquiry, const std::string& name, Drawing& drawing) {
  constexpr int kCells = 17;
  const Frame& frame = drawing.frame;
  const KillingField field(*inquiry.spacetime, inquiry.parameters, name, inquiry.members[0].ray.event);
  std::vector<std::array<PlanePoint, 2>> found;
  double longest = 0;
  for (int i = 0; i < kCells; ++i)
    for (int j = 0; j < kCells; ++j) {
      const double x = frame.least[0] + (frame.most[0] - frame.least[0]) * i / (kCells - 1),
                   y = frame.least[1] + (frame.most[1] - frame.least[1]) * j / (kCells - 1);
      const Event& event = inquiry.members[0].ray.event;
      const Event K = field.at({event[0], x, y, event[3]});
      const double length = std::hypot(K[1], K[2]);
      if (!(length > 0 && std::isfinite(length))) continue;
      longest = std::max(longest, length);
      found.push_back({PlanePoint{x, y}, {K[1], K[2]}});
    }
  for (auto& [at, K] : found) {
    const double scale = frame.size() / (kCells - 1) / longest;
    K = {at[0] + scale * K[0], at[1] + scale * K[1]};
  }
  drawing.field = std::move(found);
  drawing.field_label = "Killing field " + name;
}

}  // namespace

Drawing picture_of(const Inquiry& inquiry, const std::string& killing) {
  Drawing out{inquiry.title, parameters_text(inquiry), Frame::nothing(), {}, {}, {}, {}};
  const double time = add_rays(inquiry, out);
  std::vector<Stroke> below = object_outlines(inquiry, time);
  for (const Stroke& stroke : below)
    if (stroke.kind != Stroke::Kind::outline || stroke.points.size() == 4)  // a dome is scenery
      for (const PlanePoint& p : stroke.points) out.frame.include(p);
  for (const Stroke& stroke : landmarks(inquiry)) {
    Frame with = out.frame;
    for (const PlanePoint& p : stroke.points) with.include(p);
    if (with.size() > 4 * out.frame.size()) continue;  // would dwarf what was asked for
    out.frame = with;
    below.insert(below.begin(), stroke);
  }
  out.strokes.insert(out.strokes.begin(), below.begin(), below.end());
  if (!killing.empty()) add_field(inquiry, killing, out);
  add_marks(inquiry, out);
  return out;
}

void write_picture(const Drawing& drawing, const std::string& path) {
  WholeFile file(path);
  file.stream() << to_svg(drawing);
  file.finish();
}

}  // namespace nullcone
