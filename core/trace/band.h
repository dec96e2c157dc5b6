// The rays of a band of pixels, side by side in packs.
#pragma once

#include "core/base/camera.h"
#include "core/trace/records.h"
#include "core/trace/viewpoint.h"

NULLCONE_KERNEL_BEGIN

#ifdef NULLCONE_ONE_LANE
using Wide = double;  // the same numbers, one ray at a time: for comparison
#else
using Wide = Pack;
#endif

/// The rays of a band, and the nearest crossing found so far; structure of arrays, padded to whole packs.
struct BandRays {
  std::size_t count = 0, padded = 0;
  std::unique_ptr<double[]> memory;
  std::array<double*, 4> k{};                  ///< past-directed tangent in the static tetrad
  std::array<double*, 4> start{};              ///< events, where rays start at a film; else null
  double *limit = nullptr, *steps = nullptr;   ///< limit: in lambda; below 0 where the camera has no ray
  double *lambda = nullptr, *taken = nullptr;  ///< of the search under way: how far, and how many steps
  std::unique_ptr<std::uint32_t[]> nearest;    ///< object number from 1, 0 for none
  std::unique_ptr<std::uint32_t[]> list;       ///< rays that a search or a record is about
  std::unique_ptr<bool[]> doubtful;

  bool exists(std::size_t ray) const { return limit[ray] >= 0; }
  bool from_film() const { return start[0] != nullptr; }

  BandRays(std::size_t rays, bool film)
      : count(rays),
        padded((rays + 7) / 8 * 8),
        memory(new double[(film ? 12 : 8) * padded]),
        nearest(new std::uint32_t[padded]()),
        list(new std::uint32_t[padded]),
        doubtful(new bool[padded]()) {
    for (std::size_t i = 0; i < 4; ++i) k[i] = memory.get() + i * padded;
    limit = memory.get() + 4 * padded;
    steps = memory.get() + 5 * padded;
    lambda = memory.get() + 6 * padded;
    taken = memory.get() + 7 * padded;
    for (std::size_t i = 0; film && i < 4; ++i) start[i] = memory.get() + (8 + i) * padded;
  }
};

/// Some rays of a list, side by side in a pack; the last one is repeated where the list ends.
template <class S>
struct Group {
  static constexpr std::size_t kWidth = Lanes<S>::count;
  std::array<std::size_t, kWidth> ray{};
  std::size_t filled;

  Group(const std::uint32_t* list, std::size_t from, std::size_t end) : filled(std::min(kWidth, end - from)) {
    for (std::size_t lane = 0; lane < kWidth; ++lane) ray[lane] = list[from + std::min(lane, filled - 1)];
  }
  S load(const double* column) const {
    std::array<double, kWidth> values{};
    for (std::size_t lane = 0; lane < kWidth; ++lane) values[lane] = column[ray[lane]];
    return Lanes<S>::load(values.data());
  }
  void store(const S& x, double* column) const {
    std::array<double, kWidth> values{};
    Lanes<S>::store(x, values.data());
    for (std::size_t lane = 0; lane < filled; ++lane) column[ray[lane]] = values[lane];
  }
  Vec4<S> load_k(const BandRays& rays) const {
    return Vec4<S>::map([&](std::size_t c) { return load(rays.k[c]); });
  }
  Vec4<S> load_start(const BandRays& rays) const {
    return Vec4<S>::map([&](std::size_t c) { return load(rays.start[c]); });
  }
  /// f(i) of each ray i.
  template <class F>
  S gather(F&& f) const {
    std::array<double, kWidth> values{};
    for (std::size_t lane = 0; lane < kWidth; ++lane) values[lane] = f(ray[lane]);
    return Lanes<S>::load(values.data());
  }
};

/// The rays of a band as the camera sends them into the past.
template <Metric M>
struct CameraRays {
  Camera camera;
  Viewpoint<M> from;
  int first_line = 0;

  /// The ray through picture coordinates (x + dx, y + dy), on the part of the picture to which (x, y)
  /// belongs.
  template <class S>
  RayStart<S> start(const S& x, const S& y, double dx = 0, double dy = 0) const {
    const Vec4<S> past = -seen_photon(convert<S>(from.u), look_direction(camera, x, y, S(dx), S(dy)));
    if (!has_film(camera)) return {convert<S>(from.event), past};
    return from.aside(place_on_film(camera, x, y, S(dx), S(dy)), past);
  }
  /// Rays at a part `h` of a pixel beside those of some rays of the band: to the right, to the left, down,
  /// up. They lie beside one another in the sky too: past the edge of a face the map goes on.
  template <class S, class F>
  std::array<RayStart<S>, 4> beside(const Group<S>& group, double h, F&& ray_of) const {
    const auto width = static_cast<std::size_t>(camera.width);
    const S x = group.gather([&](std::size_t i) { return static_cast<double>(ray_of(i) % width) + 0.5; });
    const S y = group.gather(
        [&](std::size_t i) { return static_cast<double>(ray_of(i) / width) + (first_line + 0.5); });
    return {start(x, y, h), start(x, y, -h), start(x, y, 0, h), start(x, y, 0, -h)};
  }
};

/// Camera rays of a band: the photon that arrives at each pixel, followed into the past.
template <class S, Metric M>
void aim(const CameraRays<M>& from, double lookback, BandRays& rays) {
  const Camera& camera = from.camera;
  int column = 0, line = from.first_line;  // of the next ray; the last ray is repeated to fill the last pack
  for (std::size_t i = 0; i < rays.padded; i += Lanes<S>::count) {
    std::array<double, Lanes<S>::count> x{}, y{};
    for (std::size_t lane = 0; lane < x.size(); ++lane) {
      x[lane] = column + 0.5;
      y[lane] = line + 0.5;
      if (i + lane + 1 < rays.count && ++column == camera.width) column = 0, ++line;
    }
    const S at_x = Lanes<S>::load(x.data()), at_y = Lanes<S>::load(y.data());
    const RayStart<S> ray = from.start(at_x, at_y);
    for (std::size_t c = 0; c < 4; ++c) Lanes<S>::store(ray.past[c], rays.k[c] + i);
    if (rays.from_film())
      for (std::size_t c = 0; c < 4; ++c) Lanes<S>::store(ray.event[c], rays.start[c] + i);
    Lanes<S>::store(select(has_ray(camera, at_x, at_y), S(lookback), S(-kFar)), rays.limit + i);
    Lanes<S>::store(S(0.0), rays.steps + i);
  }
}

NULLCONE_KERNEL_END
