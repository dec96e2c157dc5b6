// Numbers of frames, and names of files with a number in them: "picture.####.png".
#pragma once

#include <map>
#include <set>
#include <string>
#include <vector>

namespace nullcone::postrender {

/// Frames from a list such as "0-249", "0-249:5" (every fifth) or "3,7,9-12", in that order. Throws
/// InputError for what is no such list, frames that stand twice, and more than a million of them.
std::vector<int> parse_frames(const std::string& text);

/// Whether there is a # in the name.
bool has_number(const std::string& pattern);

/// The name with the run of # replaced by the frame's number, padded with zeros to as many digits. Throws
/// InputError "option: ..." where # stands in two places.
std::string numbered(const std::string& pattern, int frame, const std::string& option);

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
