#define TINYOBJLOADER_USE_DOUBLE
#include <tiny_obj_loader.h>

#include <algorithm>
#include <charconv>
#include <cmath>
#include <cstring>
#include <istream>
#include <streambuf>

#include "core/base/error.h"
#include "core/scene/load_mesh.h"
#include "core/scene/mesh_file.h"
#include "core/scene/polygon.h"
#include "core/scene/read_placing.h"

namespace nullcone {

namespace {

/// The lines of a file that make triangles, one after another: the loader sees no others, and nothing that it
/// would take for a zero. Knows the number of the line that was read last.
class ObjLines final : public std::streambuf {
 public:
  explicit ObjLines(MeshFile& file) : file_(file), block_(std::size_t{1} << 18) {}

  [[noreturn]] void refuse(std::string_view message) const {
    throw InputError(file_.path() + ": line " + std::to_string(number_), message);
  }

 protected:
  int_type underflow() override {
    while (next_line())
      if (is_wanted()) {
        line_ += '\n';
        setg(line_.data(), line_.data(), line_.data() + line_.size());
        return traits_type::to_int_type(*gptr());
      }
    return traits_type::eof();
  }

 private:
  static constexpr std::size_t kLongest = 65536;

  bool next_line() {
    line_.clear();
    ++number_;
    for (;;) {
      if (at_ == end_) {
        end_ = file_.read(block_.data(), block_.size());
        at_ = 0;
        if (end_ == 0) return !line_.empty();
      }
      const char* const from = block_.data() + at_;
      const auto* const newline = static_cast<const char*>(std::memchr(from, '\n', end_ - at_));
      const std::size_t count = newline ? static_cast<std::size_t>(newline - from) : end_ - at_;
      if (std::memchr(from, '\0', count)) refuse("is not text; expected a Wavefront OBJ file");
      line_.append(from, count);
      at_ += count + (newline != nullptr);
      if (line_.size() > kLongest) refuse("is longer than 65536 characters; expected a Wavefront OBJ file");
      if (!newline) continue;
      if (!line_.empty() && line_.back() == '\r') line_.pop_back();
      if (number_ == 1 && line_.starts_with("\xEF\xBB\xBF")) line_.erase(0, 3);  // UTF-8, says Windows
      return true;
    }
  }

  bool is_wanted() const {
    const std::size_t first = line_.find_first_not_of(" \t");
    if (first == std::string::npos) return false;
    const std::size_t word = line_.find_first_of(" \t", first);
    const std::string_view name = std::string_view(line_).substr(first, word - first);
    if (name == "f") {
      check_face(word);
      return true;
    }
    const std::size_t least = name == "v" || name == "vn" ? 3 : name == "vt" ? 1 : 0;
    if (least == 0) return false;
    if (count_numbers(word) < least)
      refuse("expected " + std::to_string(least) + (least == 1 ? " number" : " numbers") + " after " +
             std::string(name));
    return true;
  }
  /// Numbers of nine digits at most: the loader's own overflow.
  void check_face(std::size_t from) const {
    std::size_t digits = 0;
    for (std::size_t i = from; i < line_.size(); ++i) {
      const char c = line_[i];
      digits = c >= '0' && c <= '9' ? digits + 1 : 0;
      if (digits > 9 || (digits == 0 && std::strchr("-/ \t", c) == nullptr))
        refuse("expected numbers of corners, as in f 1/1/1 2/2/2 3/3/3");
    }
  }
  /// How many numbers there are from a place on, and nothing else: the loader would take it for zeros.
  std::size_t count_numbers(std::size_t from) const {
    std::size_t words = 0;
    const char* const end = line_.data() + line_.size();
    for (const char* at = line_.data() + std::min(from, line_.size()); at != end; ++words) {
      at = std::find_if(at, end, [](char c) { return c != ' ' && c != '\t'; });
      if (at == end) break;
      if (*at == '+' && at + 1 != end && at[1] != '-') ++at;
      double number;
      const auto [rest, error] = std::from_chars(at, end, number);
      if (error != std::errc{} || !std::isfinite(number) || (rest != end && *rest != ' ' && *rest != '\t'))
        refuse("expected finite numbers");
      at = rest;
    }
    return words;
  }

  MeshFile& file_;
  std::vector<char> block_;
  std::size_t at_ = 0, end_ = 0, number_ = 0;
  std::string line_;
};

class ObjReader {
 public:
  ObjReader(const ObjLines& lines, double scale) : lines_(lines), scale_(scale) {}

  void add_position(const std::array<double, 3>& p) {
    for (const double x : p)
      if (!(std::fabs(scale_ * x) <= kLargest)) lines_.refuse("expected finite coordinates, at most 1e15");
    soup_.positions.push_back({scale_ * p[0], scale_ * p[1], scale_ * p[2]});
  }
  void add_normal(const std::array<double, 3>& n) {
    const double length = std::hypot(n[0], n[1], n[2]);
    if (!std::isfinite(length)) lines_.refuse("expected a finite normal");
    std::array<float, 3> out{};
    if (length > 0)
      for (std::size_t i = 0; i < 3; ++i) out[i] = static_cast<float>(n[i] / length);
    normals_.push_back(out);
  }
  void add_uv(double u, double v) {
    if (!(std::fabs(u) <= 1e6 && std::fabs(v) <= 1e6))
      lines_.refuse("expected finite texture coordinates, at most 1e6");
    uv_.push_back({static_cast<float>(u), static_cast<float>(v)});
  }
  void add_face(std::span<const tinyobj::index_t> indices) {
    if (indices.size() < 3) lines_.refuse("expected at least 3 corners in a face");
    if (indices.size() > kMostCorners) lines_.refuse("expected at most 255 corners in a face");
    if (soup_.triangles.size() + indices.size() - 2 > Mesh::kMostTriangles)
      lines_.refuse("is a face too many; expected at most 16777216 triangles");
    corners_.clear();
    places_.clear();
    for (const tinyobj::index_t& i : indices) {
      Corner corner{place(i.vertex_index, soup_.positions.size(), "positions"), -1, -1};
      if (i.texcoord_index != 0) corner.uv = place(i.texcoord_index, uv_.size(), "texture coordinates");
      if (i.normal_index != 0) corner.normal = place(i.normal_index, normals_.size(), "normals");
      corners_.push_back(corner);
      places_.push_back(soup_.positions[static_cast<std::size_t>(corner.position)]);
    }
    cut_(places_, [&](std::size_t a, std::size_t b, std::size_t c) { add_triangle({a, b, c}); });
  }
  TriangleSoup finish() { return std::move(soup_); }

 private:
  static constexpr std::size_t kMostCorners = 255;
  struct Corner {
    std::ptrdiff_t position, uv, normal;
  };

  /// Numbers count from 1, or backwards from the last that was read.
  std::ptrdiff_t place(int number, std::size_t count, const char* of_what) const {
    const auto size = static_cast<std::ptrdiff_t>(count), n = static_cast<std::ptrdiff_t>(number);
    if (n == 0 || n > size || n < -size)
      lines_.refuse("names number " + std::to_string(number) + " of " + std::to_string(count) + " " +
                    of_what + " so far");
    return n > 0 ? n - 1 : size + n;
  }
  /// Normals and texture coordinates are kept from the first triangle on that has them.
  void add_triangle(const std::array<std::size_t, 3>& of) {
    MeshUv uv{};
    MeshNormals normals{};
    std::array<std::uint32_t, 3> triangle;
    bool has_uv = false, has_normals = false;
    for (std::size_t k = 0; k < 3; ++k) {
      const Corner& corner = corners_[of[k]];
      triangle[k] = static_cast<std::uint32_t>(corner.position);
      if (corner.uv >= 0) {
        has_uv = true;
        const auto& from = uv_[static_cast<std::size_t>(corner.uv)];
        uv.corner[k][0] = from[0], uv.corner[k][1] = from[1];
      }
      if (corner.normal >= 0) {
        has_normals = true;
        const auto& from = normals_[static_cast<std::size_t>(corner.normal)];
        for (std::size_t i = 0; i < 3; ++i) normals.corner[k][i] = from[i];
      }
    }
    const std::size_t before = soup_.triangles.size();
    soup_.triangles.push_back(triangle);
    if (has_uv || !soup_.uv.empty()) soup_.uv.resize(before), soup_.uv.push_back(uv);
    if (has_normals || !soup_.normals.empty()) soup_.normals.resize(before), soup_.normals.push_back(normals);
  }

  const ObjLines& lines_;
  double scale_;
  TriangleSoup soup_;
  std::vector<std::array<float, 3>> normals_;
  std::vector<std::array<float, 2>> uv_;
  std::vector<Corner> corners_;
  std::vector<PolygonCutter::Point> places_;
  PolygonCutter cut_;
};

ObjReader& reader(void* user) { return *static_cast<ObjReader*>(user); }

}  // namespace

LoadedMesh load_obj(const std::string& path, double scale) {
  MeshFile file(path);
  ObjLines lines(file);
  ObjReader out(lines, scale);
  std::istream stream(&lines);
  stream.exceptions(std::ios::badbit);  // what refuses a line is not swallowed
  tinyobj::callback_t on;
  on.vertex_cb = [](void* user, double x, double y, double z, double) {
    reader(user).add_position({x, y, z});
  };
  on.normal_cb = [](void* user, double x, double y, double z) { reader(user).add_normal({x, y, z}); };
  on.texcoord_cb = [](void* user, double u, double v, double) { reader(user).add_uv(u, v); };
  on.index_cb = [](void* user, tinyobj::index_t* indices, int count) {
    reader(user).add_face({indices, static_cast<std::size_t>(count)});
  };
  std::string warning, error;
  if (!tinyobj::LoadObjWithCallback(stream, on, &out, nullptr, &warning, &error))
    file.refuse("is not a Wavefront OBJ file: " + printable(error));
  LoadedMesh loaded{out.finish(), {file.sha256(), {}}};
  if (loaded.soup.triangles.empty())
    file.refuse("has no faces; expected a Wavefront OBJ file with triangles");
  return loaded;
}

}  // namespace nullcone
