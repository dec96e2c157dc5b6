// Small datasets, a folder that vanishes, and what reading damaged bytes complains about.
#pragma once

#include <gtest/gtest.h>
#include <unistd.h>

#include <algorithm>
#include <cmath>
#include <filesystem>
#include <fstream>
#include <iterator>

#include "core/base/error.h"
#include "core/base/sha256.h"
#include "core/record/dataset_file.h"

namespace nullcone::test {

namespace fs = std::filesystem;

/// As long as a name may be.
inline constexpr const char* kLongName = "a2345678901234567890123456789-_Z";

/// A value in a channel's range that only exact storage keeps.
inline float odd_value(const ChannelInfo& channel, std::size_t n) {
  const std::array within = {1e-45F, 0.1F, 0.99999994F, 1.0F, 0.0F, 0.3F},
                   positive = {1e-45F, 3.4e38F, 0.1F, INFINITY, 0.0F, 7.7F},
                   any = {1e-45F, -0.0F, 3.4e38F, 0.1F, -INFINITY, -1.7F};
  if (channel.range == "finite") return n % 6 == 4 ? -3.4e38F : any[n % 6];
  if (channel.range.ends_with(", finite"))
    return n % 6 == 3 ? 2.5F : n % 6 == 4 && channel.range.starts_with("above 0") ? 0.7F : positive[n % 6];
  if (channel.range.ends_with(" to 1")) return within[n % 6];
  return channel.range == "from 0" ? positive[n % 6] : any[n % 6];
}

/// 6 x 4 pixels with 0 to 3 crossings each (or none), and values that only exact storage keeps; with light of
/// two lamps along two paths each, if that is among the channels.
inline Dataset sample(bool with_hits = true, ChannelSet channels = kDefaultChannels) {
  Dataset out;
  Manifest& m = out.manifest;
  m.set_size(6, 4);
  m.setting = R"({"camera":{"type":"sphere"}})";
  m.channels = channels;
  if (channels.has("light")) m.set_lights({{"sun", 0.25}, {kLongName, -1e9}}, 2);
  out.hits = empty_hits(m);
  m.scene = R"({"metric":{"name":"minkowski"}})";
  m.scene_sha256 = sha256(m.scene);
  m.metric = "minkowski";
  m.objects = {{"earth", 0.1}, {"moon", -1e15}};
  m.version = "test 1", m.isa = "sse2", m.host = std::string(64, 'h'), m.effort.core_seconds = 0.25;
  m.effort.seconds = 0.125;
  for (std::uint32_t pixel = 0; pixel < 24; ++pixel) {
    for (std::uint32_t k = 0; with_hits && k < pixel * 7 % 4; ++k) {
      for_each_channel(
          [&](const ChannelInfo& channel, auto& column) {
            if constexpr (std::is_same_v<std::remove_cvref_t<decltype(column)>, std::vector<float>>)
              column.push_back(odd_value(channel, pixel + k + channel.name.size()));
            else
              column.push_back(channel.name == "id"       ? 1 + k % 2
                               : channel.name == "sample" ? 0
                                                          : 0xffffffffU - pixel);
          },
          out.hits);
      out.hits.Z.back() = k < 2 ? static_cast<float>(k) + 0.1F : INFINITY;
    }
    out.hits.offset.push_back(out.hits.Z.size());
    out.rays.status.push_back(pixel % 7), out.rays.steps.push_back(0xffffff00U + pixel);
    out.rays.error.push_back(odd_value(kRayChannelInfo[2], pixel)), out.rays.drift.push_back(1e-7F);
  }
  fingerprint(out);
  return out;
}

inline void write(const std::string& path, const Dataset& dataset) {
  write_dataset(path, dataset, Preview(4 * dataset.pixels(), 0.0F));
}

inline std::string slurp(const std::string& path) {
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
    std::sort(out.begin(), out.end());
    return out;
  }
  std::string whole_file(ChannelSet channels = kDefaultChannels) {
    write(path, sample(true, channels));
    return slurp(path);
  }
  /// What reading these bytes complains about; empty if they give a dataset (which is then judged).
  std::string complaint(const std::string& bytes) {
    const std::string place = folder / "b.exr";
    fs::remove(place);  // cheaper than to truncate: ext4 then waits for the disk
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

}  // namespace nullcone::test
