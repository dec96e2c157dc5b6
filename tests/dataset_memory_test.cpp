// Memory: what a dataset takes, what there is, and tracing band by band.
#include <nlohmann/json.hpp>

#include "core/record/memory.h"
#include "tests/dataset_fixture.h"
#include "tests/traced.h"

namespace nullcone::test {
namespace {

constexpr std::uint64_t kMebi = 1 << 20;

/// A folder that stands for / in available_memory().
class Memory : public DatasetFile {
 protected:
  void put(const std::string& name, const std::string& text) const {
    const fs::path place = folder / name;
    fs::create_directories(place.parent_path());
    std::ofstream(place) << text;
  }
  void SetUp() override {
    DatasetFile::SetUp();
    put("proc/meminfo", "MemTotal:   9999999 kB\nMemFree: 1 kB\nMemAvailable:    8192000 kB\n");
  }
  std::uint64_t mebibytes() const { return available_memory(folder) / kMebi; }
};

TEST_F(Memory, WithoutGroupsIsWhatTheKernelCallsAvailable) {
  EXPECT_EQ(mebibytes(), 8000u);
  put("proc/self/cgroup", "nonsense\n0::\n1:memory\n");
  EXPECT_EQ(mebibytes(), 8000u);
  EXPECT_GT(available_memory(), kMebi);  // of this machine
}

TEST_F(Memory, IsLimitedByAGroupOrOneAboveIt) {
  put("proc/self/cgroup", "0::/job/step\n");
  put("sys/fs/cgroup/job/step/memory.max", "max\n");
  EXPECT_EQ(mebibytes(), 8000u);
  put("sys/fs/cgroup/job/memory.max", std::to_string(1000 * kMebi));
  EXPECT_EQ(mebibytes(), 1000u);
  put("sys/fs/cgroup/job/memory.current", std::to_string(700 * kMebi));
  put("sys/fs/cgroup/job/memory.stat", "anon 5\nfile 7\ninactive_file " + std::to_string(100 * kMebi) + "\n");
  EXPECT_EQ(mebibytes(), 400u);
  put("sys/fs/cgroup/job/step/memory.max", std::to_string(50 * kMebi));
  EXPECT_EQ(mebibytes(), 50u);
  put("sys/fs/cgroup/job/step/memory.current", std::to_string(60 * kMebi));
  EXPECT_EQ(mebibytes(), 0u);
}

TEST_F(Memory, IsLimitedByAContainersOwnRoot) {
  put("proc/self/cgroup", "0::/\n");  // the container sees its group as the root
  put("sys/fs/cgroup/memory.max", std::to_string(300 * kMebi));
  EXPECT_EQ(mebibytes(), 300u);
}

TEST_F(Memory, IsLimitedByAGroupOfTheFirstVersion) {
  put("proc/self/cgroup", "5:cpu,cpuacct:/x\n4:hugetlb,memory:/docker/abc\n0::/\n");
  put("sys/fs/cgroup/memory/memory.limit_in_bytes", std::to_string(200 * kMebi));
  put("sys/fs/cgroup/memory/memory.usage_in_bytes", std::to_string(150 * kMebi));
  put("sys/fs/cgroup/memory/memory.stat", "total_inactive_file " + std::to_string(30 * kMebi) + "\n");
  EXPECT_EQ(mebibytes(), 80u);
}

TEST(MemoryCheck, RefusesWhatWouldNotFitIfEveryRayHitSomething) {
  Scene scene;
  scene.camera.width = 8192, scene.camera.height = 4096, scene.camera.samples = 2;
  constexpr std::uint64_t kPixel = 8 + 16, kRay = 10 * 4 + 4 * 4;
  const std::uint64_t needed = 8192u * 3 * kBandLines * (kPixel + 4 * kRay);
  EXPECT_EQ(dataset_bytes(8192 * 3 * kBandLines, 4, kDefaultChannels), needed);
  EXPECT_NO_THROW(check_memory(scene, 3, needed, "scene.json"));
  try {
    check_memory(scene, 3, needed - 1, "scene.json");
    ADD_FAILURE() << "not refused";
  } catch (const InputError& error) {
    EXPECT_NE(std::string(error.what()).find("scene.json: /camera/resolution: "), std::string::npos)
        << error.what();
  }
  const std::uint64_t all = 8192u * 4096 * (kPixel + 4 * kRay);
  EXPECT_NO_THROW(check_memory(scene, 10000, all, "scene.json"));
  // Three lamps of two paths: 96 bytes a crossing.
  scene.lights.lamps.resize(3), scene.lights.paths = 2;
  scene.records.channels = scene.records.channels | ChannelSet::of("light");
  EXPECT_NO_THROW(check_memory(scene, 3, needed + 8192u * 3 * kBandLines * 4 * 96, "scene.json"));
  EXPECT_THROW(check_memory(scene, 3, needed + 8192u * 3 * kBandLines * 4 * 96 - 1, "scene.json"),
               InputError);
}

std::string four_bands() {
  nlohmann::json scene = nlohmann::json::parse(std::ifstream(NULLCONE_SOURCE "/scenes/goedel_earth.json"));
  scene["camera"]["resolution"] = {132, 50};  // the last band is short
  return scene.dump();
}

Dataset trace(const std::string& text, const Progress& progress = {}) {
  const Scene scene = read_scene(text, "scene", metric_descriptions());
  return trace_scene(find_spacetime(scene.metric), scene, "scene", 2, progress);
}

TEST(Bands, ColumnsAreTheRecordsInFloats) {
  const Dataset dataset = trace(four_bands());
  const Traced traced = trace_text(four_bands(), 2);
  ASSERT_EQ(traced.bands.size(), 4u);
  ASSERT_EQ(dataset.hits.offset.size(), 132u * 50 + 1);
  std::size_t k = 0;
  traced.for_each_hit([&](const HitRecord& hit, std::size_t x, std::size_t y) {
    const Hits& h = dataset.hits;
    EXPECT_EQ(h.offset[132 * y + x], k);
    EXPECT_EQ(h.offset[132 * y + x + 1], k + 1);
    const std::uint32_t whole[] = {h.id[k], h.order[k]}, whole_expected[] = {hit.id, hit.order};
    const float found[] = {h.Z[k], h.A[k], h.u[k], h.v[k], h.shift[k], h.t[k], h.tau[k], h.mu[k]};
    const double records[] = {hit.Z, 1, hit.u, hit.v, hit.shift, hit.t, hit.tau, hit.mu};
    EXPECT_TRUE(std::ranges::equal(whole, whole_expected));
    EXPECT_TRUE(std::ranges::equal(found, records, {}, {}, [](double x_) { return static_cast<float>(x_); }));
    ++k;
  });
  EXPECT_EQ(dataset.hits.count(), k);
  std::size_t pixel = 0;
  for (const TracedBand& band : traced.bands)
    for (const RayRecord& ray : band.rays) {
      EXPECT_EQ(dataset.rays.status.at(pixel), ray.status);
      EXPECT_EQ(dataset.rays.steps.at(pixel), ray.steps);
      ++pixel;
    }
  EXPECT_EQ(pixel, dataset.rays.error.size());
}

TEST(Bands, ProgressIsToldInOrderToTheEnd) {
  std::vector<std::size_t> told;
  trace(four_bands(), [&](std::size_t done, std::size_t all) {
    EXPECT_EQ(all, 132u * 50);
    told.push_back(done);  // no lock: one thread at a time
  });
  EXPECT_EQ(told, (std::vector<std::size_t>{132 * 16, 132 * 32, 132 * 48, 132 * 50}));
}

TEST(Bands, WhatProgressThrowsEndsTheTracing) {
  std::size_t calls = 0;
  EXPECT_THROW(trace(four_bands(),
                     [&](std::size_t, std::size_t) {
                       ++calls;
                       throw std::domain_error("enough");
                     }),
               std::domain_error);
  EXPECT_EQ(calls, 1u);
}

}  // namespace
}  // namespace nullcone::test
