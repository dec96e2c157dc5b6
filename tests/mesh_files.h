// A folder with meshes in files, for tests of their readers.
#pragma once

#include <gtest/gtest.h>
#include <unistd.h>

#include <cmath>
#include <filesystem>
#include <fstream>
#include <nlohmann/json.hpp>

#include "core/base/error.h"
#include "core/scene/read_shape.h"
#include "tests/test_folder.h"

namespace nullcone {
namespace {

using nlohmann::json;

/// A folder of its own, with a scene's name in it.
class MeshFiles : public testing::Test {
 protected:
  std::string path(const std::string& name) const { return folder_.file(name); }
  std::string scene() const { return path("scene.json"); }
  void write(const std::string& name, const std::string& text) const { folder_.write(name, text); }
  Shape read(const json& shape, MeshShelf& shelf) const {
    MeshHashes hashes;
    return read_shape(JsonObject(shape, scene(), "/objects/0/shape"), MetricDescription{}, scene(), shelf,
                      hashes);
  }
  Shape read(const json& shape) const {
    MeshShelf shelf;
    return read(shape, shelf);
  }
  std::shared_ptr<const Mesh> mesh(const std::string& file) const {
    return read({{"type", "mesh"}, {"file", file}}).mesh;
  }
  std::string complaint(const json& shape) const {
    try {
      read(shape);
    } catch (const InputError& error) {
      return error.what();
    }
    return {};
  }
  /// What a file is refused with; it must be one line, and name the file.
  std::string complaint_about(const std::string& file) const {
    const std::string out = complaint({{"type", "mesh"}, {"file", file}});
    EXPECT_NE(out.find(file), std::string::npos) << out;
    EXPECT_EQ(out.find('\n'), std::string::npos) << out;
    return out;
  }
  void expect_refused(const std::string& file, const std::string& text, const std::string& part) const {
    write(file, text);
    EXPECT_NE(complaint_about(file).find(part), std::string::npos) << complaint_about(file);
  }

 private:
  test::TestFolder folder_;
};

/// The area of all triangles, and the volume that they enclose; in true lengths.
[[maybe_unused]] std::array<double, 2> area_and_volume(const Mesh& mesh) {
  std::array<double, 2> out{};
  for (const MeshTriangle& t : mesh.triangles) {
    std::array<std::array<double, 3>, 3> p;
    for (std::size_t k = 0; k < 3; ++k)
      for (std::size_t i = 0; i < 3; ++i) p[k][i] = mesh.unit * t.corner[k][i];
    std::array<double, 3> u, v;
    for (std::size_t i = 0; i < 3; ++i) u[i] = p[1][i] - p[0][i], v[i] = p[2][i] - p[0][i];
    const std::array<double, 3> n = {u[1] * v[2] - u[2] * v[1], u[2] * v[0] - u[0] * v[2],
                                     u[0] * v[1] - u[1] * v[0]};
    out[0] += 0.5 * std::hypot(n[0], n[1], n[2]);
    out[1] += (n[0] * p[0][0] + n[1] * p[0][1] + n[2] * p[0][2]) / 6;
  }
  return out;
}

}  // namespace
}  // namespace nullcone
