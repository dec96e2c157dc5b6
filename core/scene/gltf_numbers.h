// Numbers in the buffers of a glTF file, and the motions of its nodes. For load_gltf.cpp alone, which
// includes the loader.
#pragma once

#include <array>
#include <cmath>
#include <cstring>
#include <string>

#include "core/scene/mesh_file.h"

namespace nullcone {

namespace {

/// An accessor whose every number lies within its buffer.
class GltfNumbers {
 public:
  std::size_t count = 0;

  GltfNumbers() = default;
  GltfNumbers(const tinygltf::Model& model, const MeshFile& file, int accessor, int components, bool whole) {
    const auto part = [&](const auto& list, int number, const char* what) -> const auto& {
      if (number < 0 || static_cast<std::size_t>(number) >= list.size())
        file.refuse("has no " + std::string(what) + " number " + std::to_string(number));
      return list[static_cast<std::size_t>(number)];
    };
    const tinygltf::Accessor& a = part(model.accessors, accessor, "accessor");
    const std::string name = "accessor number " + std::to_string(accessor);
    if (a.sparse.isSparse) file.refuse("has a sparse " + name + ", which is not read");
    const tinygltf::BufferView& view = part(model.bufferViews, a.bufferView, "buffer view");
    const tinygltf::Buffer& buffer = part(model.buffers, view.buffer, "buffer");
    type_ = a.componentType, normalised_ = a.normalized;
    const bool fits =
        whole ? type_ == kByte || type_ == kShort || type_ == kInt
              : type_ == kFloat || (components == 2 && normalised_ && (type_ == kByte || type_ == kShort));
    const int found = tinygltf::GetNumComponentsInType(static_cast<std::uint32_t>(a.type));
    if (!fits || found != components || a.type == TINYGLTF_TYPE_MAT2)
      file.refuse("has numbers of an unexpected type in " + name);
    width_ = type_ == kByte ? 1 : type_ == kShort ? 2 : 4;
    const std::size_t element = width_ * static_cast<std::size_t>(components), size = buffer.data.size();
    stride_ = view.byteStride == 0 ? element : view.byteStride;
    // Step by step, so that no sum can overflow.
    const bool view_fits = view.byteOffset <= size && view.byteLength <= size - view.byteOffset;
    const bool fits_view =
        view_fits && stride_ >= element && a.byteOffset <= view.byteLength &&
        (a.count == 0 || (element <= view.byteLength - a.byteOffset &&
                          (a.count - 1) <= (view.byteLength - a.byteOffset - element) / stride_));
    if (!fits_view) file.refuse("has an " + name + " that reaches beyond its buffer");
    count = a.count;
    from_ = buffer.data.data() + view.byteOffset + a.byteOffset;
  }

  double get(std::size_t i, std::size_t component) const {
    const unsigned char* const at = from_ + i * stride_ + component * width_;
    if (type_ == kFloat) return static_cast<double>(number<float>(at));
    const double out = type_ == kByte    ? number<std::uint8_t>(at)
                       : type_ == kShort ? number<std::uint16_t>(at)
                                         : number<std::uint32_t>(at);
    return normalised_ && type_ != kInt ? out / (type_ == kByte ? 255 : 65535) : out;
  }

 private:
  static constexpr int kByte = TINYGLTF_COMPONENT_TYPE_UNSIGNED_BYTE,
                       kShort = TINYGLTF_COMPONENT_TYPE_UNSIGNED_SHORT,
                       kInt = TINYGLTF_COMPONENT_TYPE_UNSIGNED_INT, kFloat = TINYGLTF_COMPONENT_TYPE_FLOAT;

  template <class T>
  static T number(const unsigned char* at) {
    T out;
    std::memcpy(&out, at, sizeof out);
    return out;
  }

  const unsigned char* from_ = nullptr;
  std::size_t stride_ = 0, width_ = 0;
  int type_ = 0;
  bool normalised_ = false;
};

/// x -> rows[.][0..2] x + rows[.][3].
struct GltfMotion {
  std::array<std::array<double, 4>, 3> rows = {{{1, 0, 0, 0}, {0, 1, 0, 0}, {0, 0, 1, 0}}};

  GltfMotion() = default;
  explicit GltfMotion(const tinygltf::Node& node) {
    if (node.matrix.size() == 16) {
      for (std::size_t r = 0; r < 3; ++r)
        for (std::size_t c = 0; c < 4; ++c) rows[r][c] = node.matrix[4 * c + r];
      return;
    }
    const auto or_else = [](const std::vector<double>& given, std::size_t i, double other) {
      return i < given.size() ? given[i] : other;
    };
    std::array<double, 4> q{};
    double length = 0;
    for (std::size_t i = 0; i < 4; ++i) {
      q[i] = or_else(node.rotation, i, i == 3 ? 1 : 0);
      length = std::hypot(length, q[i]);
    }
    for (double& part : q) part /= length > 0 ? length : 1;
    const double x = q[0], y = q[1], z = q[2], w = q[3];
    const std::array<std::array<double, 3>, 3> turn = {
        {{1 - 2 * (y * y + z * z), 2 * (x * y - z * w), 2 * (x * z + y * w)},
         {2 * (x * y + z * w), 1 - 2 * (x * x + z * z), 2 * (y * z - x * w)},
         {2 * (x * z - y * w), 2 * (y * z + x * w), 1 - 2 * (x * x + y * y)}}};
    for (std::size_t r = 0; r < 3; ++r) {
      for (std::size_t c = 0; c < 3; ++c) rows[r][c] = turn[r][c] * or_else(node.scale, c, 1);
      rows[r][3] = or_else(node.translation, r, 0);
    }
  }

  std::array<double, 3> point(const std::array<double, 3>& p) const {
    std::array<double, 3> out;
    for (std::size_t r = 0; r < 3; ++r)
      out[r] = rows[r][0] * p[0] + rows[r][1] * p[1] + rows[r][2] * p[2] + rows[r][3];
    return out;
  }
  /// By the cofactors: the inverse, transposed, times the determinant; on the same side of the surface.
  std::array<double, 3> normal(const std::array<double, 3>& n) const {
    std::array<double, 3> out;
    const double side = determinant() < 0 ? -1 : 1;
    for (std::size_t r = 0; r < 3; ++r)
      out[r] = side * (cofactor(r, 0) * n[0] + cofactor(r, 1) * n[1] + cofactor(r, 2) * n[2]);
    return out;
  }
  double determinant() const {
    return rows[0][0] * cofactor(0, 0) + rows[0][1] * cofactor(0, 1) + rows[0][2] * cofactor(0, 2);
  }
  friend GltfMotion operator*(const GltfMotion& a, const GltfMotion& b) {
    GltfMotion out;
    for (std::size_t r = 0; r < 3; ++r)
      for (std::size_t c = 0; c < 4; ++c) {
        out.rows[r][c] = c == 3 ? a.rows[r][3] : 0;
        for (std::size_t k = 0; k < 3; ++k) out.rows[r][c] += a.rows[r][k] * b.rows[k][c];
      }
    return out;
  }

 private:
  double cofactor(std::size_t r, std::size_t c) const {
    const std::size_t r1 = (r + 1) % 3, r2 = (r + 2) % 3, c1 = (c + 1) % 3, c2 = (c + 2) % 3;
    return rows[r1][c1] * rows[r2][c2] - rows[r1][c2] * rows[r2][c1];
  }
};

}  // namespace

}  // namespace nullcone
