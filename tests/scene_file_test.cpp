// What stands in scene files for people alone: it changes nothing of what is stored and hashed.
#include <gtest/gtest.h>

#include <fstream>
#include <nlohmann/json.hpp>
#include <sstream>

#include "core/scene/read_scene.h"
#include "metrics/registry.h"

namespace nullcone {
namespace {

TEST(SceneFile, CommentsAndTheSchemaAreNotPartOfTheScene) {
  std::stringstream file;
  file << std::ifstream(NULLCONE_SOURCE "/scenes/goedel_earth.json").rdbuf();
  const auto metrics = metric_descriptions();
  nlohmann::json bare = nlohmann::json::parse(file.str());
  ASSERT_EQ(bare.erase("$schema"), 1U) << "shipped scenes name it";
  const Scene scene = read_scene(bare.dump(), "file", metrics),
              named = read_scene(file.str(), "file", metrics),
              commented = read_scene("// a comment\n" + file.str() + "/* another */", "file", metrics);
  EXPECT_EQ(scene.canonical.find("schema"), std::string::npos);
  for (const Scene& other : {named, commented}) {
    EXPECT_EQ(other.canonical, scene.canonical);
    EXPECT_EQ(other.sha256, scene.sha256);
  }
  EXPECT_EQ(scene.sha256, "200eca395f1db50b1b8d44a7625660433456d5495860c562312970c860c38558")
      << "datasets of earlier versions are those of this scene";
}

}  // namespace
}  // namespace nullcone
