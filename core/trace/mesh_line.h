// A straight line through the boxes of a mesh, nearest first. One lane.
//
// Boxes are in single precision, four side by side, on a line that is measured from its point nearest to the
// mesh: what rounding does there is below kSlack. The four lanes are plain SSE2 on every machine.
#pragma once

#include "core/base/vector.h"
#include "core/scene/mesh.h"

NULLCONE_KERNEL_BEGIN

/// What rounding in single precision may do in the tree's frame, and some.
inline constexpr double kBoxSlack = 2e-6;

/// From which triangle on, and how many.
struct LeafRange {
  std::uint32_t first, count;
  explicit LeafRange(std::uint32_t child) : first(child & 0x1fffffff), count((child >> 29 & 3) + 1) {}
};

/// What rays need to know of a mesh. Its arrays stay the mesh's own.
struct MeshView {
  const MeshNode* nodes;
  const MeshTriangle* triangles;
  const MeshUv* uv;            ///< null: none
  const MeshNormals* normals;  ///< null: none
  double unit;
  Vec3<double> centre;  ///< in units, as all below
  double half;
  double ball;  ///< a true length
  bool closed;
};

inline MeshView view_of(const Mesh& mesh) {
  return {mesh.nodes.data(),
          mesh.triangles.data(),
          mesh.uv.empty() ? nullptr : mesh.uv.data(),
          mesh.normals.empty() ? nullptr : mesh.normals.data(),
          mesh.unit,
          Vec3<double>{mesh.centre},
          mesh.half,
          mesh.ball,
          mesh.closed};
}

/// The line X + t W as boxes see it.
class MeshLine {
 public:
  Vec3<double> foot;  ///< its point nearest to the mesh's centre
  double at_foot;     ///< t there
  double speed;       ///< |W|

  MeshLine(const MeshView& mesh, const Vec3<double>& X, const Vec3<double>& W)
      : at_foot(0), speed(norm(W)), half_(mesh.half) {
    const Vec3<double> from = X - mesh.centre;
    const double over_speed = 1 / max(speed, 1e-290);
    const Vec3<double> direction = over_speed * W;
    along_ = over_speed * half_;
    at_foot = -over_speed * dot(from, direction);
    foot = X + at_foot * W;
    const Vec3<double> off = from + at_foot * W;
    distance_ = norm(off);
    for (std::size_t i = 0; i < 3; ++i) {
      foot_[i] = off[i] / half_;
      const double d = direction[i] < 0 ? min(direction[i], -1e-18) : max(direction[i], 1e-18);
      inverse_[i] = static_cast<float>(1 / d);
    }
  }

  /// Looks for what is nearer than `thickness` to the line, from t = `from` until t = `until`.
  void look(double from, double until, double thickness) {
    const double grown = kBoxSlack + thickness / half_;
    for (std::size_t i = 0; i < 3; ++i) {
      const double side = inverse_[i] < 0 ? -grown : grown;
      near_[i] = static_cast<float>(foot_[i] + side), far_[i] = static_cast<float>(foot_[i] - side);
    }
    from_ = place_of(from) - static_cast<float>(grown);
    misses_ = !(distance_ <= 2 * half_ + thickness);
    stop_at(until, grown);
  }
  /// From now on only until t = `until`.
  void look(double until) { stop_at(until, kBoxSlack); }

  /// leaf(triangles) for those whose boxes the line meets, until one returns true.
  template <class Leaf>
  void walk(const MeshView& mesh, Leaf&& leaf) const {
    if (misses_) return;
    struct Waiting {
      std::uint32_t child;
      float near;
    };
    Waiting stack[3 * Mesh::kMostDepth + 4];
    std::size_t top = 0;
    stack[top++] = {0, from_};
    while (top > 0) {
      const Waiting next = stack[--top];
      if (next.near > until_) continue;
      if ((next.child & MeshNode::kLeaf) != 0) {
        if (leaf(LeafRange(next.child))) return;
        continue;
      }
      const MeshNode& node = mesh.nodes[next.child];
      Four enters, leaves;
      meet(node, enters, leaves);
      const std::size_t base = top;
      for (std::size_t i = 0; i < 4; ++i) {
        if (!(enters[i] <= leaves[i])) continue;
        std::size_t k = top++;  // the nearest comes to the top
        for (; k > base && stack[k - 1].near < enters[i]; --k) stack[k] = stack[k - 1];
        stack[k] = {node.child[i], enters[i]};
        fetch(mesh, node.child[i]);
      }
    }
  }

 private:
  using Four = float __attribute__((vector_size(16)));
  static constexpr double kEnd = 8;  ///< the mesh lies within 4 of the foot

  static Four load(const float* from) {
    Four out;
    __builtin_memcpy(&out, from, sizeof out);
    return out;
  }
  /// A large mesh does not fit into caches: what waits is on its way meanwhile.
  static void fetch(const MeshView& mesh, std::uint32_t child) {
    const bool leaf = (child & MeshNode::kLeaf) != 0;
    const void* const from = leaf ? static_cast<const void*>(mesh.triangles + LeafRange(child).first)
                                  : static_cast<const void*>(mesh.nodes + child);
    const char* const bytes = static_cast<const char*>(from);
    __builtin_prefetch(bytes);
    __builtin_prefetch(bytes + 64);
    if (leaf) __builtin_prefetch(bytes + 128);
  }
  static Four all(float x) { return Four{x, x, x, x}; }

  /// Where the line enters and leaves four boxes.
  void meet(const MeshNode& node, Four& enters, Four& leaves) const {
    enters = all(from_), leaves = all(until_);
    for (std::size_t i = 0; i < 3; ++i) {
      const bool back = inverse_[i] < 0;
      const Four in = (load(back ? node.high[i] : node.low[i]) - all(near_[i])) * all(inverse_[i]),
                 out = (load(back ? node.low[i] : node.high[i]) - all(far_[i])) * all(inverse_[i]);
      enters = in > enters ? in : enters;
      leaves = out < leaves ? out : leaves;
    }
  }
  /// t as a length from the foot in the tree's frame.
  float place_of(double t) const { return static_cast<float>(max(-kEnd, min(kEnd, (t - at_foot) / along_))); }
  void stop_at(double until, double grown) { until_ = place_of(until) + static_cast<float>(grown); }

  double half_, along_, distance_;
  double foot_[3];
  float inverse_[3], near_[3], far_[3];
  float from_ = 0, until_ = 0;
  bool misses_ = false;
};

NULLCONE_KERNEL_END
