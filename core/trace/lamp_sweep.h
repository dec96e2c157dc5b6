// The light cone of a lamp at rest, swept once: a mesh of future-directed rays, refined where neighbours
// part, leaves prisms wherever it passes a target.
#pragma once

#include "core/trace/band.h"
#include "core/trace/prism_grid.h"
#include "core/trace/scan_rays.h"

NULLCONE_KERNEL_BEGIN

/// Comparisons that sort three numbers.
inline constexpr std::array<std::array<std::size_t, 2>, 3> kSortThree = {{{0, 1}, {1, 2}, {0, 1}}};

template <Metric M>
class LampSweep {
 public:
  /// Of rays that have swept less than `most_turning` about the origin, up to lambda = lookback (frequency 1
  /// at the lamp).
  LampSweep(const M& metric, const Vec4<double>& place, double most_turning, double lookback,
            const Ball* targets, std::size_t count)
      : setting_{{metric},
                 {tolerance_for(most_turning), 0, Integrator::verner65},
                 1,
                 kFar,
                 most_turning + kMargin},
        start_(metric, place),
        mesh_(make_mesh()) {
    for (std::size_t i = 0; i < count; ++i) {
      const Box3 box = Box3::around(targets[i]);
      targets_.add(box.low), targets_.add(box.high);
      const double distance = norm(targets[i].centre), radius = 1.8 * targets[i].radius;  // a cube about it
      setting_.reach = max(setting_.reach, 2 * (distance + radius));
      setting_.inside = min(setting_.inside, 0.5 * max(distance - radius, 0.0));
    }
    if (count > 0) sweep(lookback);
    cone_.make_grids(targets, count);
  }
  LightCone take() { return std::move(cone_); }

 private:
  static constexpr int kLevels = 3;
  /// Beside the critical curve errors grow as distances from it shrink.
  static double tolerance_for(double turning) {
    return is_central<M>() ? max(1e-12, 1e-6 * decay(turning - std::numbers::pi)) : 1e-6;
  }
  static constexpr double kMargin = 1;  ///< radians that rays go on, lest triangles be cut at the limit
  static constexpr std::size_t kMostRays = 60000, kMostSlices = 3000, kMostPrisms = 8000000;

  DirectionMesh make_mesh() {
    cone_.curve = find_critical_curve<Wide>(stepper_, setting_, start_);
    return cone_.curve.exists ? DirectionMesh(cone_.curve, setting_.most_turning) : DirectionMesh(kLevels);
  }

  void sweep(double lookback) {
    double lambda = 0, length = 0.1 * length_scale(setting_.system.metric, start_.place);
    for (; lambda < lookback; ++slice_) {
      const double next = min(lambda + length, lookback);
      launch();
      const Pool<std::uint32_t> list = rays_in_use();
      if (list.size() == 0) break;
      cone_.complete = slice_ <= kMostSlices && cone_.prisms.size() <= kMostPrisms;
      if (!cone_.complete) break;
      advance_rays<Wide>(stepper_, setting_, rays_, list, lambda, next);
      refine(lambda, next);
      leave_prisms(lambda, next);
      length = next_length(list, next - lambda);
      drop_triangles();
      lambda = next;
    }
  }

  /// Rays for the mesh's new vertices.
  void launch() {
    while (rays_.size() < mesh_.places.size()) {
      rays_.push(start_.ray(stepper_, setting_, mesh_.curve.direction(mesh_.places[rays_.size()])));
    }
  }

  /// The rays of all triangles; those that go on.
  Pool<std::uint32_t> rays_in_use() {
    Pool<std::uint32_t> out(rays_.size());
    for (std::size_t i = 0; i < mesh_.triangles.size(); ++i)
      for (const auto* three : {&mesh_.triangles[i].corner, &mesh_.triangles[i].middle})
        for (const std::uint32_t number : *three) {
          ScanRay& ray = rays_[number];
          if (std::exchange(ray.slice, slice_) == slice_) continue;
          ray.begin_slice();
          if (ray.fate == ScanFate::goes_on) out.push(number);
        }
    return out;
  }

  /// Whether the ray in the middle of an edge tells something that its ends do not.
  bool is_too_coarse(const ScanRay& a, const ScanRay& middle, const ScanRay& b) const {
    constexpr double kMostEdge = 0.5, kLeastEdge = 0.02, kMostSag = 0.1, kLeastSag = 0.01, kMostBend = 0.05,
                     kMostFall = 1.7;
    if (a.fate == ScanFate::left || b.fate == ScanFate::left || middle.fate == ScanFate::left) return false;
    const auto stands = [](const ScanRay& r) { return r.fate == ScanFate::stands; };
    const auto creeps = [&](const ScanRay& r) {
      return stands(r) || (is_central<M>() && r.rate > kFastRate);
    };
    if (stands(a) && stands(middle) && stands(b)) return false;
    const auto& metric = setting_.system.metric;
    const double scale = min(length_scale(metric, to_phase(a.y).x), length_scale(metric, to_phase(b.y).x));
    const double edge = norm(b.X() - a.X()), sag = norm(middle.X() - 0.5 * (a.X() + b.X()));
    if (creeps(a) || creeps(middle) || creeps(b)) return edge > kMostFall * scale;
    if (edge > kMostEdge * scale) return true;
    if (sag > kMostSag * edge && sag > kLeastSag * scale) return true;
    const Vec3<double> bend = normalised(middle.V) - 0.5 * (normalised(a.V) + normalised(b.V));
    return norm(bend) > kMostBend && edge > kLeastEdge * scale;
  }
  bool is_too_coarse(const MeshTriangle& t, std::size_t i) const {
    return is_too_coarse(rays_[t.corner[i]], rays_[t.middle[i]], rays_[t.corner[(i + 1) % 3]]);
  }

  /// Bisects edges until none is too coarse. New rays catch up from the lamp.
  void refine(double from, double to) {
    std::size_t first = 0;
    while (first < mesh_.triangles.size() && rays_.size() < kMostRays) {
      Pool<MeshTriangle> kept(mesh_.triangles.size()), finer(64);
      for (std::size_t i = 0; i < mesh_.triangles.size(); ++i) {
        const MeshTriangle t = mesh_.triangles[i];
        std::array<bool, 3> coarse{};
        for (std::size_t e = 0; e < 3 && i >= first; ++e) coarse[e] = is_too_coarse(t, e);
        if (coarse[0] || coarse[1] || coarse[2])
          mesh_.split(t, coarse, finer);
        else
          kept.push(t);
      }
      first = kept.size();
      for (std::size_t i = 0; i < finer.size(); ++i) kept.push(finer[i]);
      mesh_.triangles = std::move(kept);
      catch_up(from, to);
    }
  }
  void catch_up(double from, double to) {
    Pool<std::uint32_t> late(64), going(64);
    const auto number = static_cast<std::uint32_t>(rays_.size());
    launch();
    for (std::uint32_t i = number; i < rays_.size(); ++i) late.push(i);
    advance_rays<Wide>(stepper_, setting_, rays_, late, 0, from);
    for (std::uint32_t i = number; i < rays_.size(); ++i) {
      rays_[i].begin_slice();
      rays_[i].slice = slice_;
      if (rays_[i].fate == ScanFate::goes_on) going.push(i);
    }
    advance_rays<Wide>(stepper_, setting_, rays_, going, from, to);
  }

  std::uint32_t node_of(std::uint32_t ray, bool end, double lambda) {
    ScanRay& r = rays_[ray];
    std::uint32_t& node = end ? r.node : r.node_before;
    if (node == UINT32_MAX) {
      cone_.nodes.push({spatial(to_phase(end ? r.y : r.before).x), mesh_.places[ray], lambda,
                        end ? r.turning : r.turning_before});
      node = static_cast<std::uint32_t>(cone_.nodes.size() - 1);
    }
    return node;
  }

  void leave_prisms(double from, double to) {
    for (std::size_t i = 0; i < mesh_.triangles.size(); ++i) {
      const MeshTriangle& t = mesh_.triangles[i];
      const bool unresolved =
          rays_.size() >= kMostRays && (is_too_coarse(t, 0) || is_too_coarse(t, 1) || is_too_coarse(t, 2));
      for (std::array<std::uint32_t, 3> ray : DirectionMesh::quarters(t)) {
        Box3 box;
        bool left = false;
        for (const std::uint32_t r : ray) {
          box.add(rays_[r].X()), box.add(spatial(to_phase(rays_[r].before).x));
          left = left || rays_[r].fate_before == ScanFate::left;
        }
        box.widen(kInflation);
        if (left || !box.touches(targets_)) continue;
        ScanPrism prism{{}, false, unresolved};
        for (const auto& [a, b] : kSortThree)
          if (ray[a] > ray[b]) std::swap(ray[a], ray[b]), prism.odd = !prism.odd;
        for (std::size_t c = 0; c < 3; ++c) {
          prism.node[c] = node_of(ray[c], false, from);
          prism.node[c + 3] = node_of(ray[c], true, to);
        }
        cone_.prisms.push(prism);
        cone_.unresolved += unresolved;
      }
    }
  }

  /// Those stay of which some ray goes on, and none has left.
  void drop_triangles() {
    Pool<MeshTriangle> kept(mesh_.triangles.size());
    for (std::size_t i = 0; i < mesh_.triangles.size(); ++i) {
      const MeshTriangle& t = mesh_.triangles[i];
      int stand = 0, leave = 0;
      for (const auto* three : {&t.corner, &t.middle})
        for (const std::uint32_t r : *three)
          stand += rays_[r].fate == ScanFate::stands, leave += rays_[r].fate == ScanFate::left;
      if (stand < 6 && leave == 0) kept.push(t);
    }
    mesh_.triangles = std::move(kept);
  }

  /// Slices are so short that no ray turns much in them, or comes far.
  double next_length(const Pool<std::uint32_t>& list, double length) const {
    constexpr double kMostTurn = 0.2, kMostReach = 0.3, kLeastReach = 0.03;
    double turn = 1e-3, reach = 1e300;
    for (std::size_t i = 0; i < list.size(); ++i) {
      const ScanRay& ray = rays_[list[i]];
      if (ray.fate != ScanFate::goes_on || (is_central<M>() && ray.rate > kFastRate)) continue;
      turn = max(turn, angle_between(ray.V_before, ray.V));
      reach = min(reach, length_scale(setting_.system.metric, to_phase(ray.y).x) / norm(ray.V));
    }
    const double wanted = length * max(0.3, min(1.5, kMostTurn / turn));
    return max(kLeastReach * reach, min(kMostReach * reach, wanted));
  }

  Verner65<Wide> stepper_;
  ScanSetting<M> setting_;
  ScanStart<M> start_;
  LightCone cone_;
  DirectionMesh mesh_;
  Box3 targets_;
  Pool<ScanRay> rays_{4096};
  std::uint32_t slice_ = 1;
};

NULLCONE_KERNEL_END
