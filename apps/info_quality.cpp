#include "apps/info_quality.h"

#include <bit>

namespace nullcone {

namespace {

constexpr int kShift = 16;  // keeps the exponent and 7 bits of the fraction

/// NaN never passes verification, but must not break the order.
float comparable(float error) { return std::isnan(error) ? INFINITY : error; }

Report number(double x) { return std::isfinite(x) ? Report(x) : Report(nullptr); }

Report quantiles(const LogHistogram& of) {
  return {
      {"median", number(of.quantile(0.5))}, {"p99", number(of.quantile(0.99))}, {"max", number(of.max())}};
}

}  // namespace

void LogHistogram::add(double x) {
  if (!(x >= 0)) return;
  ++bins_[std::bit_cast<std::uint32_t>(std::fabs(static_cast<float>(x))) >> kShift];
  ++count_;
  max_ = std::max(max_, x);
}

double LogHistogram::quantile(double share) const {
  const double rank = std::ceil(share * static_cast<double>(count_));
  std::uint64_t below = 0;
  for (std::uint32_t bin = 0; bin < bins_.size(); ++bin)
    if ((below += bins_[bin]) > 0 && static_cast<double>(below) >= rank)
      return std::bit_cast<float>(bin << kShift);
  return 0;
}

bool is_worse(const RayQuality& a, const RayQuality& b) {
  if (is_doubtful(a.status) != is_doubtful(b.status)) return is_doubtful(a.status);
  if (comparable(a.error) != comparable(b.error)) return comparable(a.error) > comparable(b.error);
  return a.place < b.place;
}

void Quality::add(const Rays& rays) {
  for (std::size_t i = 0; i < rays.status.size(); ++i) {
    const RayQuality ray = {next_++, rays.status[i], rays.steps[i], rays.error[i], rays.drift[i]};
    if (ray.status == static_cast<std::uint32_t>(Status::not_traced)) continue;
    steps_.add(ray.steps);
    error_.add(static_cast<double>(ray.error));
    drift_.add(static_cast<double>(ray.drift));
    doubtful_ += is_doubtful(ray.status);
    if (is_doubtful(ray.status) || !(ray.error <= 0)) list(ray);
  }
}

void Quality::list(const RayQuality& ray) {
  if (most_ == 0 || (worst_.size() == most_ && !is_worse(ray, worst_.front()))) return;
  if (worst_.size() == most_) {
    std::ranges::pop_heap(worst_, is_worse);
    worst_.pop_back();
  }
  worst_.push_back(ray);
  std::ranges::push_heap(worst_, is_worse);
}

Report Quality::describe(const RayQuality& ray) const {
  const auto n = static_cast<std::uint64_t>(manifest_.samples),
             wide = n * static_cast<std::uint64_t>(manifest_.width);
  const std::uint64_t column = ray.place % wide, row = ray.place / wide;
  return {{"pixel", {column / n, static_cast<std::uint64_t>(manifest_.first_line) + row / n}},
          {"sample", row % n * n + column % n},
          {"status", status_name(ray.status)},
          {"steps", ray.steps},
          {"error", nullcone::number(ray.error)},
          {"drift", nullcone::number(ray.drift)}};
}

Report Quality::report() const {
  std::vector<RayQuality> sorted = worst_;
  std::ranges::sort(sorted, is_worse);
  Report worst = Report::array();
  for (const RayQuality& ray : sorted) worst.push_back(describe(ray));
  return {{"steps",
           {{"median", static_cast<std::uint64_t>(steps_.quantile(0.5))},
            {"max", static_cast<std::uint64_t>(steps_.max())}}},
          {"error", quantiles(error_)},
          {"drift", quantiles(drift_)},
          {"resolution", LogHistogram::kResolution},
          {"doubtful", doubtful_},
          {"worst", worst}};
}

}  // namespace nullcone
