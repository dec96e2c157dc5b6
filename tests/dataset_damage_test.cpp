// Damaged, foreign and hostile dataset files; disks that are full.
#include <ImfChannelList.h>
#include <ImfFrameBuffer.h>
#include <ImfHeader.h>
#include <ImfOutputFile.h>
#include <sys/resource.h>
#include <sys/wait.h>

#include <algorithm>
#include <array>
#include <csignal>
#include <cstring>
#include <limits>
#include <random>
#include <span>

#include "tests/dataset_fixture.h"
#include "tests/sanitized.h"

namespace nullcone::test {
namespace {

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
    const rlimit now = {kRoom, before.rlim_max};
    if (!kSanitized) setrlimit(RLIMIT_AS, &now);
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
  constexpr std::size_t stride = kSanitized ? 11 : 1;
  for (std::size_t i = 0; i < bytes.size(); i += stride)
    for (const char wrong : {'\x03', '\xff', '\x00'}) {
      const char right = std::exchange(bytes[i], wrong);
      expect_modest(complaint(bytes), "byte " + std::to_string(i));
      bytes[i] = right;
    }
}

TEST_F(DatasetFile, RandomDamageIsRefusedOrJudged) {
  const MemoryLimit limit;
  const std::string plain = whole_file(), lit = whole_file(kAllChannels);
  int refused = 0;
  for (unsigned seed = 0; seed < 600; ++seed) {
    std::mt19937 random(seed);
    std::string bytes = seed < 300 ? plain : lit;
    for (unsigned n = 0; n <= seed % 8; ++n)
      bytes[random() % (seed % 2 ? bytes.size() : 3000)] ^= static_cast<char>(1 + random() % 255);
    const std::string found = complaint(bytes);
    expect_modest(found, "seed " + std::to_string(seed));
    refused += !found.empty();
  }
  EXPECT_GT(refused, 200);  // half of the seeds aim at the header, where hardly a byte is free
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
  says("\"format\":2", "\"format\":5", "use a newer nullcone");
  says("\"format\":2", "\"format\":4", "/lights: missing");
  says("\"format\":2", "\"format\":3", "/lights: missing");
  says("\"format\":2", "\"format\":0", "/format");
  says("\"format\":2", "\"format\":1", "unknown");
  says("\"lines\":4", "\"lines\":5", "/lines");
  says("\"first_line\":0", "\"first_line\":1", "/lines");
  says("\"traced_lines\":4", "\"traced_lines\":5", "/traced_lines");
  says("\"samples\":1", "\"samples\":0", "/samples");
  says("\"channels\":[\"Z\"", "\"channels\":[\"W\"", "/channels");
  says("\"channels\":[\"Z\",", "\"channels\":[", "/channels");
  says("\"width\":6", "\"width\":7", "window");
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

/// All values of the attribute replaced.
std::string with_window(std::string bytes, const char* name, std::array<std::int32_t, 4> window) {
  const std::string key = std::string(name) + std::string("\0box2i\0\x10\0\0\0", 11);
  for (std::size_t at = bytes.find(key); at != std::string::npos; at = bytes.find(key, at + 1))
    std::memcpy(&bytes[at + key.size()], window.data(), sizeof window);
  return bytes;
}

TEST_F(DatasetFile, HeadersThatLieGetOneLineAndNoMemory) {
  const MemoryLimit limit;
  const std::string bytes = whole_file();
  constexpr std::int32_t kMost = std::numeric_limits<std::int32_t>::max(), kLeast = -kMost - 1;
  const std::array<std::array<std::int32_t, 4>, 6> windows = {{{0, 0, kMost, kMost},
                                                               {0, 0, kMost, 3},
                                                               {0, 0, 5, kMost},
                                                               {kLeast, kLeast, kMost, kMost},
                                                               {0, 0, -1, -1},
                                                               {kLeast, 0, 5, 3}}};
  for (const auto& window : windows)
    for (const char* name : {"dataWindow", "displayWindow"}) {
      const std::string found = complaint(with_window(bytes, name, window));
      EXPECT_FALSE(found.empty()) << name << " " << window[2] << " x " << window[3];
      EXPECT_EQ(found.find('\n'), std::string::npos) << found;
      expect_modest(found, name);
    }
}

TEST_F(DatasetFile, CountsOfCrossingsThatLieGetOneLineAndNoMemory) {
  const MemoryLimit limit;
  const std::string bytes = whole_file();
  const std::array<std::uint32_t, 6> first_line = {0, 3, 5, 6, 6, 9};  // crossings up to each pixel
  const std::size_t at = bytes.find(std::string(reinterpret_cast<const char*>(first_line.data()), 24));
  ASSERT_NE(at, std::string::npos);
  for (const std::uint32_t lie : {0xffffffffU, 0x7fffffffU, 1U << 30, 1U << 20, 4000U, 10U}) {
    std::string wrong = bytes;
    std::memcpy(&wrong[at + 20], &lie, 4);
    const std::string found = complaint(wrong);
    EXPECT_FALSE(found.empty()) << lie;
    EXPECT_EQ(found.find('\n'), std::string::npos) << found;
    expect_modest(found, "count " + std::to_string(lie));
  }
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

}  // namespace
}  // namespace nullcone::test
