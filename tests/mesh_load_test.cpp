// Meshes from files: what is in them arrives, and whatever is wrong is refused in one line that names the
// file, before it costs memory or time.
#include <gtest/gtest.h>
#include <sys/resource.h>
#include <sys/stat.h>
#include <unistd.h>

#include <chrono>
#include <cmath>
#include <cstring>
#include <filesystem>
#include <fstream>
#include <nlohmann/json.hpp>

#include "core/base/error.h"
#include "core/scene/load_mesh.h"
#include "core/scene/read_mesh.h"
#include "core/scene/read_shape.h"

namespace nullcone {
namespace {

using nlohmann::json;

/// A folder of its own, with a scene's name in it.
class MeshFiles : public testing::Test {
 protected:
  MeshFiles() {
    std::string name = (std::filesystem::temp_directory_path() / "nullcone_mesh_XXXXXX").string();
    folder_ = mkdtemp(name.data());
  }
  ~MeshFiles() override { std::filesystem::remove_all(folder_); }

  std::string path(const std::string& name) const { return folder_ + "/" + name; }
  std::string scene() const { return path("scene.json"); }
  void write(const std::string& name, const std::string& text) const {
    std::ofstream(path(name), std::ios::binary) << text;
  }
  Shape read(const json& shape) const {
    return read_shape(JsonObject(shape, scene(), "/objects/0/shape"), MetricDescription{}, scene());
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
  std::string folder_;
};

constexpr const char* kTetrahedron = R"(# a comment
mtllib nothing.mtl
o thing
v 0 0 0
v 1 0 0
v 0 1e0 0
v +0. 0 1 1
usemtl stone
f 1 3 2
f 1 2 4
f -3 -2 -1
f 1 4 3
)";

/// The area of all triangles, and the volume that they enclose; in true lengths.
std::array<double, 2> area_and_volume(const Mesh& mesh) {
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

TEST_F(MeshFiles, ObjOfATetrahedron) {
  write("t.obj", kTetrahedron);
  const auto read_mesh = mesh("t.obj");
  EXPECT_EQ(read_mesh->triangles.size(), 4U);
  EXPECT_TRUE(read_mesh->closed);
  EXPECT_TRUE(read_mesh->uv.empty());
  EXPECT_TRUE(read_mesh->normals.empty());
  EXPECT_NEAR(read_mesh->ball, 1, 1e-14);
  const auto [area, volume] = area_and_volume(*read_mesh);
  EXPECT_NEAR(area, 1.5 + std::sqrt(3) / 2, 1e-14);
  EXPECT_NEAR(volume, 1.0 / 6, 1e-14);
  const auto larger = read({{"type", "mesh"}, {"file", "t.obj"}, {"scale", 1e-9}}).mesh;
  EXPECT_NEAR(area_and_volume(*larger)[1], 1e-27 / 6, 1e-40);
  EXPECT_TRUE(read({{"type", "mesh"}, {"file", "t.obj"}, {"dome", true}}).dome);
}

TEST_F(MeshFiles, ObjPolygonsTextureAndNormals) {
  // A concave polygon: a fan would cover what is not there.
  write("u.obj",
        "v 0 0 0\nv 2 0 0\nv 2 2 0\nv 1 0.5 0\nv 0 2 0\nvt 0.25 0.5\nvt 1 0\nvn 0 0 7\n"
        "f 1/1/1 2/2/1 3/1/1 4/2/1 5/1/1\r\n");
  const auto polygon = mesh("u.obj");
  EXPECT_EQ(polygon->triangles.size(), 3U);
  EXPECT_FALSE(polygon->closed);
  EXPECT_NEAR(area_and_volume(*polygon)[0], 2.5, 1e-14);
  ASSERT_EQ(polygon->uv.size(), 3U);
  ASSERT_EQ(polygon->normals.size(), 3U);
  EXPECT_EQ(polygon->normals[1].corner[2][2], 1);
  for (std::size_t n = 0; n < 3; ++n)
    for (std::size_t k = 0; k < 3; ++k) {
      const double x = polygon->unit * polygon->triangles[n].corner[k][0];
      const bool second = std::fabs(x - 1) < 0.1 || (x > 1.9 && polygon->triangles[n].corner[k][1] == 0);
      EXPECT_EQ(polygon->uv[n].corner[k][0], second ? 1.0F : 0.25F);
    }
  EXPECT_TRUE(read({{"type", "mesh"}, {"file", "u.obj"}, {"normals", "flat"}}).mesh->normals.empty());
}

TEST_F(MeshFiles, WhatHasNoAreaIsLeftOut) {
  write("d.obj", std::string(kTetrahedron) + "v 0.5 0 0\nf 1 1 2\nf 1 5 2\nv 0 0 0\nf 1 6 3\n");
  const auto read_mesh = mesh("d.obj");
  EXPECT_EQ(read_mesh->triangles.size(), 4U);
  EXPECT_EQ(read_mesh->flattened, 3U);
  expect_refused("flat.obj", "v 0 0 0\nv 1 0 0\nv 2 0 0\nf 1 2 3\nf 1 1 1\n", "no triangle with an area");
}

TEST_F(MeshFiles, ClosedMeansTwoTrianglesAnEdgeInOppositeDirections) {
  const auto without = [](const std::string& line, const std::string& other) {
    std::string text = kTetrahedron;
    return text.replace(text.find(line), line.size(), other);
  };
  write("open.obj", without("f 1 4 3\n", ""));
  write("turned.obj", without("f 1 4 3\n", "f 1 3 4\n"));
  write("twice.obj", std::string(kTetrahedron) + "f 1 4 3\nf 1 3 4\n");
  // Every triangle with positions of its own: equal ones are merged.
  std::string apart;
  const std::array<const char*, 4> p = {"v 0 0 0\n", "v 1 0 0\n", "v 0 1 0\n", "v -0 0 1\n"};
  for (const auto& t : {std::array{0, 2, 1}, {0, 1, 3}, {1, 2, 3}, {0, 3, 2}}) {
    for (const int k : t) apart += p[static_cast<std::size_t>(k)];
    apart += "f -3 -2 -1\n";
  }
  write("apart.obj", apart);
  EXPECT_FALSE(mesh("open.obj")->closed);
  EXPECT_FALSE(mesh("turned.obj")->closed);
  EXPECT_FALSE(mesh("twice.obj")->closed);
  EXPECT_TRUE(mesh("apart.obj")->closed);
  EXPECT_NE(
      complaint({{"type", "mesh"}, {"file", "open.obj"}, {"dome", true}}).find("dome: expected a closed"),
      std::string::npos);
}

TEST_F(MeshFiles, HostileObj) {
  const std::string v = "v 0 0 0\nv 1 0 0\nv 0 1 0\n";
  expect_refused("a.obj", v, "no faces");
  expect_refused("b.obj", "\n\n# nothing\n", "no faces");
  expect_refused("c.obj", v + "v nan 0 0\nf 1 2 3\n", "line 4: expected finite numbers");
  expect_refused("c.obj", v + "v 1 inf 0\nf 1 2 3\n", "line 4: expected finite numbers");
  expect_refused("c.obj", v + "v 1e999 0 0\nf 1 2 3\n", "line 4: expected finite numbers");
  expect_refused("c.obj", v + "v 1 2 e\nf 1 2 3\n", "line 4: expected finite numbers");
  expect_refused("c.obj", v + "v 1 2.5.1 3\nf 1 2 3\n", "line 4: expected finite numbers");
  expect_refused("c.obj", v + "v 1 2\nf 1 2 3\n", "line 4: expected 3 numbers after v");
  expect_refused("c.obj", v + "v\nf 1 2 3\n", "line 4: expected 3 numbers after v");
  expect_refused("c.obj", v + "v 1e16 0 0\nf 1 2 3\n", "line 4: expected finite coordinates, at most 1e15");
  expect_refused("c.obj", v + "vt 1e30 0\nf 1 2 3\n", "line 4: expected finite texture coordinates");
  expect_refused("d.obj", v + "f 1 2 4\n", "line 4: names number 4 of 3 positions so far");
  expect_refused("d.obj", v + "f 1 2 0\n", "line 4: names number 0 of 3");
  expect_refused("d.obj", v + "f 1 2 -4\n", "line 4: names number -4 of 3");
  expect_refused("d.obj", v + "f 1 2 99999999999999999999\n", "line 4: expected numbers of corners");
  expect_refused("d.obj", v + "f 1/1 2/1 3/1\n", "line 4: names number 1 of 0 texture coordinates");
  expect_refused("d.obj", v + "f 1//1 2//1 3//1\n", "line 4: names number 1 of 0 normals");
  expect_refused("d.obj", v + "f 1 2\n", "line 4: expected at least 3 corners");
  expect_refused("d.obj", v + "f 1 2 three\n", "line 4: expected numbers of corners");
  expect_refused("d.obj", v + "f 1 2 3 \\\n1\n", "line 4: expected numbers of corners");
  std::string many = v + "f";
  for (int i = 0; i < 256; ++i) many += " 1";
  expect_refused("e.obj", many + "\n", "line 4: expected at most 255 corners");
  expect_refused("e.obj", v + "#" + std::string(70000, 'x') + "\nf 1 2 3\n", "line 4: is longer than");
  expect_refused("zip.obj", std::string("PK\3\4\0\0\0\0", 8) + std::string(100, '\1'), "line 1: is not text");
  expect_refused("words.obj", "It was a dark and stormy night.\n", "no faces");
}

TEST_F(MeshFiles, WhatIsNoPlainFileOfAFairSize) {
  expect_refused("empty.obj", "", "is empty");
  std::filesystem::create_directory(path("folder.obj"));
  EXPECT_NE(complaint_about("folder.obj").find("is a folder"), std::string::npos);
  ASSERT_EQ(mkfifo(path("pipe.glb").c_str(), 0600), 0);
  EXPECT_NE(complaint_about("pipe.glb").find("is not a plain file"), std::string::npos);
  EXPECT_NE(complaint_about("absent.gltf").find("cannot open the file"), std::string::npos);
  for (const char* name : {"huge.obj", "huge.glb"}) {
    write(name, "PK\3\4");
    std::filesystem::resize_file(path(name), std::uintmax_t{2} << 30);
    EXPECT_NE(complaint_about(name).find("is larger than 1 GiB"), std::string::npos);
  }
  // As large as may be, of one byte: refused after a line's worth.
  write("zeros.obj", "v 0 0 0\n");
  std::filesystem::resize_file(path("zeros.obj"), std::uintmax_t{1} << 30);
  const auto start = std::chrono::steady_clock::now();
  EXPECT_NE(complaint_about("zeros.obj").find("line 2: is not text"), std::string::npos);
  EXPECT_LT(std::chrono::steady_clock::now() - start, std::chrono::seconds(1));
}

TEST_F(MeshFiles, NamesStayBelowTheScenesFolder) {
  write("t.obj", kTetrahedron);
  std::filesystem::create_directory(path("sub"));
  write("sub/T.OBJ", kTetrahedron);
  EXPECT_EQ(mesh("sub/T.OBJ")->triangles.size(), 4U);
  for (const std::string& name :
       {path("t.obj"), std::string("../t.obj"), std::string("sub/../t.obj"), std::string(""),
        std::string("sub/../../t.obj"), std::string("/etc/passwd")})
    EXPECT_NE(complaint({{"type", "mesh"}, {"file", name}}).find("/objects/0/shape/file: expected a file in"),
              std::string::npos)
        << name;
  EXPECT_NE(complaint({{"type", "mesh"}, {"file", "t.stl"}}).find("expected a name that ends in .obj"),
            std::string::npos);
  for (const json& wrong : {json{{"scale", 0}}, json{{"scale", -1}}, json{{"normals", "smooth"}},
                            json{{"normals", "round"}}, json{{"radius", 1}}, json{{"file", 3}}}) {
    json shape = {{"type", "mesh"}, {"file", "t.obj"}};
    shape.update(wrong);
    EXPECT_EQ(complaint(shape).rfind(scene() + ": /objects/0/shape/" + wrong.begin().key(), 0), 0U)
        << complaint(shape);
  }
  EXPECT_EQ(complaint({{"type", "mesh"}, {"file", "t.obj"}, {"scale", 1e15}}), "");
  write("far.obj", "v 1e10 0 0\nv 1 0 0\nv 0 1 0\nf 1 2 3\n");
  EXPECT_NE(
      complaint({{"type", "mesh"}, {"file", "far.obj"}, {"scale", 1e10}}).find("line 1: expected finite"),
      std::string::npos);
}

/// A glTF of a tetrahedron, with its buffer beside it or in it.
struct Gltf {
  json document;
  std::string binary;

  Gltf() {
    const std::array<float, 12> positions = {0, 0, 0, 1, 0, 0, 0, 1, 0, 0, 0, 1};
    const std::array<std::uint16_t, 12> indices = {0, 2, 1, 0, 1, 3, 1, 2, 3, 0, 3, 2};
    const std::array<float, 8> uv = {0, 0, 1, 0, 0, 1, 0.5F, 0.25F};
    const auto add = [&](const auto& numbers) {
      binary.append(reinterpret_cast<const char*>(numbers.data()), sizeof numbers);
    };
    add(positions), add(indices), add(uv);
    document = {
        {"asset", {{"version", "2.0"}}},
        {"scene", 0},
        {"scenes", {{{"nodes", {0}}}}},
        {"nodes", {{{"mesh", 0}}}},
        {"meshes",
         {{{"primitives", {{{"attributes", {{"POSITION", 0}, {"TEXCOORD_0", 2}}}, {"indices", 1}}}}}}},
        {"buffers", {{{"byteLength", binary.size()}, {"uri", "t.bin"}}}},
        {"bufferViews", json::array({{{"buffer", 0}, {"byteOffset", 0}, {"byteLength", 48}},
                                     {{"buffer", 0}, {"byteOffset", 48}, {"byteLength", 24}},
                                     {{"buffer", 0}, {"byteOffset", 72}, {"byteLength", 32}}})},
        {"accessors",
         json::array({{{"bufferView", 0}, {"componentType", 5126}, {"count", 4}, {"type", "VEC3"}},
                      {{"bufferView", 1}, {"componentType", 5123}, {"count", 12}, {"type", "SCALAR"}},
                      {{"bufferView", 2}, {"componentType", 5126}, {"count", 4}, {"type", "VEC2"}}})}};
  }
  /// With its buffer inside.
  std::string glb(std::size_t cut = 0) const {
    json inner = document;
    inner["buffers"][0].erase("uri");
    std::string text = inner.dump(), out = "glTF";
    text.resize((text.size() + 3) / 4 * 4, ' ');
    const auto add = [&](std::size_t number) {
      const auto word = static_cast<std::uint32_t>(number);
      out.append(reinterpret_cast<const char*>(&word), 4);
    };
    add(2), add(28 + text.size() + binary.size()), add(text.size()), add(0x4E4F534A);
    out += text;
    add(binary.size()), add(0x004E4942);
    out += binary;
    out.resize(out.size() - cut);
    return out;
  }
};

TEST_F(MeshFiles, GltfInBothForms) {
  Gltf gltf;
  // x -> 2 x turned by 90 degrees about z and moved, below a node that mirrors z.
  gltf.document["nodes"] =
      json::array({{{"children", {1}}, {"matrix", {1, 0, 0, 0, 0, 1, 0, 0, 0, 0, -1, 0, 0, 0, 0, 1}}},
                   {{"mesh", 0},
                    {"scale", {2, 2, 2}},
                    {"rotation", {0, 0, std::sqrt(0.5), std::sqrt(0.5)}},
                    {"translation", {10, 0, 5}}}});
  gltf.document["images"] = {{{"uri", "/etc/passwd"}}};
  gltf.document["materials"] = {{{"name", "stone"}}};
  write("t.bin", gltf.binary);
  write("t.gltf", gltf.document.dump());
  write("t.glb", gltf.glb());
  for (const char* name : {"t.gltf", "t.glb"}) {
    const auto read_mesh = mesh(name);
    EXPECT_EQ(read_mesh->triangles.size(), 4U);
    EXPECT_TRUE(read_mesh->closed);
    EXPECT_NEAR(area_and_volume(*read_mesh)[1], 8.0 / 6, 1e-12) << "mirrored: triangles are turned back";
    EXPECT_NEAR(read_mesh->ball, std::hypot(10, 7), 1e-12);
    ASSERT_EQ(read_mesh->uv.size(), 4U);
    for (std::size_t n = 0; n < 4; ++n)
      for (std::size_t k = 0; k < 3; ++k) {
        const double* const p = read_mesh->triangles[n].corner[k];
        const float v = read_mesh->uv[n].corner[k][1];
        if (std::fabs(read_mesh->unit * p[0] - 8) < 1e-9) {
          EXPECT_EQ(v, 0);  // the third corner, (0, 1) in the file
        }
        if (std::fabs(read_mesh->unit * p[2] + 7) < 1e-9) {
          EXPECT_EQ(v, 0.75F);
        }
      }
  }
}

TEST_F(MeshFiles, GltfWithItsBufferAsADataUri) {
  Gltf gltf;
  const char* const digits = "ABCDEFGHIJKLMNOPQRSTUVWXYZabcdefghijklmnopqrstuvwxyz0123456789+/";
  std::string uri = "data:application/octet-stream;base64,";
  gltf.binary.resize(105);
  for (std::size_t i = 0; i < gltf.binary.size(); i += 3) {
    unsigned word = 0;
    for (std::size_t k = 0; k < 3; ++k) word = word << 8 | static_cast<unsigned char>(gltf.binary[i + k]);
    for (const int shift : {18, 12, 6, 0}) uri += digits[word >> shift & 63];
  }
  gltf.document["buffers"][0] = {{"byteLength", 105}, {"uri", uri}};
  write("t.gltf", gltf.document.dump());
  EXPECT_NEAR(area_and_volume(*mesh("t.gltf"))[1], 1.0 / 6, 1e-14);
}

TEST_F(MeshFiles, HostileGltf) {
  const Gltf whole;
  write("t.bin", whole.binary);
  using Pointer = json::json_pointer;
  const auto refused = [&](const std::string& pointer, const json& value, const std::string& part) {
    SCOPED_TRACE(pointer + " = " + value.dump().substr(0, 100));
    Gltf gltf;
    gltf.document[Pointer(pointer)] = value;
    expect_refused("x.gltf", gltf.document.dump(), part);
  };
  expect_refused("x.gltf", "", "is empty");
  expect_refused("x.gltf", "{", "x.gltf");
  expect_refused("x.gltf", "[]", "expected an object");
  expect_refused("x.gltf", "{}", "is not a glTF 2.0 file");
  expect_refused("x.gltf", std::string("PK\3\4\0\0", 6), "x.gltf");
  expect_refused("x.gltf", "{\"a\":" + std::string(100000, '['), "x.gltf");
  refused("/scenes", json::array(), "has no scene");
  refused("/scene", 3, "has no scene number 3");
  refused("/scenes/0/nodes", {7}, "has no node number 7");
  refused("/nodes/0/mesh", 7, "has no mesh number 7");
  refused("/nodes/0/children", {0}, "reaches the node number 0 twice");
  refused("/nodes", json::array({{{"children", {1}}}, {{"children", {2}}}, {{"children", {1}}}}), "twice");
  refused("/nodes/0/scale", {1e300, 1e300, 1e300}, "beyond 1e15");
  refused("/nodes/0/mesh", -1, "no triangles");
  refused("/meshes/0/primitives/0/mode", 1, "no triangles");
  refused("/meshes/0/primitives/0/mode", 9, "mode 9");
  refused("/meshes/0/primitives/0/attributes/POSITION", 9, "has no accessor number 9");
  refused("/meshes/0/primitives/0/indices", 9, "x.gltf");
  refused("/accessors/0/bufferView", 9, "has no buffer view number 9");
  refused("/accessors/0/count", 5, "reaches beyond its buffer");
  refused("/accessors/0/count", 1000000000000000000, "reaches beyond its buffer");
  refused("/accessors/0/count", 18446744073709551615U, "reaches beyond its buffer");
  refused("/accessors/0/byteOffset", 18446744073709551612U, "reaches beyond its buffer");
  refused("/accessors/0/componentType", 5130, "unexpected type");
  refused("/accessors/0/type", "VEC2", "unexpected type");
  refused("/accessors/1/componentType", 5126, "unexpected type");
  refused("/accessors/0/sparse",
          {{"count", 1},
           {"indices", {{"bufferView", 1}, {"componentType", 5123}}},
           {"values", {{"bufferView", 0}}}},
          "sparse");
  refused("/bufferViews/0/buffer", 3, "x.gltf");
  refused("/bufferViews/0/byteOffset", 100, "reaches beyond its buffer");
  refused("/bufferViews/0/byteLength", 1000000000000, "reaches beyond its buffer");
  refused("/bufferViews/0/byteStride", 4, "reaches beyond its buffer");
  refused("/bufferViews/1/byteOffset", 72, "names corner 16256 of 4");
  refused("/buffers/0/byteLength", 1e15, "more than 1 GiB of buffers");
  refused("/buffers/0/byteLength", 1000, "x.gltf");
  refused("/buffers/0/uri", "../t.bin", "x.gltf");
  refused("/buffers/0/uri", "%2e%2e/t.bin", "x.gltf");
  refused("/buffers/0/uri", "/etc/passwd", "x.gltf");
  refused("/buffers/0/uri", "data:application/octet-stream;base64,!!!!", "x.gltf");
  refused("/extensionsRequired", {"KHR_draco_mesh_compression"}, "needs the extension 'KHR_draco_mesh");
  Gltf alone;
  alone.document["buffers"][0]["uri"] = "absent.bin";
  write("x.gltf", alone.document.dump());
  EXPECT_NE(complaint({{"type", "mesh"}, {"file", "x.gltf"}}).find("/absent.bin: cannot open the file"),
            std::string::npos);
  Gltf broken;
  const float nan = std::nanf("");
  std::memcpy(broken.binary.data() + 12, &nan, 4);
  expect_refused("x.glb", broken.glb(), "not finite");
  for (std::size_t cut = 1; cut < whole.glb().size(); cut += 7) {
    write("cut.glb", whole.glb(cut));
    EXPECT_NE(complaint_about("cut.glb"), "") << cut;
  }
  // Any byte of the file wrong: refused, or read as something.
  const std::string bytes = whole.glb();
  for (std::size_t i = 0; i < bytes.size(); ++i) {
    std::string other = bytes;
    other[i] = static_cast<char>(other[i] ^ (1 << (i % 7)));
    write("wrong.glb", other);
    complaint({{"type", "mesh"}, {"file", "wrong.glb"}});
  }
}

TEST_F(MeshFiles, GltfOfManyCopiesEndsInTime) {
  Gltf gltf;
  json nodes = json::array(), list = json::array(), primitives = json::array();
  for (int i = 0; i < 20000; ++i) nodes.push_back({{"mesh", 0}}), list.push_back(i);
  for (int i = 0; i < 2000; ++i) primitives.push_back(gltf.document["meshes"][0]["primitives"][0]);
  gltf.document["nodes"] = nodes;
  gltf.document["scenes"][0]["nodes"] = list;
  gltf.document["meshes"][0]["primitives"] = primitives;
  for (json& primitive : gltf.document["meshes"][0]["primitives"]) primitive["mode"] = 0;
  write("t.bin", gltf.binary);
  expect_refused("many.gltf", gltf.document.dump(), "more than 1000000 primitives");
}

}  // namespace
}  // namespace nullcone
