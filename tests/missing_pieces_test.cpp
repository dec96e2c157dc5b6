// Which datasets of a sequence are finished, and which pieces are missing.
#include <nlohmann/json.hpp>

#include "apps/stop_signals.h"
#include "apps/trace_frames.h"
#include "core/trace/trace_scene.h"
#include "metrics/registry.h"
#include "tests/dataset_fixture.h"

namespace nullcone::test {
namespace {

using Pieces = std::vector<std::int64_t>;

/// Four frames of three bands each, of which a shard is one.
class MissingPieces : public DatasetFile {
 protected:
  void SetUp() override {
    DatasetFile::SetUp();
    auto scene = nlohmann::json::parse(std::ifstream(NULLCONE_SOURCE "/scenes/goedel_sequence.json"));
    scene["camera"]["resolution"] = {33, 48};
    scene["frames"]["count"] = 4;
    scene.erase("look");
    std::ofstream(file_) << scene;
  }
  void TearDown() override {
    stop_wanted = false;
    DatasetFile::TearDown();
  }

  TraceFrames frames(const std::string& list = {}) const { return {file_, folder / "a.##.exr", list}; }
  void trace(int frame, const std::optional<Shard>& shard = {}) const {
    const TraceFrames all = frames();
    Scene scene = all.scene(frame);
    const Spacetime& spacetime = find_spacetime(scene.metric);
    const auto tracer = prepare_scene(spacetime, scene, "scene");
    Manifest manifest = describe(spacetime, scene, *tracer);
    if (shard) manifest.first_line = 16 * (shard->number - 1), manifest.lines = manifest.traced_lines = 16;
    const std::string whole = all.whole_file(frame);
    DatasetWriter writer(shard ? shard_path(whole, *shard) : whole, manifest);
    writer.finish(trace_into(writer, *tracer, scene, 1, {}).effort);
  }
  /// The file's last bytes are numbers of the last rays.
  static void damage(const std::string& name) {
    std::fstream file(name, std::ios::in | std::ios::out | std::ios::binary);
    file.seekp(-2, std::ios::end);
    file.put('\x55');
  }

 private:
  std::string file_ = folder / "scene.json";
};

TEST_F(MissingPieces, FramesAreThoseOfTheListOrAll) {
  EXPECT_EQ(frames().numbers(), (std::vector<int>{0, 1, 2, 3}));
  EXPECT_EQ(frames("3,1").numbers(), (std::vector<int>{3, 1}));
  EXPECT_EQ(frames("3").count(), 4);
  EXPECT_THROW(frames("4"), InputError);
}

TEST_F(MissingPieces, WholeFramesAndShardsForAnyNumberOfThreads) {
  trace(1);
  for (const int number : {1, 3}) trace(2, Shard{number, 3});
  for (const int threads : {0, 1, 2, 5}) {
    EXPECT_EQ(missing_pieces(frames(), 0, threads), (Pieces{0, 2, 3}));
    EXPECT_EQ(missing_pieces(frames("3,2,1"), 0, threads), (Pieces{2, 3}));
    EXPECT_EQ(missing_pieces(frames(), 3, threads), (Pieces{0, 1, 2, 7, 9, 10, 11}));
    EXPECT_EQ(missing_pieces(frames(), 1, threads), (Pieces{0, 2, 3}));
    EXPECT_THROW(missing_pieces(frames(), 4, threads), InputError);  // more shards than bands
  }
}

TEST_F(MissingPieces, TheHeaderAloneDoesNotShowDamage) {
  trace(0), trace(1), trace(2);
  trace(3, Shard{1, 3});
  damage(frames().whole_file(1));
  damage(shard_path(frames().whole_file(3), Shard{1, 3}));
  fs::copy_file(frames().whole_file(0), frames().whole_file(2), fs::copy_options::overwrite_existing);
  EXPECT_EQ(missing_pieces(frames(), 0, 2, Check::header), (Pieces{2, 3}));
  EXPECT_EQ(missing_pieces(frames(), 0, 2), (Pieces{1, 2, 3}));
  EXPECT_EQ(missing_pieces(frames("3"), 3, 2, Check::header), (Pieces{10, 11}));
  EXPECT_EQ(missing_pieces(frames("3"), 3, 2), (Pieces{9, 10, 11}));
  const std::string damaged = frames().whole_file(1);
  EXPECT_EQ(unlike(damaged, frames().scene(1), {}), "");
  EXPECT_NE(unfinished(damaged, frames().scene(1), {}), "");
  EXPECT_EQ(unlike(damaged, frames().scene(2), {}), "is of another scene");
  EXPECT_EQ(unlike(damaged, frames().scene(1), Shard{1, 3}), "does not hold all scan lines");
  EXPECT_EQ(unlike(folder / "none.exr", frames().scene(1), {}), "is not there");
}

TEST_F(MissingPieces, WhoIsStoppedGivesNoAnswer) {
  stop_wanted = true;
  EXPECT_EQ(missing_pieces(frames(), 0, 2), std::nullopt);
}

}  // namespace
}  // namespace nullcone::test
