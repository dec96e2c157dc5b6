// A file that is whole or not there: written beside its name, made to last, then renamed.
#pragma once

#include <fcntl.h>
#include <sys/file.h>
#include <sys/stat.h>
#include <unistd.h>

#include <cerrno>
#include <cstdio>
#include <filesystem>
#include <fstream>
#include <string>
#include <utility>

#include "core/base/error.h"

namespace nullcone {

/// An open descriptor that closes itself; -1 for none.
class Descriptor {
 public:
  Descriptor() = default;
  Descriptor(const std::string& path, int flags) : number_(::open(path.c_str(), flags | O_CLOEXEC, 0666)) {}
  ~Descriptor() {
    if (number_ >= 0) ::close(number_);
  }
  Descriptor(Descriptor&& other) noexcept : number_(std::exchange(other.number_, -1)) {}
  Descriptor& operator=(Descriptor&& other) noexcept {
    std::swap(number_, other.number_);
    return *this;
  }

  explicit operator bool() const { return number_ >= 0; }
  int number() const { return number_; }
  /// Takes the lock that the system gives back when a process ends, however it ends.
  bool lock(bool wait) const { return ::flock(number_, LOCK_EX | (wait ? 0 : LOCK_NB)) == 0; }

 private:
  int number_ = -1;
};

/// Writes PATH beside its name, as PATH.part-nullcone-PID, and renames it in finish(), so that under PATH
/// there is always nothing, the old file or the new one, also after a power cut. What is not finished is
/// removed. A process that is killed outright leaves its part; it is removed by the next write to the same
/// name. Whether its process is gone is told by a lock on the part, not by its number: that may belong to
/// another host.
class WholeFile {
 public:
  explicit WholeFile(std::string path) : path_(std::move(path)) {
    remove_leftovers();
    stream_.open(beside_ = take_part(), std::ios::binary | std::ios::trunc);
  }
  ~WholeFile() {
    if (!beside_.empty()) ::unlink(beside_.c_str());
  }
  WholeFile(const WholeFile&) = delete;
  WholeFile& operator=(const WholeFile&) = delete;

  std::ofstream& stream() { return stream_; }
  /// Of the same file, to be read and patched; flush the stream first.
  int descriptor() const { return part_.number(); }

  /// Under another name of the same folder.
  void finish(const std::string& path) {
    path_ = path;
    finish();
  }
  /// Throws WorkError unless every byte is on the disk and under its name.
  void finish() {
    stream_.close();
    if (!stream_ || ::fsync(part_.number()) != 0)
      throw WorkError(path_, "cannot write all of it (is the disk full?)");
    if (std::rename(beside_.c_str(), path_.c_str()) != 0)
      throw WorkError(path_, "cannot rename the finished file");
    beside_.clear();
    const Descriptor folder(folder_of(path_), O_RDONLY | O_DIRECTORY);
    if (folder && ::fsync(folder.number()) != 0 && errno != EINVAL && errno != ENOTSUP)
      throw WorkError(path_, "is written, but may not outlive a power cut");
  }

 private:
  static constexpr const char* kPart = ".part-nullcone-";

  static std::string folder_of(const std::filesystem::path& path) {
    return path.has_parent_path() ? path.parent_path().string() : ".";
  }

  /// Removes the parts that nobody writes any more; those of other users stay.
  void remove_leftovers() const {
    const std::string start = std::filesystem::path(path_).filename().string() + kPart;
    std::error_code error;
    std::filesystem::directory_iterator entry(folder_of(path_), error);
    for (; !error && entry != std::filesystem::directory_iterator(); entry.increment(error)) {
      const std::string name = entry->path().filename().string();
      if (!name.starts_with(start) || name.find_first_not_of("0123456789-", start.size()) != name.npos)
        continue;
      const Descriptor part(entry->path(), O_RDWR | O_NOFOLLOW | O_NONBLOCK);
      if (part && part.lock(false)) ::unlink(entry->path().c_str());
    }
  }

  /// Creates a part of our own and locks it; returns its name.
  std::string take_part() {
    for (int n = 0; n < 100; ++n) {
      const std::string name =
          path_ + kPart + std::to_string(::getpid()) + (n ? "-" + std::to_string(n) : "");
      Descriptor part(name, O_RDWR | O_CREAT | O_EXCL);
      if (!part && errno == EEXIST) continue;  // another thread writes the same name, or another host
      if (!part) break;
      part.lock(true);  // where files cannot be locked, leftovers are never removed
      struct stat now {};
      if (::fstat(part.number(), &now) == 0 && now.st_nlink == 0)
        continue;  // taken for a leftover before the lock
      part_ = std::move(part);
      return name;
    }
    throw WorkError(path_, "cannot write there");
  }

  std::string path_, beside_;
  Descriptor part_;
  std::ofstream stream_;
};

}  // namespace nullcone
