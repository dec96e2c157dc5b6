// What is known of the rays before any integrator is measured.
#include <algorithm>
#include <cmath>

#include "bench/work_precision_rays.h"

namespace nullcone::study {

namespace {

Numbers to_numbers(const std::array<double, 8>& y) {
  Numbers out{};
  for (std::size_t i = 0; i < 8; ++i) out[i] = y[i];
  return out;
}

double largest_momentum(const std::array<double, 8>& y) {
  return std::max({std::fabs(y[4]), std::fabs(y[5]), std::fabs(y[6]), std::fabs(y[7])});
}

/// Where errors are put in: evenly along a closed path; about a hole in equal ratios of the distance, as an
/// integrator's steps stand.
std::vector<double> checkpoints(const Place& place) {
  std::vector<double> out;
  if (place.radius == 0)
    for (int k = 0; k < 8; ++k) out.push_back(place.length * k / 8);
  for (double rest = place.radius; rest > 2; rest /= 2) {
    out.push_back(place.radius - rest);
    if (place.radius + rest < place.length) out.push_back(place.radius + rest);
  }
  return out;
}

/// How large relative errors of 1e-6 of each component of position and momentum (in turn) at one checkpoint
/// become at the end: the largest, added to each ray's sum.
void add_response(const Place& place, const Kernel& kernel, double from, const Truth& truth,
                  std::vector<double>& sum) {
  constexpr double kSmall = 1e-6;
  const Accuracy accuracy{1e-12, 0, Integrator::prince_dormand87};
  const std::size_t n = truth.start.size();
  Place before = place, after = place;
  before.length = from, after.length = place.length - from;
  std::vector<End> there(n), base(n), moved(n);
  std::vector<Start> here = truth.start, start(n);
  if (from > 0) {
    kernel.march(before, accuracy, {truth.start.data(), there.data(), n}, 1);
    for (std::size_t i = 0; i < n; ++i) here[i].y = there[i].y;
  }
  kernel.march(after, accuracy, {here.data(), base.data(), n}, 1);
  std::vector<double> largest(n, 0);
  for (std::size_t c = 1; c < 8; ++c) {  // time drops out everywhere
    for (std::size_t i = 0; i < n; ++i) {
      start[i] = here[i];
      const double scale = length_scale_at(place, to_numbers(here[i].y));
      start[i].y[c] += kSmall * (c < 4 ? scale : largest_momentum(here[i].y));
    }
    kernel.march(after, accuracy, {start.data(), moved.data(), n}, 1);
    for (std::size_t i = 0; i < n; ++i) {
      const double change = error_of(moved[i].y, to_numbers(base[i].y), truth.scale[i]) / kSmall;
      largest[i] = std::max(largest[i], change);
    }
  }
  for (std::size_t i = 0; i < n; ++i) sum[i] += largest[i];
}

/// What a relative error made somewhere along the ray becomes at its end, in the mean over the checkpoints.
void find_amplification(const Place& place, const Kernel& kernel, Truth& truth) {
  const auto points = checkpoints(place);
  truth.amplification.assign(truth.start.size(), 0);
  for (const double from : points) add_response(place, kernel, from, truth, truth.amplification);
  for (double& a : truth.amplification) a /= static_cast<double>(points.size());
}

/// Every ray's impact parameter against the critical one in its direction on the screen: is the fate of its
/// neighbours at 0.95 and 1.05 times its distance from the centre, and between, the same? (The shadow of a
/// turning hole is not round about the screen's centre; 5 percent of b is what counts.)
void find_clear(const Place& place, const Kernel& kernel, const std::vector<std::array<double, 2>>& at,
                Truth& truth) {
  const Accuracy accuracy{1e-7, 0, Integrator::prince_dormand87};
  const std::size_t n = truth.start.size();
  truth.clear.assign(n, 1);
  if (place.metric != MetricId::kerr_schild) return;
  std::vector<Start> start(n);
  std::vector<End> end(n);
  for (const double factor : {1 / 1.05, 1 / 1.025, 1 / 0.975, 1 / 0.95}) {
    for (std::size_t i = 0; i < n; ++i) start[i] = screen_ray(place, factor * at[i][0], factor * at[i][1]);
    kernel.march(place, accuracy, {start.data(), end.data(), n}, 1);
    for (std::size_t i = 0; i < n; ++i)
      if (end[i].captured != static_cast<bool>(truth.captured[i])) truth.clear[i] = 0;
  }
}

/// The same rays again, each to a quarter, half, three quarters or the whole of the length.
void find_mixed(const Place& place, Truth& truth) {
  for (std::size_t part = 0; part < 4; ++part) {
    Truth::Part& out = truth.parts[part];
    out.place = place;
    out.place.length *= static_cast<double>(part + 1) / 4;
    for (std::size_t i = 0; i < truth.start.size(); ++i) {
      Numbers end{};
      if ((i * 2654435761U >> 16) % 4 != part || truth.captured[i]) continue;
      if (!true_end(out.place, truth.start[i], end)) continue;
      out.start.push_back(truth.start[i]);
      out.end.push_back(end);
    }
  }
}

}  // namespace

Truth find_truth(const Place& place, const Kernel& kernel, std::size_t n, double half_width) {
  Truth out;
  out.start = screen(place, n, half_width);
  for (const Start& start : out.start) {
    Numbers end{};
    out.captured.push_back(!true_end(place, start, end));
    out.end.push_back(end);
    out.scale.push_back(out.captured.back() ? 1 : length_scale_at(place, end));
  }
  find_mixed(place, out);
  find_amplification(place, kernel, out);
  find_clear(place, kernel, screen_points(n, half_width), out);
  return out;
}

}  // namespace nullcone::study
