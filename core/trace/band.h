// The rays of a band of pixels, side by side in packs.
#pragma once

#include "core/base/boost.h"
#include "core/base/camera.h"
#include "core/trace/records.h"

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
  double *limit = nullptr, *steps = nullptr;   ///< limit: in lambda; below 0 where the camera has no ray
  double *lambda = nullptr, *taken = nullptr;  ///< of the search under way: how far, and how many steps
  std::unique_ptr<std::uint32_t[]> nearest;    ///< object number from 1, 0 for none
  std::unique_ptr<std::uint32_t[]> list;       ///< rays that a search or a record is about
  std::unique_ptr<bool[]> doubtful;

  bool exists(std::size_t ray) const { return limit[ray] >= 0; }

  explicit BandRays(std::size_t rays)
      : count(rays),
        padded((rays + 7) / 8 * 8),
        memory(new double[8 * padded]),
        nearest(new std::uint32_t[padded]()),
        list(new std::uint32_t[padded]),
        doubtful(new bool[padded]()) {
    for (std::size_t i = 0; i < 4; ++i) k[i] = memory.get() + i * padded;
    limit = memory.get() + 4 * padded;
    steps = memory.get() + 5 * padded;
    lambda = memory.get() + 6 * padded;
    taken = memory.get() + 7 * padded;
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
  /// f(i) of each ray i.
  template <class F>
  S gather(F&& f) const {
    std::array<double, kWidth> values{};
    for (std::size_t lane = 0; lane < kWidth; ++lane) values[lane] = f(ray[lane]);
    return Lanes<S>::load(values.data());
  }
};

/// The rays of a band as the camera sends them into the past.
struct CameraRays {
  Camera camera;
  Vec4<double> u;  ///< the camera's 4-velocity, in the static tetrad
  int first_line = 0;

  /// The tangent, in the static tetrad, of the ray through picture coordinates (x + dx, y + dy), on the part
  /// of the picture to which (x, y) belongs.
  template <class S>
  Vec4<S> past(const S& x, const S& y, double dx = 0, double dy = 0) const {
    return -seen_photon(convert<S>(u), look_direction(camera, x, y, S(dx), S(dy)));
  }
  /// The tangents of rays at a part `h` of a pixel beside those of some rays of the band: to the right, to
  /// the left, down, up. They lie beside one another in the sky too: past the edge of a face the map goes on.
  template <class S, class F>
  std::array<Vec4<S>, 4> beside(const Group<S>& group, double h, F&& ray_of) const {
    const auto width = static_cast<std::size_t>(camera.width);
    const S x = group.gather([&](std::size_t i) { return static_cast<double>(ray_of(i) % width) + 0.5; });
    const S y = group.gather(
        [&](std::size_t i) { return static_cast<double>(ray_of(i) / width) + (first_line + 0.5); });
    return {past(x, y, h), past(x, y, -h), past(x, y, 0, h), past(x, y, 0, -h)};
  }
};

/// Camera rays of a band: the photon that arrives at each pixel, followed into the past.
template <class S>
void aim(const CameraRays& from, double lookback, BandRays& rays) {
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
    const Vec4<S> past = from.past(at_x, at_y);
    for (std::size_t c = 0; c < 4; ++c) Lanes<S>::store(past[c], rays.k[c] + i);
    Lanes<S>::store(select(has_ray(camera, at_x, at_y), S(lookback), S(-kFar)), rays.limit + i);
    Lanes<S>::store(S(0.0), rays.steps + i);
  }
}

NULLCONE_KERNEL_END
