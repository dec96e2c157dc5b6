#include "postrender/coats.h"

#include <algorithm>
#include <cmath>
#include <limits>
#include <set>

namespace nullcone::postrender {

namespace {

constexpr double kNever = std::numeric_limits<double>::infinity();

/// From 0 to 1 along `duration` about `edge`; a step without it.
double ramp(double time, double edge, double duration) {
  if (duration == 0) return time >= edge ? 1 : 0;
  const double grown = 0.5 + (time - edge) / duration;
  return grown > 0 ? std::min(grown, 1.0) : 0;
}

/// What follows one another from `first` on, as it is seen now, with `share` of the light.
void add(const Timeline& timeline, std::size_t first, const Times& times, double share, Coats& out,
         std::size_t& count) {
  const auto put = [&](std::size_t offset, double part) {
    if (part > 0) out[count++] = {static_cast<std::uint32_t>(first + offset), static_cast<float>(part)};
  };
  if (timeline.count == 1) return put(0, share);
  const Timeline::Place place = timeline.at(times);
  put(place.first, share * (1 - static_cast<double>(place.share)));
  put(place.second, share * static_cast<double>(place.share));
}

}  // namespace

double Slice::share(double time) const {
  const double here = std::isinf(from) ? 1 : ramp(time, from, fade_in);
  const double gone = std::isinf(to) ? 0 : ramp(time, to, fade_out);
  return std::min(here, 1 - gone);
}

SliceTable::SliceTable(std::vector<Slice> slices) : slices_(std::move(slices)) {
  t_ = tabulated(Clock::t);
  tau_ = tabulated(Clock::tau);
}

SliceTable::OneClock SliceTable::tabulated(Clock clock) const {
  OneClock out;
  // Step 1: edges, and who comes and goes at them.
  std::vector<std::pair<double, std::uint32_t>> coming, going;
  for (std::uint32_t i = 0; i < slices_.size(); ++i) {
    const Slice& slice = slices_[i];
    if (slice.clock != clock) continue;
    coming.emplace_back(slice.start(), i);
    going.emplace_back(slice.end(), i);
    for (const double edge :
         {slice.start(), slice.from + slice.fade_in / 2, slice.to - slice.fade_out / 2, slice.end()})
      if (std::isfinite(edge)) out.edges.push_back(edge);
  }
  std::ranges::sort(out.edges);
  out.edges.erase(std::unique(out.edges.begin(), out.edges.end()), out.edges.end());
  std::ranges::sort(coming);
  std::ranges::sort(going);
  // Step 2: from edge to edge.
  std::set<std::uint32_t> there;
  std::size_t come = 0, gone = 0;
  out.begin.push_back(0);
  for (std::size_t i = 0; i <= out.edges.size(); ++i) {
    const double low = i == 0 ? -kNever : out.edges[i - 1];
    const double high = i == out.edges.size() ? kNever : out.edges[i];
    for (; come < coming.size() && coming[come].first <= low; ++come) there.insert(coming[come].second);
    for (; gone < going.size() && going[gone].first <= low; ++gone) there.erase(going[gone].second);
    for (const std::uint32_t number : there) {
      const Slice& slice = slices_[number];
      if (out.numbers.size() - out.begin.back() == kMostFades) throw TooManyFades{low};
      out.numbers.push_back(number);
      if (low >= slice.from + slice.fade_in / 2 && high <= slice.to - slice.fade_out / 2) break;
    }
    out.begin.push_back(static_cast<std::uint32_t>(out.numbers.size()));
  }
  return out;
}

std::span<const std::uint32_t> SliceTable::candidates(Clock clock, double time) const {
  const OneClock& table = clock == Clock::tau ? tau_ : t_;
  if (table.numbers.empty() || std::isnan(time)) return {};
  const auto i = static_cast<std::size_t>(std::ranges::upper_bound(table.edges, time) - table.edges.begin());
  return std::span(table.numbers).subspan(table.begin[i], table.begin[i + 1] - table.begin[i]);
}

bool ObjectShading::blends() const {
  return timeline.count > 1 || std::ranges::any_of(slices.slices(), [](const Slice& slice) {
           return slice.fade_in > 0 || slice.fade_out > 0 || slice.timeline.count > 1;
         });
}

Clocks ObjectShading::clocks() const {
  Clocks out;
  const auto add_timeline = [&](const Timeline& line) {
    if (line.count > 1) out.add(line.clock);
  };
  add_timeline(timeline);
  for (const Slice& slice : slices.slices()) {
    out.add(slice.clock);
    add_timeline(slice.timeline);
  }
  return out;
}

std::size_t find_coats(const ObjectShading& object, const Times& times, Coats& out) {
  std::size_t count = 0;
  double left = 1;
  auto by_t = object.slices.candidates(Clock::t, times.t),
       by_tau = object.slices.candidates(Clock::tau, times.tau);
  while (left > 0 && !(by_t.empty() && by_tau.empty())) {
    auto& next = by_tau.empty() || (!by_t.empty() && by_t.front() < by_tau.front()) ? by_t : by_tau;
    const Slice& slice = object.slices.slices()[next.front()];
    next = next.subspan(1);
    const double share = left * slice.share(times.at(slice.clock));
    add(slice.timeline, slice.appearance, times, share, out, count);
    left -= share;
  }
  if (left > 0) add(object.timeline, object.appearance, times, left, out, count);
  return count;
}

}  // namespace nullcone::postrender
