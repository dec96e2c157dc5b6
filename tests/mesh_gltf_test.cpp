// Meshes from glTF files, and glTF files that mean no good.
#include <cstring>

#include "tests/gltf_file.h"
#include "tests/mesh_files.h"

namespace nullcone {
namespace {

class GltfFiles : public MeshFiles {};

TEST_F(GltfFiles, GltfInBothForms) {
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

TEST_F(GltfFiles, GltfWithItsBufferAsADataUri) {
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

TEST_F(GltfFiles, HostileGltf) {
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
  expect_refused("x.gltf", std::string("PK\3\4\0\0", 6), "is not text, and does not begin with glTF");
  expect_refused("x.glb", std::string("PK\3\4\0\0", 6), "is not text, and does not begin with glTF");
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
  refused("/buffers/0/byteLength", 1000, "mismatch : t.bin, ");
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

TEST_F(GltfFiles, GltfOfManyCopiesEndsInTime) {
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
