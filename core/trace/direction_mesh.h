// A mesh of triangles over the sphere of directions that is refined edge by edge, so that it has no cracks.
#pragma once

#include "core/trace/critical_curve.h"
#include "core/trace/crossings.h"

NULLCONE_KERNEL_BEGIN

/// The middle of each edge: an open hash table.
class EdgeMap {
 public:
  EdgeMap() : keys_(new std::uint64_t[room_]()), values_(new std::uint32_t[room_]) {}

  /// What belongs to the edge between two different vertices; `make` is asked for it the first time.
  template <class F>
  std::uint32_t at(std::uint32_t a, std::uint32_t b, F&& make) {
    if (2 * size_ >= room_) grow();
    const std::uint64_t key = (std::uint64_t{a < b ? a : b} << 32) | (a < b ? b : a);  // never 0
    const std::size_t slot = slot_of(key);
    if (keys_[slot] == 0) {
      keys_[slot] = key, values_[slot] = make();
      ++size_;
    }
    return values_[slot];
  }

 private:
  std::size_t slot_of(std::uint64_t key) const {
    std::size_t slot = static_cast<std::size_t>((key * 0x9e3779b97f4a7c15u) >> 20) % room_;
    while (keys_[slot] != 0 && keys_[slot] != key) slot = (slot + 1) % room_;
    return slot;
  }
  void grow() {
    const std::size_t before = room_;
    const auto keys = std::exchange(keys_, std::unique_ptr<std::uint64_t[]>(new std::uint64_t[2 * before]()));
    const auto values =
        std::exchange(values_, std::unique_ptr<std::uint32_t[]>(new std::uint32_t[2 * before]));
    room_ = 2 * before;
    for (std::size_t i = 0; i < before; ++i) {
      if (keys[i] == 0) continue;
      const std::size_t slot = slot_of(keys[i]);
      keys_[slot] = keys[i], values_[slot] = values[i];
    }
  }
  std::size_t room_ = 1 << 14, size_ = 0;
  std::unique_ptr<std::uint64_t[]> keys_;
  std::unique_ptr<std::uint32_t[]> values_;
};

struct MeshTriangle {
  std::array<std::uint32_t, 3> corner;
  std::array<std::uint32_t, 3> middle;  ///< of the edges from corner i to corner i + 1
};

struct DirectionMesh {
  Pool<Vec3<double>> places{4096};  ///< of the vertices, corners and middles (critical_curve.h)
  Pool<MeshTriangle> triangles{4096};
  EdgeMap edges;
  CriticalCurve curve;

  /// Rows along the critical curve for light that turns up to `turning`; columns across it.
  DirectionMesh(const CriticalCurve& along, double turning) : curve(along) {
    std::uint32_t row = 0, before_curve = 0;
    const auto add_row = [&](double e) {
      if (e > 0 && before_curve == 0) before_curve = row;
      for (std::size_t j = 0; j < CriticalCurve::kColumns; ++j)
        places.push({{e, CriticalCurve::phi_of(4 * j), 0}});
      ++row;
    };
    curve.for_each_row(turning, add_row);
    for (std::uint32_t i = 0; i + 1 < row; ++i) {
      // The rows come from either pole towards the curve.
      const std::uint32_t here = i, there = i + 1 == before_curve ? row - 1 : i + 1;
      for (std::uint32_t j = 0; j < CriticalCurve::kColumns; ++j) {
        constexpr auto kColumns = static_cast<std::uint32_t>(CriticalCurve::kColumns);
        const std::uint32_t next = (j + 1) % kColumns, p = kColumns * here, q = kColumns * there;
        add(triangles, p + j, p + next, q + j);
        add(triangles, q + j, p + next, q + next);
      }
    }
  }

  /// An icosahedron, subdivided `levels` times.
  explicit DirectionMesh(int levels) {
    constexpr double kGolden = 1.6180339887498949;
    for (int axis = 0; axis < 3; ++axis)
      for (int signs = 0; signs < 4; ++signs) {
        Vec3<double> v{};
        v[static_cast<std::size_t>(axis)] = signs % 2 == 0 ? 1 : -1;
        v[static_cast<std::size_t>((axis + 1) % 3)] = signs < 2 ? kGolden : -kGolden;
        places.push(normalised(v));
      }
    for (std::uint32_t a = 0; a < 12; ++a)
      for (std::uint32_t b = a + 1; b < 12; ++b)
        for (std::uint32_t c = b + 1; c < 12; ++c)
          if (adjacent(a, b) && adjacent(b, c) && adjacent(a, c)) add(triangles, a, b, c);
    for (int level = 0; level < levels; ++level) {
      Pool<MeshTriangle> finer(4 * triangles.size());
      for (std::size_t i = 0; i < triangles.size(); ++i) split(triangles[i], {true, true, true}, finer);
      triangles = std::move(finer);
    }
  }

  /// The triangles that stand for one of which some edges are bisected.
  void split(const MeshTriangle& triangle, const std::array<bool, 3>& bisected, Pool<MeshTriangle>& out) {
    const int count = bisected[0] + bisected[1] + bisected[2];
    std::size_t first = 0;  // one edge: it is the first; two: the third is whole
    while (count == 1 ? !bisected[first] : count == 2 && bisected[(first + 2) % 3]) ++first;
    const auto c = [&](std::size_t i) { return triangle.corner[(first + i) % 3]; };
    const auto m = [&](std::size_t i) { return triangle.middle[(first + i) % 3]; };
    if (count == 1) {
      add(out, c(0), m(0), c(2)), add(out, m(0), c(1), c(2));
    } else if (count == 2) {
      add(out, m(0), c(1), m(1)), add(out, c(0), m(0), m(1)), add(out, c(0), m(1), c(2));
    } else {
      for (const auto& part : quarters(triangle)) add(out, part[0], part[1], part[2]);
    }
  }
  static std::array<std::array<std::uint32_t, 3>, 4> quarters(const MeshTriangle& t) {
    const auto &c = t.corner, &m = t.middle;
    return {{{c[0], m[0], m[2]}, {m[0], c[1], m[1]}, {m[2], m[1], c[2]}, {m[0], m[1], m[2]}}};
  }

 private:
  bool adjacent(std::uint32_t a, std::uint32_t b) const { return dot(places[a], places[b]) > 0.4; }
  std::uint32_t middle(std::uint32_t a, std::uint32_t b) {
    return edges.at(a, b, [&] {
      const Vec3<double> place = places[a] + 0.5 * curve.way(places[a], places[b]);
      places.push(curve.exists ? place : normalised(place));
      return static_cast<std::uint32_t>(places.size() - 1);
    });
  }
  void add(Pool<MeshTriangle>& to, std::uint32_t a, std::uint32_t b, std::uint32_t c) {
    to.push({{a, b, c}, {middle(a, b), middle(b, c), middle(c, a)}});
  }
};

NULLCONE_KERNEL_END
