#include "core/trace/event_spline.h"

#include <algorithm>
#include <cmath>

namespace nullcone {

namespace {

/// The slope at x[0] of the polynomial through up to four points, by divided differences.
double slope_at_first(std::vector<double> x, std::vector<double> y) {
  double out = 0, factor = 1;
  for (std::size_t order = 1; order < x.size(); ++order) {
    for (std::size_t i = 0; i + order < x.size(); ++i) y[i] = (y[i + 1] - y[i]) / (x[i + order] - x[i]);
    out += factor * y[0];
    factor *= x[0] - x[order];
  }
  return out;
}

}  // namespace

EventSpline::EventSpline(std::span<const Event> events) : events_(events.begin(), events.end()) {
  const std::size_t n = events_.size();
  knots_ = {0};
  for (std::size_t i = 1; i < n; ++i) {
    double chord2 = 0;
    for (std::size_t c = 0; c < 4; ++c) chord2 += std::pow(events_[i][c] - events_[i - 1][c], 2);
    knots_.push_back(knots_.back() + std::sqrt(chord2));
  }
  slopes_.resize(n);
  for (std::size_t c = 0; c < 4; ++c) {
    const auto end_slope = [&](bool first) {
      std::vector<double> x, y;
      for (std::size_t k = 0; k < std::min<std::size_t>(n, 4); ++k) {
        x.push_back(knots_[first ? k : n - 1 - k]);
        y.push_back(events_[first ? k : n - 1 - k][c]);
      }
      return slope_at_first(x, y);
    };
    // The second derivative is the same on both sides of each knot: a tridiagonal system, solved by Thomas.
    std::vector<double> upper(n), right(n);
    right[0] = end_slope(true);
    for (std::size_t i = 1; i + 1 < n; ++i) {
      const double before = 1 / (knots_[i] - knots_[i - 1]), behind = 1 / (knots_[i + 1] - knots_[i]);
      const double sum = 3 * ((events_[i][c] - events_[i - 1][c]) * before * before +
                              (events_[i + 1][c] - events_[i][c]) * behind * behind);
      const double pivot = 2 * (before + behind) - before * upper[i - 1];
      upper[i] = behind / pivot;
      right[i] = (sum - before * right[i - 1]) / pivot;
    }
    slopes_[n - 1][c] = end_slope(false);
    for (std::size_t i = n - 1; i-- > 0;) slopes_[i][c] = right[i] - upper[i] * slopes_[i + 1][c];
  }
}

EventSpline::Point EventSpline::at(double s) const {
  const auto behind = std::upper_bound(knots_.begin() + 1, knots_.end() - 1, s);
  const auto i = static_cast<std::size_t>(behind - knots_.begin()) - 1;
  const double h = knots_[i + 1] - knots_[i], x = (s - knots_[i]) / h;
  Point out;
  for (std::size_t c = 0; c < 4; ++c) {
    const double rise = events_[i + 1][c] - events_[i][c];
    const double c1 = h * slopes_[i][c], c2 = 3 * rise - h * (2 * slopes_[i][c] + slopes_[i + 1][c]),
                 c3 = h * (slopes_[i][c] + slopes_[i + 1][c]) - 2 * rise;
    out.event[c] = events_[i][c] + x * (c1 + x * (c2 + x * c3));
    out.slope[c] = (c1 + x * (2 * c2 + x * 3 * c3)) / h;
    out.bend[c] = (2 * c2 + x * 6 * c3) / (h * h);
  }
  return out;
}

}  // namespace nullcone
