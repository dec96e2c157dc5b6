// A folder of this process alone, gone when it ends.
#pragma once

#include <string>

namespace nullcone::view {

class TemporaryFolder {
 public:
  /// Where the system has temporary files (TMPDIR); for the user alone. Throws WorkError.
  TemporaryFolder();
  ~TemporaryFolder();
  TemporaryFolder(const TemporaryFolder&) = delete;
  TemporaryFolder& operator=(const TemporaryFolder&) = delete;

  /// Of a file in it. `name` comes from this program.
  std::string file(const std::string& name) const { return path_ + "/" + name; }
  const std::string& path() const { return path_; }

 private:
  std::string path_;
};

}  // namespace nullcone::view
