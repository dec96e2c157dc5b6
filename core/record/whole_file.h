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
#include <optional>
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

/// Writes PATH beside its name, as PATH.part-nullcone-N, and renames it in finish(), so that under PATH there
/// is always nothing, the old file or the new one, also after a power cut. What is not finished is removed. A
/// process that is killed outright leaves its part; it is removed by the next write to the same name. Whether
/// its process is gone is told by a lock on the part: a number of the process might belong to another host.
/// Parts are looked for by their names, from N = 0 on: no folder is ever listed, however many files it has.
class WholeFile {
 public:
  explicit WholeFile(std::string path) : path_(std::move(path)) {
    remove_leftovers();
    take_part();
    stream_.open(beside_, std::ios::binary | std::ios::trunc);
  }
  ~WholeFile() {
    if (!beside_.empty() && is_under(beside_, part_).value_or(true)) ::unlink(beside_.c_str());
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
    if (!is_under(beside_, part_).value_or(true))
      throw WorkError(path_, "is being written by somebody else, who has removed what was written here");
    if (std::rename(beside_.c_str(), path_.c_str()) != 0)
      throw WorkError(path_, "cannot rename the finished file");
    beside_.clear();
    const Descriptor folder(folder_of(path_), O_RDONLY | O_DIRECTORY);
    if (folder && ::fsync(folder.number()) != 0 && errno != EINVAL && errno != ENOTSUP)
      throw WorkError(path_, "is written, but may not outlive a power cut");
  }

 private:
  static constexpr int kLookedFor = 4, kMostParts = 1000;

  std::string part_name(int n) const { return path_ + ".part-nullcone-" + std::to_string(n); }
  static std::string folder_of(const std::filesystem::path& path) {
    return path.has_parent_path() ? path.parent_path().string() : ".";
  }
  static Descriptor open_part(const std::string& name) { return {name, O_RDWR | O_NOFOLLOW | O_NONBLOCK}; }

  /// Whether the name is this file's; nothing where that cannot be told. The name is opened anew: network
  /// file systems may remember for a while what it stood for, but not then.
  static std::optional<bool> is_under(const std::string& name, const Descriptor& file) {
    struct stat here {
    }, there{};
    const Descriptor named = open_part(name);
    if (!named || ::fstat(file.number(), &here) != 0 || ::fstat(named.number(), &there) != 0)
      return std::nullopt;
    return here.st_dev == there.st_dev && here.st_ino == there.st_ino;
  }
  static bool is_file(const Descriptor& part) {
    struct stat found {};
    return ::fstat(part.number(), &found) == 0 && S_ISREG(found.st_mode);
  }

  /// Removes the parts that nobody writes any more; those of other users stay. Several of one name come from
  /// several writers at once, and the first of them may have finished: so gaps are looked beyond.
  void remove_leftovers() const {
    bool there = true;
    for (int n = 0; n < kLookedFor || (there && n < kMostParts); ++n) {
      const std::string name = part_name(n);
      const Descriptor part = open_part(name);
      there = part || errno != ENOENT;
      // Who holds the lock is alone in renaming and removing the part. But before we held it, the part may
      // have been finished, and its name given to another one.
      if (part && is_file(part) && part.lock(false) && is_under(name, part).value_or(false))
        ::unlink(name.c_str());
    }
  }

  /// Creates a part of our own and locks it.
  void take_part() {
    for (int n = 0; n < kMostParts; ++n) {
      const std::string name = part_name(n);
      Descriptor part(name, O_RDWR | O_CREAT | O_EXCL);
      if (!part && errno == EEXIST) continue;  // somebody writes the same name, perhaps on another host
      if (!part) break;
      part.lock(true);  // where files cannot be locked, leftovers are never removed
      struct stat now {};
      if (::fstat(part.number(), &now) != 0 || now.st_nlink == 0)
        continue;  // taken for a leftover before the lock
      part_ = std::move(part);
      beside_ = name;
      return;
    }
    throw WorkError(path_, "cannot write there");
  }

  std::string path_, beside_;
  Descriptor part_;
  std::ofstream stream_;
};

}  // namespace nullcone
