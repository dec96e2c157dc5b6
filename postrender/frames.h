// Frames of a sequence, and their files.
#pragma once

#include <map>
#include <set>
#include <string>
#include <vector>

#include "core/base/frame_numbers.h"

namespace nullcone::postrender {

/// One frame of a sequence.
struct FrameFiles {
  int frame = 0;
  std::string data;
  std::vector<std::string> looks;  ///< stacked; none: that of the scene
  std::string picture;
};

/// What all names are made of; `picture` may be empty: then none is written.
struct FramePatterns {
  std::string data;
  std::vector<std::string> looks;
  std::string picture;
  bool any() const;
};

/// The pictures of all frames.
class PictureNames {
 public:
  /// Throws InputError where they would overwrite one another, are folders, or their folder is not there.
  explicit PictureNames(const std::vector<FrameFiles>& files);
  /// Throws InputError where `file` is one of them.
  void check_input(const std::string& file) const;

 private:
  std::map<std::string, std::string> pictures_;  ///< as they are told, by real name
  std::set<std::string> in_folders_;             ///< their names without folders
};

/// The files of all frames. Throws InputError as PictureNames does, where a picture would overwrite the data
/// or a look, and for inputs that are not there (all of them in one line).
std::vector<FrameFiles> files_of(const FramePatterns& patterns, const std::vector<int>& frames);

}  // namespace nullcone::postrender
