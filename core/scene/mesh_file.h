// Files that meshes are read from: whatever is no plain file of a fair size is refused before it is read.
#pragma once

#include <cstdio>
#include <memory>
#include <string>
#include <string_view>

#include "core/base/sha256.h"

namespace nullcone {

class MeshFile {
 public:
  static constexpr std::size_t kLargest = std::size_t{1} << 30;

  /// Opens it; throws InputError for what does not exist, is no plain file, is empty, or larger than
  /// kLargest.
  explicit MeshFile(const std::string& path);

  const std::string& path() const { return path_; }
  std::size_t size() const { return size_; }
  /// Fewer bytes than `count` only at the end.
  std::size_t read(char* to, std::size_t count);
  std::string read_all();
  /// Of all bytes that were read; to be asked for once, at the end.
  std::string sha256() { return hash_.digits(); }

  [[noreturn]] void refuse(std::string_view message) const;

 private:
  struct Close {
    void operator()(std::FILE* file) const { std::fclose(file); }
  };
  std::string path_;
  std::size_t size_ = 0;
  std::unique_ptr<std::FILE, Close> file_;
  Sha256 hash_;
};

}  // namespace nullcone
