// Scenes with the same meshes read them once.
#include "core/scene/mesh_shelf.h"

#include <atomic>
#include <thread>

#include "tests/gltf_file.h"
#include "tests/mesh_files.h"

namespace nullcone {
namespace {

class MeshOnShelf : public MeshFiles {
 protected:
  std::shared_ptr<const Mesh> get(const json& more = json::object()) {
    json shape = {{"type", "mesh"}, {"file", "t.obj"}};
    shape.update(more);
    return read(shape, shelf_).mesh;
  }
  MeshShelf shelf_;
};

constexpr const char* kWithNormals = "v 0 0 0\nv 1 0 0\nv 0 1 0\nvn 0 0 1\nf 1//1 2//1 3//1\n";

TEST_F(MeshOnShelf, IsReadOnceAsLongAsItIsTheSame) {
  write("t.obj", kWithNormals);
  const auto first = get();
  EXPECT_EQ(get(), first);
  EXPECT_EQ(get({{"normals", "smooth"}}), first);
  const auto flat = get({{"normals", "flat"}}), large = get({{"scale", 2}});
  EXPECT_TRUE(flat->normals.empty() && !first->normals.empty());
  EXPECT_EQ(large->ball, 2 * first->ball);
  EXPECT_EQ(get({{"normals", "flat"}}), flat);

  write("t.obj", std::string(kWithNormals) + "v 0 0 3\nf 1 2 4\n");
  EXPECT_EQ(get()->triangles.size(), 2U);
  std::filesystem::remove(path("t.obj"));
  EXPECT_THROW(get(), InputError);
  write("t.obj", kWithNormals);
  EXPECT_EQ(get()->triangles.size(), 1U);
  EXPECT_NE(get(), first);
}

TEST_F(MeshOnShelf, IsRefusedAsWhatIsReadAnew) {
  write("t.obj", "v 0 0 0\nv 1 0 0\nv 0 1 0\nf 1 2 3\n");
  get();
  EXPECT_THROW(get({{"normals", "smooth"}}), InputError) << "there are none";
  EXPECT_THROW(get({{"normals", "round"}}), InputError);
  EXPECT_THROW(get({{"sha256", std::string(64, '0')}}), InputError);
  write("t.obj", "nonsense of the same kind\n");
  EXPECT_THROW(get(), InputError);
  EXPECT_THROW(get(), InputError);
}

TEST_F(MeshOnShelf, FilesBesideItCount) {
  const Gltf gltf;
  write("t.bin", gltf.binary);
  write("t.gltf", gltf.document.dump());
  const auto first = get({{"file", "t.gltf"}});
  EXPECT_EQ(get({{"file", "t.gltf"}}), first);
  std::filesystem::last_write_time(path("t.bin"),
                                   std::filesystem::file_time_type::clock::now() + std::chrono::seconds(5));
  EXPECT_NE(get({{"file", "t.gltf"}}), first);
}

TEST_F(MeshOnShelf, GoesWhereThereIsNoRoom) {
  write("t.obj", kWithNormals);
  MeshShelf shelf(100);
  int times = 0;
  const auto ask = [&](const std::string& variant, std::size_t triangles) {
    shelf.get(path("t.obj"), variant, [&] {
      ++times;
      Mesh mesh;
      mesh.triangles.resize(triangles);
      return ReadMesh{std::make_shared<const Mesh>(std::move(mesh)), {}, false};
    });
  };
  for (const char* variant : {"a", "b", "a"}) ask(variant, 40);
  EXPECT_EQ(times, 2);
  ask("c", 40);  // b goes, which was asked for the longest ago
  ask("a", 40);
  EXPECT_EQ(times, 3);
  ask("b", 40);
  EXPECT_EQ(times, 4);
  ask("large", 1000);  // all others go
  ask("large", 1000);
  EXPECT_EQ(times, 5);
  ask("a", 40);
  EXPECT_EQ(times, 6);
}

TEST_F(MeshOnShelf, ThreadsWaitForTheOneThatReads) {
  write("t.obj", kWithNormals);
  std::atomic<int> times = 0;
  const auto ask = [&] {
    shelf_.get(path("t.obj"), "", [&] {
      std::this_thread::sleep_for(std::chrono::milliseconds(20));
      ++times;
      return ReadMesh{std::make_shared<const Mesh>(), {}, false};
    });
  };
  { const std::jthread first(ask), second(ask), third(ask); }
  EXPECT_EQ(times, 1);
}

}  // namespace
}  // namespace nullcone
