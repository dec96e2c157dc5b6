#include "core/scene/mesh_tree.h"

#include <algorithm>
#include <bit>
#include <cmath>
#include <limits>
#include <numeric>

namespace nullcone {

namespace {

constexpr float kInfinite = std::numeric_limits<float>::infinity();

struct Bounds {
  std::array<float, 3> low = {kInfinite, kInfinite, kInfinite}, high = {-kInfinite, -kInfinite, -kInfinite};

  void add(const Bounds& b) {
    for (std::size_t i = 0; i < 3; ++i)
      low[i] = std::min(low[i], b.low[i]), high[i] = std::max(high[i], b.high[i]);
  }
  void add_point(const std::array<float, 3>& p) { add({p, p}); }
  /// And a little for its length, so that boxes without a surface differ too.
  float half_area() const {
    const float x = high[0] - low[0], y = high[1] - low[1], z = high[2] - low[2];
    return x < 0 ? 0.0F : x * y + y * z + z * x + 1e-6F * (x + y + z);
  }
};

/// A triangle on its way into a leaf.
struct Reference {
  Bounds bounds;
  std::uint32_t triangle;

  float middle(std::size_t axis) const { return 0.5F * (bounds.low[axis] + bounds.high[axis]); }
};

struct Range {
  std::size_t first, end;
  Bounds bounds;

  std::size_t count() const { return end - first; }
};

/// Where a range is cut: by the surface area heuristic over bins of middles (Wald 2007).
class Cut {
 public:
  static constexpr std::size_t kBins = 16;

  Cut(const std::vector<Reference>& references, const Range& range) {
    for (std::size_t i = range.first; i < range.end; ++i)
      middles_.add_point({references[i].middle(0), references[i].middle(1), references[i].middle(2)});
    std::array<std::array<Bin, kBins>, 3> bins{};
    for (std::size_t i = range.first; i < range.end; ++i)
      for (std::size_t a = 0; a < 3; ++a) {
        Bin& bin = bins[a][number(references[i], a)];
        bin.bounds.add(references[i].bounds);
        ++bin.count;
      }
    for (std::size_t a = 0; a < 3; ++a) try_axis(a, bins[a]);
  }
  bool found() const { return cost_ < kInfinite; }
  bool is_left(const Reference& reference) const { return number(reference, axis_) < bin_; }

 private:
  struct Bin {
    Bounds bounds;
    std::size_t count = 0;
  };

  std::size_t number(const Reference& reference, std::size_t axis) const {
    const float width = middles_.high[axis] - middles_.low[axis];
    if (!(width > 0)) return 0;
    const float at = (reference.middle(axis) - middles_.low[axis]) / width * static_cast<float>(kBins);
    return std::min(static_cast<std::size_t>(at), kBins - 1);
  }
  void try_axis(std::size_t axis, const std::array<Bin, kBins>& bins) {
    std::array<float, kBins> after{};
    Bin sum;
    for (std::size_t i = kBins; i-- > 1;) {
      sum.bounds.add(bins[i].bounds);
      sum.count += bins[i].count;
      after[i] = sum.count == 0 ? -1 : sum.bounds.half_area() * static_cast<float>(sum.count);
    }
    sum = {};
    for (std::size_t i = 1; i < kBins; ++i) {
      sum.bounds.add(bins[i - 1].bounds);
      sum.count += bins[i - 1].count;
      if (sum.count == 0 || after[i] < 0) continue;
      const float cost = sum.bounds.half_area() * static_cast<float>(sum.count) + after[i];
      if (cost < cost_) cost_ = cost, axis_ = axis, bin_ = i;
    }
  }

  Bounds middles_;
  float cost_ = kInfinite;
  std::size_t axis_ = 0, bin_ = 0;
};

class TreeBuilder {
 public:
  TreeBuilder(std::vector<Reference>& references, std::vector<MeshNode>& nodes)
      : references_(references), nodes_(nodes) {}

  void build() {
    Range all{0, references_.size(), {}};
    for (const Reference& r : references_) all.bounds.add(r.bounds);
    add_node(all, 0);
  }

 private:
  /// From this depth on ranges are halved, so that no tree is deeper than Mesh::kMostDepth.
  static constexpr int kHalvedFrom = 36;

  std::uint32_t add_node(const Range& range, int depth) {
    const auto number = static_cast<std::uint32_t>(nodes_.size());
    nodes_.emplace_back();
    std::array<Range, 4> parts{range};
    std::size_t count = 1;
    while (count < 4) {
      std::size_t widest = 4;
      for (std::size_t i = 0; i < count; ++i)
        if (parts[i].count() > MeshNode::kMostInLeaf &&
            (widest == 4 || parts[i].bounds.half_area() > parts[widest].bounds.half_area()))
          widest = i;
      if (widest == 4) break;
      const auto [left, right] = split(parts[widest], depth);
      parts[widest] = left;
      parts[count++] = right;
    }
    for (std::size_t i = 0; i < 4; ++i) {
      const Range part = i < count ? parts[i] : Range{0, 0, {}};
      for (std::size_t a = 0; a < 3; ++a) {
        nodes_[number].low[a][i] = std::min(part.bounds.low[a], 1e30F);
        nodes_[number].high[a][i] = std::max(part.bounds.high[a], -1e30F);
      }
      nodes_[number].child[i] = 0;
      if (part.count() == 0) continue;
      const std::uint32_t child = part.count() <= MeshNode::kMostInLeaf
                                      ? MeshNode::leaf(static_cast<std::uint32_t>(part.first),
                                                       static_cast<std::uint32_t>(part.count()))
                                      : add_node(part, depth + 1);
      nodes_[number].child[i] = child;
    }
    return number;
  }

  std::pair<Range, Range> split(const Range& range, int depth) {
    const auto begin = references_.begin() + static_cast<std::ptrdiff_t>(range.first),
               end = references_.begin() + static_cast<std::ptrdiff_t>(range.end);
    auto middle = begin + (end - begin) / 2;
    if (depth < kHalvedFrom) {
      const Cut cut(references_, range);
      if (cut.found())
        middle = std::partition(begin, end, [&](const Reference& r) { return cut.is_left(r); });
    }
    const auto at = static_cast<std::size_t>(middle - references_.begin());
    Range left{range.first, at, {}}, right{at, range.end, {}};
    for (auto r = begin; r != middle; ++r) left.bounds.add(r->bounds);
    for (auto r = middle; r != end; ++r) right.bounds.add(r->bounds);
    return {left, right};
  }

  std::vector<Reference>& references_;
  std::vector<MeshNode>& nodes_;
};

/// Gives equal positions the same number: that of the first of them.
std::vector<std::uint32_t> merged_numbers(const std::vector<std::array<double, 3>>& positions) {
  const std::size_t size = std::bit_ceil(2 * positions.size() + 1);
  std::vector<std::uint32_t> table(size, TriangleSoup::kNone), out(positions.size());
  for (std::size_t i = 0; i < positions.size(); ++i) {
    std::uint64_t hash = 0;
    for (const double x : positions[i]) {
      hash = (hash ^ std::bit_cast<std::uint64_t>(x + 0.0)) * 0x9e3779b97f4a7c15U;  // -0 is 0
      hash ^= hash >> 29;
    }
    std::size_t at = hash & (size - 1);
    while (table[at] != TriangleSoup::kNone && positions[table[at]] != positions[i])
      at = (at + 1) & (size - 1);
    if (table[at] == TriangleSoup::kNone) table[at] = static_cast<std::uint32_t>(i);
    out[i] = table[at];
  }
  return out;
}

/// Whether every edge is in exactly two triangles that run along it in opposite directions.
bool is_closed(const std::vector<std::array<std::uint32_t, 3>>& triangles, std::size_t positions) {
  // The edges of each vertex that is the lesser end: the other end, times two, and the direction.
  std::vector<std::uint32_t> first(positions + 1);
  const auto for_each_edge = [&](const auto& f) {
    for (const auto& t : triangles)
      for (std::size_t i = 0; i < 3; ++i) f(t[i], t[(i + 1) % 3]);
  };
  for_each_edge([&](std::uint32_t a, std::uint32_t b) { ++first[std::min(a, b) + 1]; });
  std::partial_sum(first.begin(), first.end(), first.begin());
  std::vector<std::uint64_t> edges(first.back());
  std::vector<std::uint32_t> filled(first.begin(), first.end() - 1);
  for_each_edge([&](std::uint32_t a, std::uint32_t b) {
    edges[filled[std::min(a, b)]++] = 2 * std::uint64_t{std::max(a, b)} + (a < b);
  });
  for (std::size_t v = 0; v < positions; ++v) {
    const auto begin = edges.begin() + first[v], end = edges.begin() + first[v + 1];
    if ((end - begin) % 2 != 0) return false;
    std::sort(begin, end);
    for (auto e = begin; e != end; e += 2)
      if (e[0] % 2 != 0 || e[1] != e[0] + 1) return false;
  }
  return !triangles.empty();
}

/// Whether a triangle has a plane.
bool has_area(const MeshTriangle& t) {
  double a[3], b[3];
  for (int i = 0; i < 3; ++i) a[i] = t.corner[1][i] - t.corner[0][i], b[i] = t.corner[2][i] - t.corner[0][i];
  const double x = a[1] * b[2] - a[2] * b[1], y = a[2] * b[0] - a[0] * b[2], z = a[0] * b[1] - a[1] * b[0];
  return x * x + y * y + z * z > 1e-290;
}

template <class T>
void put_in_order(std::vector<T>& values, const std::vector<Reference>& order) {
  if (values.empty()) return;
  std::vector<T> out(order.size());
  for (std::size_t i = 0; i < order.size(); ++i) out[i] = values[order[i].triangle];
  values = std::move(out);
}

/// The triangles as boxes in the tree's frame, which is set.
std::vector<Reference> references_to(const std::vector<MeshTriangle>& triangles,
                                     const std::vector<std::uint32_t>& wanted, Mesh& mesh) {
  std::array<double, 3> low, high;
  low.fill(std::numeric_limits<double>::infinity());
  high.fill(-low[0]);
  for (const std::uint32_t n : wanted)
    for (const auto& corner : triangles[n].corner)
      for (std::size_t i = 0; i < 3; ++i)
        low[i] = std::min(low[i], corner[i]), high[i] = std::max(high[i], corner[i]);
  mesh.half = 0;
  for (std::size_t i = 0; i < 3; ++i) {
    mesh.centre[i] = 0.5 * (low[i] + high[i]);
    mesh.half = std::max(mesh.half, 0.5 * (high[i] - low[i]));
  }
  std::vector<Reference> out(wanted.size());
  for (std::size_t n = 0; n < wanted.size(); ++n) {
    out[n].triangle = wanted[n];
    for (const auto& corner : triangles[wanted[n]].corner) {
      std::array<float, 3> p;
      for (std::size_t i = 0; i < 3; ++i) p[i] = static_cast<float>((corner[i] - mesh.centre[i]) / mesh.half);
      out[n].bounds.add_point(p);
    }
  }
  return out;
}

}  // namespace

Mesh make_mesh(TriangleSoup soup) {
  Mesh mesh;
  const std::vector<std::uint32_t> merged = merged_numbers(soup.positions);
  double ball2 = 0;
  for (auto& t : soup.triangles)
    for (std::uint32_t& corner : t) {
      corner = merged[corner];
      const auto& p = soup.positions[corner];
      ball2 = std::max(ball2, p[0] * p[0] + p[1] * p[1] + p[2] * p[2]);
    }
  mesh.ball = std::sqrt(ball2) * (1 + 1e-15);
  mesh.unit = std::exp2(std::ceil(std::log2(std::max(mesh.ball, 1e-200))));

  // What two corners of which are the same is nothing, also for its neighbours; what is a line for its plane
  // alone, for the neighbours on either side meet along it.
  std::vector<MeshTriangle> corners(soup.triangles.size());
  std::vector<std::array<std::uint32_t, 3>> joined;
  std::vector<std::uint32_t> wanted;
  for (std::size_t n = 0; n < soup.triangles.size(); ++n) {
    const auto& t = soup.triangles[n];
    if (t[0] == t[1] || t[1] == t[2] || t[2] == t[0]) continue;
    joined.push_back(t);
    for (std::size_t k = 0; k < 3; ++k)
      for (std::size_t i = 0; i < 3; ++i) corners[n].corner[k][i] = soup.positions[t[k]][i] / mesh.unit;
    if (has_area(corners[n])) wanted.push_back(static_cast<std::uint32_t>(n));
  }
  mesh.flattened = corners.size() - wanted.size();
  if (wanted.empty()) return mesh;
  mesh.closed = is_closed(joined, soup.positions.size());

  std::vector<Reference> references = references_to(corners, wanted, mesh);
  TreeBuilder(references, mesh.nodes).build();
  mesh.triangles = std::move(corners);
  mesh.uv = std::move(soup.uv);
  mesh.normals = std::move(soup.normals);
  put_in_order(mesh.triangles, references);
  put_in_order(mesh.uv, references);
  put_in_order(mesh.normals, references);
  return mesh;
}

}  // namespace nullcone
