// How much memory a dataset takes, and how much there is.
#pragma once

#include <algorithm>
#include <bit>
#include <cstdint>
#include <filesystem>
#include <fstream>
#include <limits>
#include <string>

#include "core/record/hits.h"

namespace nullcone {

/// Bytes that records and their preview take in memory if every ray hits something once; every channel has
/// four bytes. `light_paths`: of all lamps together.
constexpr std::uint64_t dataset_bytes(std::uint64_t pixels, std::uint64_t samples, ChannelSet channels,
                                      std::uint64_t light_paths = 0) {
  const std::uint64_t crossing =
      4 * (static_cast<std::uint64_t>(std::popcount(channels.bits & ~ChannelSet::kLight)) +
           kLightChannelInfo.size() * light_paths);
  constexpr std::uint64_t ray = 4 * kRayChannelInfo.size(),
                          pixel = sizeof(Hits::offset[0]) + 4 * sizeof(float);
  return pixels * (pixel + samples * (ray + crossing));
}

/// The number after `key` in a file of lines "key number …", such as those under /proc; `fallback` if none.
inline std::uint64_t number_in(const std::filesystem::path& path, const std::string& key,
                               std::uint64_t fallback) {
  std::ifstream in(path);
  for (std::string line; std::getline(in, line);)
    if (line.starts_with(key)) {
      const std::size_t digits = line.find_first_of("0123456789", key.size());
      if (digits != line.npos) return std::strtoull(line.c_str() + digits, nullptr, 10);
    }
  return fallback;
}

inline constexpr std::uint64_t kUnlimited = std::numeric_limits<std::uint64_t>::max();

/// What a control group and those above it leave: limit minus use, where cached files do not count as used.
inline std::uint64_t memory_of_group(const std::filesystem::path& mount, std::filesystem::path group,
                                     const char* limit, const char* used, const char* cached) {
  std::uint64_t out = kUnlimited;
  for (bool top = false; !top; group = group.parent_path()) {
    top = !group.has_relative_path();
    const std::filesystem::path folder = mount / group.relative_path();
    const std::uint64_t most = number_in(folder / limit, "", kUnlimited);
    const std::uint64_t cache = number_in(folder / "memory.stat", cached, 0);
    const std::uint64_t use = number_in(folder / used, "", 0);
    const std::uint64_t held = use - std::min(use, cache);
    if (most != kUnlimited) out = std::min(out, most - std::min(most, held));
  }
  return out;
}

/// Bytes that this process may still take without swapping or being killed: what the kernel calls available,
/// or less where a control group (a container, a job of Slurm) sets a limit. `root` stands before /proc and
/// /sys.
inline std::uint64_t available_memory(const std::string& root = "") {
  const std::uint64_t kibibytes = number_in(root + "/proc/meminfo", "MemAvailable:", kUnlimited >> 10);
  std::uint64_t out = kibibytes << 10;
  std::ifstream in(root + "/proc/self/cgroup");  // lines "number:controllers:/group"
  for (std::string line; std::getline(in, line);) {
    const std::size_t first = line.find(':'), second = line.find(':', first + 1);
    if (second == line.npos) continue;
    const std::string controllers = "," + line.substr(first + 1, second - first - 1) + ",";
    const std::string group = line.substr(second + 1);
    if (controllers == ",,")
      out = std::min(out, memory_of_group(root + "/sys/fs/cgroup", group, "memory.max", "memory.current",
                                          "inactive_file"));
    else if (controllers.find(",memory,") != controllers.npos)
      out = std::min(out, memory_of_group(root + "/sys/fs/cgroup/memory", group, "memory.limit_in_bytes",
                                          "memory.usage_in_bytes", "total_inactive_file"));
  }
  return out;
}

}  // namespace nullcone
