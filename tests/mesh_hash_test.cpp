// Scenes know which files their meshes were read from.
#include "core/base/json.h"
#include "core/base/sha256.h"
#include "core/scene/read_scene.h"
#include "tests/gltf_file.h"
#include "tests/mesh_files.h"

namespace nullcone {
namespace {

constexpr const char* kTriangle = "v 0 0 0\nv 1 0 0\nv 0 1 0\nf 1 2 3\n";
/// As sha256sum prints it.
constexpr const char* kHash = "697b00ab13410c52a542d2e9c63711fcc04e9cbf6c0d3439a9b43cc812e6e713";

class MeshHash : public MeshFiles {
 protected:
  static json scene_of(const json& shape) {
    json scene = json::parse(R"({"metric": {"name": "flat"}, "observer": {"event": [0, 0, 0, 0]},
      "camera": {"type": "perspective", "fov_deg": 40, "resolution": [33, 17]},
      "objects": [{"name": "ball", "shape": {"type": "sphere", "radius": 1}, "placing":
        {"type": "coordinate", "centre": [9, 0, 0]}}]})");
    scene["objects"].push_back(scene["objects"][0]);
    scene["objects"][1]["name"] = "rock";
    scene["objects"][1]["shape"] = shape;
    return scene;
  }
  Scene read_whole(const json& document) const {
    MetricDescription flat;
    flat.name = "flat", flat.closed_paths = true;
    return read_scene(canonical_json(document), scene(), {&flat, 1});
  }
  Scene scene_with(const json& shape) const { return read_whole(scene_of(shape)); }
  Scene scene_with_file(const std::string& name) const {
    return scene_with({{"type", "mesh"}, {"file", name}});
  }
  static json shape_in(const Scene& read) { return json::parse(read.canonical)["objects"][1]["shape"]; }
  std::string refusal(const json& document) const {
    try {
      read_whole(document);
    } catch (const InputError& error) {
      return error.what();
    }
    return {};
  }
  void expect_refused_shape(const json& shape, const std::string& key, const std::string& part) const {
    const std::string found = refusal(scene_of(shape));
    EXPECT_TRUE(found.starts_with(scene() + ": /objects/1/shape/" + key + ": ")) << found;
    EXPECT_NE(found.find(part), std::string::npos) << found;
  }
};

TEST_F(MeshHash, TheSceneHasTheHashOfTheBytes) {
  write("t.obj", kTriangle);
  const Scene read = scene_with_file("t.obj");
  EXPECT_EQ(shape_in(read), (json{{"type", "mesh"}, {"file", "t.obj"}, {"sha256", kHash}}));
  EXPECT_FALSE(json::parse(read.canonical)["objects"][0]["shape"].contains("sha256"));
  const Scene again = read_whole(json::parse(read.canonical));
  EXPECT_EQ(again.canonical, read.canonical);
  EXPECT_EQ(again.sha256, read.sha256);
  EXPECT_EQ(scene_with({{"type", "mesh"}, {"file", "t.obj"}, {"sha256", kHash}}).sha256, read.sha256);
  // Many blocks, and a last line without an end; every byte counts, also of what is passed over.
  std::string large;
  while (large.size() < 1'000'000) large += "# " + std::to_string(large.size()) + "\r\n";
  large += std::string(kTriangle) + "# end";
  write("t.obj", large);
  EXPECT_EQ(shape_in(scene_with_file("t.obj"))["sha256"], sha256(large));
}

TEST_F(MeshHash, AnotherFileIsAnotherScene) {
  write("t.obj", kTriangle);
  const Scene before = scene_with_file("t.obj");
  write("t.obj", std::string(kTriangle) + "#");
  EXPECT_NE(scene_with_file("t.obj").sha256, before.sha256);
  const std::string found = refusal(json::parse(before.canonical));
  EXPECT_EQ(found, scene() + ": /objects/1/shape/sha256: the file 't.obj' is another: expected SHA-256 " +
                       kHash + ", found " + sha256(std::string(kTriangle) + "#"));
  write("t.obj", kTriangle);
  EXPECT_EQ(refusal(json::parse(before.canonical)), "");
}

TEST_F(MeshHash, WhatIsNoHashIsRefused) {
  write("t.obj", kTriangle);
  const std::string good = kHash;
  std::string upper = good;
  std::ranges::transform(upper, upper.begin(), [](char c) { return c >= 'a' ? char(c - 32) : c; });
  for (const json& wrong : {json(""), json(good + "0"), json(good.substr(1)), json(upper), json(good + "\n"),
                            json(1), json(nullptr)})
    expect_refused_shape({{"type", "mesh"}, {"file", "t.obj"}, {"sha256", wrong}}, "sha256", "expected ");
  const json sphere = {{"type", "sphere"}, {"radius", 1}, {"sha256", good}};
  expect_refused_shape(sphere, "sha256", "unknown key");
  const json with_buffer = {
      {"type", "mesh"}, {"file", "t.obj"}, {"buffers", {{{"file", "t.bin"}, {"sha256", good}}}}};
  expect_refused_shape(with_buffer, "buffers/0/file", "the mesh has no buffer 't.bin'");
  const json no_buffers = {{"type", "mesh"}, {"file", "t.obj"}, {"buffers", json::array()}};
  EXPECT_FALSE(shape_in(scene_with(no_buffers)).contains("buffers"));
}

TEST_F(MeshHash, BuffersBesideAGltfCountToo) {
  Gltf gltf;
  std::filesystem::create_directory(path("sub"));
  write("sub/t.bin", gltf.binary);
  write("sub/t.gltf", gltf.document.dump());
  const Scene before = scene_with_file("sub/t.gltf");
  const json buffers = {{{"file", "t.bin"}, {"sha256", sha256(gltf.binary)}}};
  EXPECT_EQ(shape_in(before)["sha256"], sha256(gltf.document.dump()));
  EXPECT_EQ(shape_in(before)["buffers"], buffers);
  EXPECT_EQ(read_whole(json::parse(before.canonical)).sha256, before.sha256);
  json half = scene_of({{"type", "mesh"}, {"file", "sub/t.gltf"}, {"sha256", shape_in(before)["sha256"]}});
  EXPECT_EQ(read_whole(half).sha256, before.sha256) << "what is not said is filled in";

  std::string other = gltf.binary;
  other.back() = static_cast<char>(other.back() ^ 1);
  write("sub/t.bin", other);
  EXPECT_NE(scene_with_file("sub/t.gltf").sha256, before.sha256);
  EXPECT_EQ(refusal(json::parse(before.canonical)),
            scene() + ": /objects/1/shape/buffers/0/sha256: the file 't.bin' is another: expected SHA-256 " +
                sha256(gltf.binary) + ", found " + sha256(other));
  json strange = json::parse(before.canonical);
  strange["objects"][1]["shape"]["buffers"][0]["x"] = 1;
  write("sub/t.bin", gltf.binary);
  EXPECT_NE(refusal(strange).find("/objects/1/shape/buffers/0/x: unknown key"), std::string::npos);
}

TEST_F(MeshHash, BuffersInsideAreTheFilesOwn) {
  const Gltf gltf;
  write("t.glb", gltf.glb());
  EXPECT_EQ(shape_in(scene_with_file("t.glb")),
            (json{{"type", "mesh"}, {"file", "t.glb"}, {"sha256", sha256(gltf.glb())}}));
  Gltf twice;  // the same file for two buffers is one
  twice.document["buffers"].push_back(twice.document["buffers"][0]);
  write("t.bin", gltf.binary);
  write("t.gltf", twice.document.dump());
  EXPECT_EQ(shape_in(scene_with_file("t.gltf"))["buffers"].size(), 1U);
}

}  // namespace
}  // namespace nullcone
