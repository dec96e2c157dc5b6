#include "core/record/file_hash.h"

#include <unistd.h>

#include <algorithm>
#include <atomic>
#include <future>
#include <string_view>
#include <thread>
#include <vector>

#include "core/base/sha256.h"

namespace nullcone {

namespace {

constexpr std::size_t kBlock = 1 << 20, kDigits = 64;
/// How the attribute stands in an OpenEXR header: name, type, length.
constexpr std::string_view kBefore{"nullconeSha256\0string\0\x40\0\0\0", 26};
/// A scene of 64 MiB may stand before it.
constexpr std::uint64_t kHeader = std::uint64_t{200} << 20;

/// Up to `size` bytes from `at` on; fewer at the end of the file.
std::size_t read_at(int descriptor, std::uint64_t at, char* to, std::size_t size) {
  std::size_t done = 0;
  while (done < size) {
    const ssize_t got = ::pread(descriptor, to + done, size - done, static_cast<off_t>(at + done));
    if (got <= 0) break;
    done += static_cast<std::size_t>(got);
  }
  return done;
}

}  // namespace

std::optional<std::uint64_t> find_text(int descriptor, std::string_view text, std::uint64_t within) {
  std::vector<char> block(kBlock + text.size());
  for (std::uint64_t at = 0; at < within; at += kBlock) {
    const std::size_t size = read_at(descriptor, at, block.data(), block.size());
    const std::size_t found = std::string_view(block.data(), size).find(text);
    if (found != std::string_view::npos) return at + found;
    if (size < block.size()) break;
  }
  return {};
}

std::optional<std::uint64_t> find_file_hash(int descriptor) {
  const auto found = find_text(descriptor, kBefore, kHeader);
  return found ? std::optional(*found + kBefore.size()) : std::nullopt;
}

std::string stored_file_hash(int descriptor, std::uint64_t place) {
  std::string out(kDigits, ' ');
  out.resize(read_at(descriptor, place, out.data(), kDigits));
  return out;
}

std::string compute_file_hash(int descriptor, std::uint64_t place, unsigned threads) {
  const auto size = static_cast<std::uint64_t>(std::max<off_t>(::lseek(descriptor, 0, SEEK_END), 0));
  const std::uint64_t blocks = (size + kBlock - 1) / kBlock;
  std::vector<std::string> digests(blocks);
  std::atomic<std::uint64_t> next = 0;
  const auto work = [&] {
    std::vector<char> block(kBlock);
    for (std::uint64_t i; (i = next++) < blocks;) {
      const std::uint64_t at = i * kBlock, end = at + read_at(descriptor, at, block.data(), block.size());
      const std::uint64_t from = std::clamp(place, at, end), to = std::clamp(place + kDigits, at, end);
      std::fill(block.begin() + static_cast<std::ptrdiff_t>(from - at),
                block.begin() + static_cast<std::ptrdiff_t>(to - at), '0');
      digests[i] = sha256({block.data(), end - at});
    }
  };
  std::vector<std::future<void>> others;
  const std::uint64_t wanted = threads > 0 ? threads : std::thread::hardware_concurrency();
  for (std::uint64_t i = 1; i < std::min(wanted, blocks); ++i)
    others.push_back(std::async(std::launch::async, work));
  work();
  for (auto& other : others) other.get();
  Sha256 all;
  for (const std::string& digest : digests) all.add(digest);
  return all.digits();
}

}  // namespace nullcone
