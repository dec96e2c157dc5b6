// Dataset files: what is written is read, what is damaged is noticed, and a failure leaves nothing behind.
#include <ImfChannelList.h>
#include <ImfFrameBuffer.h>
#include <ImfHeader.h>
#include <ImfOutputFile.h>
#include <gtest/gtest.h>
#include <sys/resource.h>
#include <sys/wait.h>
#include <unistd.h>

#include <algorithm>
#include <bit>
#include <csignal>
#include <cstring>
#include <filesystem>
#include <fstream>
#include <nlohmann/json.hpp>
#include <random>
#include <span>

#include "core/base/error.h"
#include "core/base/sha256.h"
#include "core/record/dataset_file.h"
#include "core/trace/trace_scene.h"
#include "metrics/registry.h"

namespace nullcone {
namespace {

namespace fs = std::filesystem;

void rehash(Dataset& dataset) {
  dataset.manifest.hits_sha256 = payload_sha256(dataset.hits);
  dataset.manifest.rays_sha256 = payload_sha256(dataset.rays);
}

/// 6 x 4 pixels with 0 to 3 crossings each (or none), and values that only exact storage keeps.
Dataset sample(bool with_hits = true) {
  Dataset out;
  Manifest& m = out.manifest;
  m.width = 6, m.height = 4;
  m.scene = R"({"metric":{"name":"minkowski"}})";
  m.scene_sha256 = sha256(m.scene);
  m.metric = "minkowski";
  m.objects = {{"earth", 0.1}, {"moon", -1e15}};
  m.version = "test 1", m.isa = "sse2", m.host = std::string(64, 'h'), m.core_seconds = 0.25;
  const float odd[] = {1e-45F, -0.0F, 3.4e38F, 0.1F, -INFINITY, NAN};
  for (std::uint32_t pixel = 0; pixel < 24; ++pixel) {
    for (std::uint32_t k = 0; with_hits && k < pixel * 7 % 4; ++k) {
      for_each_channel(out.hits, kHitChannels, [&](const auto& channel, auto& column) {
        if constexpr (std::is_same_v<std::remove_cvref_t<decltype(column)>, std::vector<float>>)
          column.push_back(odd[(pixel + k + channel.name.size()) % 6]);
        else
          column.push_back(channel.name == "id" ? 1 + k % 2 : 0xffffffffU - pixel);
      });
      out.hits.Z.back() = k < 2 ? static_cast<float>(k) + 0.1F : INFINITY;
    }
    out.hits.offset.push_back(out.hits.Z.size());
    out.rays.status.push_back(pixel % 7), out.rays.steps.push_back(0xffffff00U + pixel);
    out.rays.error.push_back(odd[pixel % 6]), out.rays.drift.push_back(1e-7F);
  }
  rehash(out);
  return out;
}

void write(const std::string& path, const Dataset& dataset) {
  write_dataset(path, dataset, Preview(4 * dataset.pixels(), 0.0F));
}

std::string slurp(const std::string& path) {
  std::ifstream in(path, std::ios::binary);
  return {std::istreambuf_iterator<char>(in), {}};
}

class DatasetFile : public ::testing::Test {
 protected:
  fs::path folder = fs::temp_directory_path() / ("nullcone_dataset_" + std::to_string(::getpid()));
  std::string path = folder / "a.exr";

  void SetUp() override { fs::create_directories(folder); }
  void TearDown() override { fs::remove_all(folder); }

  std::vector<std::string> listing() const {
    std::vector<std::string> out;
    for (const auto& entry : fs::directory_iterator(folder)) out.push_back(entry.path().filename());
    return out;
  }
  std::string whole_file() {
    write(path, sample());
    return slurp(path);
  }
  /// What reading these bytes complains about; empty if they give a dataset (which is then judged).
  std::string complaint(const std::string& bytes) {
    const std::string place = folder / "b.exr";
    std::ofstream(place, std::ios::binary) << bytes;
    return complaint_of(place);
  }
  static std::string complaint_of(const std::string& place) {
    try {
      verify(read_dataset(place));
    } catch (const InputError& error) {
      return error.what();
    }
    return {};
  }
};

template <class Table, class Channels>
void expect_same_bits(const Table& a, const Table& b, const Channels& channels) {
  for_each_channel(a, channels, [&](const auto& channel, const auto& column) {
    const auto& other = b.*channel.column;
    const auto bits = std::as_bytes(std::span(column)), other_bits = std::as_bytes(std::span(other));
    EXPECT_TRUE(std::ranges::equal(bits, other_bits)) << channel.name;
  });
}

TEST_F(DatasetFile, RoundTripKeepsEveryBit) {
  for (const bool with_hits : {true, false}) {
    const Dataset written = sample(with_hits);
    write(path, written);
    const Dataset read = read_dataset(path);
    EXPECT_EQ(read.hits.offset, written.hits.offset);
    expect_same_bits(read.hits, written.hits, kHitChannels);
    expect_same_bits(read.rays, written.rays, kRayChannels);
    EXPECT_EQ(manifest_to_json(read.manifest), manifest_to_json(written.manifest));
    EXPECT_EQ(manifest_to_json(read_manifest(path)), manifest_to_json(written.manifest));
    EXPECT_EQ(read.manifest.objects, written.manifest.objects);
    EXPECT_EQ(verify(read), std::vector<std::string>{});
    EXPECT_EQ(listing(), std::vector<std::string>{"a.exr"});
  }
}

template <class Table, class Channels>
void expect_every_flip_is_seen(Dataset& dataset, Table& table, const Channels& channels) {
  for_each_channel(table, channels, [&](const auto& channel, auto& column) {
    for (const std::size_t at : {std::size_t{0}, column.size() / 2, column.size() - 1})
      for (const std::size_t bit : {0u, 13u, 31u}) {
        const auto right = column[at];
        column[at] = std::bit_cast<std::remove_cvref_t<decltype(right)>>(std::bit_cast<std::uint32_t>(right) ^
                                                                         1U << bit);
        EXPECT_FALSE(verify(dataset).empty()) << channel.name << ", entry " << at << ", bit " << bit;
        column[at] = right;
      }
    EXPECT_TRUE(verify(dataset).empty()) << channel.name;
  });
}

TEST(Verify, SeesAFlippedBitInEveryChannel) {
  Dataset dataset = sample();
  expect_every_flip_is_seen(dataset, dataset.hits, kHitChannels);
  expect_every_flip_is_seen(dataset, dataset.rays, kRayChannels);
  ++dataset.hits.offset[1];  // a crossing that changed its pixel
  EXPECT_FALSE(verify(dataset).empty());
}

TEST(Verify, SeesAWrongShapeAndAForgedManifest) {
  void (*const changes[])(Dataset&) = {
      [](Dataset& d) { d.manifest.width = 7; },
      [](Dataset& d) { d.hits.mu.pop_back(); },
      [](Dataset& d) { d.rays.steps.push_back(1); },
      [](Dataset& d) { d.hits.offset.clear(); },
      [](Dataset& d) { d.hits.offset[1] = 1U << 30; },
      [](Dataset& d) { std::swap(d.hits.offset[1], d.hits.offset[2]), rehash(d); },
      [](Dataset& d) { d.hits.id[0] = 0, rehash(d); },
      [](Dataset& d) { d.hits.id[0] = 3, rehash(d); },
      [](Dataset& d) { std::swap(d.hits.Z[0], d.hits.Z[1]), rehash(d); },
      [](Dataset& d) { d.manifest.scene[5] = 'E'; },
      [](Dataset& d) { d.manifest.scene_sha256[0] ^= 1; },
  };
  for (std::size_t i = 0; i < std::size(changes); ++i) {
    Dataset dataset = sample();
    changes[i](dataset);
    EXPECT_FALSE(verify(dataset).empty()) << "change " << i;
  }
}

TEST_F(DatasetFile, EveryTruncationIsRefused) {
  const std::string bytes = whole_file();
  for (std::size_t i = 0; i < 50; ++i)
    EXPECT_FALSE(complaint(bytes.substr(0, bytes.size() * i / 50)).empty()) << i << "/50";
  EXPECT_FALSE(complaint(bytes.substr(0, bytes.size() - 1)).empty());
}

/// OpenEXR 3.1 itself takes up to 2 GiB for a text in the header whose length is damaged.
constexpr rlim_t kRoom = rlim_t{4} << 30;

/// Allocations beyond kRoom fail while this lives. (Not under sanitizers, which reserve terabytes.)
struct MemoryLimit {
  rlimit before{};
  MemoryLimit() {
    getrlimit(RLIMIT_AS, &before);
#if !defined(__SANITIZE_ADDRESS__) && !defined(__SANITIZE_THREAD__)
    const rlimit now = {kRoom, before.rlim_max};
    setrlimit(RLIMIT_AS, &now);
#endif
  }
  ~MemoryLimit() { setrlimit(RLIMIT_AS, &before); }
};
/// A damaged file must not talk the reader into an allocation far beyond the file.
void expect_modest(const std::string& found, const std::string& what) {
  for (const char* sign : {"bad_alloc", "vector::", "length_error", "allocate"})
    EXPECT_EQ(found.find(sign), std::string::npos) << what << ": " << found;
}

TEST_F(DatasetFile, EveryByteMayBeWrong) {
  const MemoryLimit limit;
  std::string bytes = whole_file();
  for (std::size_t i = 0; i < bytes.size(); ++i)
    for (const char wrong : {'\x03', '\xff', '\x00'}) {
      const char right = std::exchange(bytes[i], wrong);
      expect_modest(complaint(bytes), "byte " + std::to_string(i));
      bytes[i] = right;
    }
}

TEST_F(DatasetFile, RandomDamageIsRefusedOrJudged) {
  const MemoryLimit limit;
  const std::string whole = whole_file();
  int refused = 0;
  for (unsigned seed = 0; seed < 300; ++seed) {
    std::mt19937 random(seed);
    std::string bytes = whole;
    for (unsigned n = 0; n <= seed % 8; ++n)
      bytes[random() % (seed % 2 ? bytes.size() : 3000)] ^= static_cast<char>(1 + random() % 255);
    const std::string found = complaint(bytes);
    expect_modest(found, "seed " + std::to_string(seed));
    refused += !found.empty();
  }
  EXPECT_GT(refused, 100);  // half of the seeds aim at the header, where hardly a byte is free
}

TEST_F(DatasetFile, DamagedPixelsAreSeenByVerify) {
  std::string bytes = whole_file();
  const float z = 1.1F;  // the deep part is not compressed
  bytes.at(bytes.find(std::string(reinterpret_cast<const char*>(&z), 4), 3000)) ^= 1;
  std::ofstream(path, std::ios::binary) << bytes;
  EXPECT_FALSE(verify(read_dataset(path)).empty());
}

/// The file with another manifest of the same length; `host` gives or takes the difference.
std::string with_manifest(std::string bytes, const std::string& from, const std::string& to) {
  const std::string host(64, 'h'), fitted(64 - to.size() + from.size(), 'h');
  bytes.replace(bytes.find(from), from.size(), to);
  return bytes.replace(bytes.find(host), host.size(), fitted);
}

TEST_F(DatasetFile, AManifestIsReadStrictly) {
  const std::string bytes = whole_file();
  const auto says = [&](const char* from, const char* to, const char* expected) {
    const std::string found = complaint(with_manifest(bytes, from, to));
    EXPECT_NE(found.find(expected), std::string::npos) << from << " -> " << to << ": '" << found << "'";
  };
  says("\"format\":1", "\"format\":2", "use a newer nullcone");
  says("\"format\":1", "\"format\":0", "/format");
  says("\"width\":6", "\"width\":7", "size");
  says("\"width\":6", "\"width\":-6", "/width");
  says("\"isa\":", "\"isb\":", "/isa: missing");
  says("\"isa\":", "\"new\":1,\"isa\":", "/new: unknown");
  says("\"moon\"", "\"earth\"", "/objects/1/name");
  says("\"moon\"", "\"m n\"", "/objects/1/name");
}

TEST_F(DatasetFile, APictureBeyondTheFileIsRefusedBeforeItsMemoryIsTaken) {
  const MemoryLimit limit;
  std::string bytes = with_manifest(whole_file(), "\"width\":6", "\"width\":16777216");
  const std::string key("dataWindow\0box2i\0\x10\0\0\0", 21);
  const std::int32_t window[4] = {0, 0, 16777215, 3};
  for (std::size_t at = bytes.find(key); at != std::string::npos; at = bytes.find(key, at + 1))
    std::memcpy(&bytes[at + key.size()], window, sizeof window);
  const std::string found = complaint(bytes);
  EXPECT_FALSE(found.empty());
  expect_modest(found, "16777216 x 4 pixels");
}

TEST_F(DatasetFile, StrangersAreRefusedByName) {
  const auto says = [&](const std::string& place, const char* expected) {
    const std::string found = complaint_of(place);
    EXPECT_NE(found.find(expected), std::string::npos) << place << ": '" << found << "'";
  };
  std::ofstream(folder / "text.exr") << "no picture\n";
  std::ofstream(folder / "empty.exr");
  std::ofstream(folder / "magic.exr") << "\x76\x2f\x31\x01";
  std::ofstream(folder / "a.png") << "\x89PNG\r\n\x1a\n";
  for (const char* name : {"text.exr", "empty.exr", "a.png", ""})
    says(folder / name, "is not an OpenEXR file");
  for (const char* place : {"/dev/zero", "/dev/null"}) says(place, "is not an OpenEXR file");
  says(folder / "none.exr", "cannot open the file");
  says(folder / "magic.exr", "damaged");
  Imf::Header header(2, 2);
  header.channels().insert("Z", Imf::Channel(Imf::FLOAT));
  const float pixels[4] = {};
  Imf::FrameBuffer buffer;
  buffer.insert("Z", Imf::Slice(Imf::FLOAT, reinterpret_cast<char*>(const_cast<float*>(pixels)), 4, 8));
  {
    Imf::OutputFile file(path.c_str(), header);
    file.setFrameBuffer(buffer);
    file.writePixels(2);
  }
  says(path, "not a nullcone dataset");
}

/// Writes in a child process that may write `most` bytes a file. Exit status 0: written, 1: WorkError, 3:
/// other.
int write_within(const std::string& path, const Dataset& dataset, rlim_t most) {
  const pid_t child = ::fork();
  if (child == 0) {
    std::signal(SIGXFSZ, SIG_IGN);
    const rlimit limit = {most, most};
    setrlimit(RLIMIT_FSIZE, &limit);
    try {
      write(path, dataset);
    } catch (const std::exception& error) {
      ::_exit(dynamic_cast<const WorkError*>(&error) ? 1 : 3);
    }
    ::_exit(0);
  }
  int status = 0;
  ::waitpid(child, &status, 0);
  return WIFEXITED(status) ? WEXITSTATUS(status) : 128 + WTERMSIG(status);
}

TEST_F(DatasetFile, AFullDiskIsNoticedToTheLastByte) {
  Dataset large = sample();  // larger than any buffer, so that some writes fail at once and some at the end
  large.manifest.host = std::string(100'000, 'h');
  write(path, large);
  const std::string whole = slurp(path);
  for (const std::size_t missing : {whole.size(), whole.size() - 1, whole.size() / 2, whole.size() / 50,
                                    std::size_t{100}, std::size_t{1}}) {
    EXPECT_EQ(write_within(path, large, whole.size() - missing), 1) << missing << " bytes missing";
    EXPECT_EQ(listing(), std::vector<std::string>{"a.exr"});
    EXPECT_TRUE(slurp(path) == whole) << "the old file is gone";
  }
  EXPECT_EQ(write_within(path, large, whole.size()), 0);
}

TEST_F(DatasetFile, WhereNothingCanBeWrittenNothingIsLeft) {
  for (const std::string place : {"/proc/a.exr", "/nonexistent/a.exr", "/dev/full/a.exr"})
    EXPECT_THROW(write(place, sample()), WorkError) << place;
  fs::create_directories(folder / "folder.exr" / "x");
  EXPECT_THROW(write(folder / "folder.exr", sample()), WorkError);
  EXPECT_EQ(listing(), std::vector<std::string>{"folder.exr"});
}

Dataset trace_text(const std::string& text, int threads) {
  const Scene scene = read_scene(text, "scene", metric_descriptions());
  return trace_scene(find_spacetime(scene.metric), scene, "scene", threads);
}

TEST_F(DatasetFile, TracedAgainFromItsHeaderItIsTheSame) {
  nlohmann::json scene = nlohmann::json::parse(std::ifstream(NULLCONE_SOURCE "/scenes/goedel_earth.json"));
  scene["camera"]["resolution"] = {132, 50};  // four bands, the last one short
  const Dataset one = trace_text(scene.dump(), 1), two = trace_text(scene.dump(), 2);
  EXPECT_GT(one.hits.count(), 100u);
  EXPECT_EQ(one.manifest.hits_sha256, two.manifest.hits_sha256);
  EXPECT_EQ(one.manifest.rays_sha256, two.manifest.rays_sha256);
  write(path, one);
  const Dataset again = trace_text(read_manifest(path).scene, 2);
  EXPECT_EQ(again.manifest.hits_sha256, one.manifest.hits_sha256);
  EXPECT_EQ(again.manifest.scene_sha256, one.manifest.scene_sha256);
  EXPECT_EQ(verify(read_dataset(path)), std::vector<std::string>{});
}

}  // namespace
}  // namespace nullcone
