// Meshes from Wavefront OBJ files: what is in them arrives, and whatever is wrong is refused in one line that
// names the file, before it costs memory or time.
#include <sys/stat.h>

#include <chrono>

#include "tests/mesh_files.h"

namespace nullcone {
namespace {

class ObjFiles : public MeshFiles {};

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

TEST_F(ObjFiles, ObjOfATetrahedron) {
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

TEST_F(ObjFiles, ObjWithAByteOrderMark) {
  const std::string text = "v 0 0 0\nv 1 0 0\nv 0 2 0\nv 0 0 9\nf 1 2 3\n";
  write("t.obj", "\xEF\xBB\xBF" + text);
  EXPECT_NEAR(area_and_volume(*mesh("t.obj"))[0], 1, 1e-14) << "the first corner is one too";
}

TEST_F(ObjFiles, ObjPolygonsTextureAndNormals) {
  // A concave polygon: a fan would cover what is not there.
  write("u.obj",
        "v 0 0 0\nv 2 0 0\nv 2 2 0\nv 1 0.5 0\nv 0 2 0\nvt 0.25 0.5\nvt 1 0\nvn 0 0 7\n"
        "f 1/1/1 2/2/1 3/1/1 4/2/1 5/1/1\r\n");
  const auto polygon = mesh("u.obj");
  EXPECT_EQ(polygon->triangles.size(), 3U);
  EXPECT_FALSE(polygon->closed);
  EXPECT_NEAR(area_and_volume(*polygon)[0], 2.5, 1e-14);
  write("w.obj", "v 0 0 0\nv 2 0 0\nv 2 2 0\nv 1 0.5 0\nv 0 2 0\nf 4 5 1 2 3\n");
  EXPECT_NEAR(area_and_volume(*mesh("w.obj"))[0], 2.5, 1e-14) << "the corner that turns inwards is no ear";
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

TEST_F(ObjFiles, WhatHasNoAreaIsLeftOut) {
  write("d.obj", std::string(kTetrahedron) + "v 0.5 0 0\nf 1 1 2\nf 1 5 2\nv 0 0 0\nf 1 6 3\n");
  const auto read_mesh = mesh("d.obj");
  EXPECT_EQ(read_mesh->triangles.size(), 4U);
  EXPECT_EQ(read_mesh->flattened, 3U);
  expect_refused("flat.obj", "v 0 0 0\nv 1 0 0\nv 2 0 0\nf 1 2 3\nf 1 1 1\n", "no triangle with an area");
}

TEST_F(ObjFiles, ClosedMeansTwoTrianglesAnEdgeInOppositeDirections) {
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

TEST_F(ObjFiles, HostileObj) {
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

TEST_F(ObjFiles, WhatIsNoPlainFileOfAFairSize) {
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

TEST_F(ObjFiles, NamesStayBelowTheScenesFolder) {
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

}  // namespace
}  // namespace nullcone
