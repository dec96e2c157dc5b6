// Scenes that change from frame to frame: "frames" says when the frames are, and numbers may have keyframes
// by time. Of each frame a plain scene is made, and that one is read, traced and kept.
#pragma once

#include <nlohmann/json_fwd.hpp>
#include <string>

namespace nullcone {

/// The frames of a sequence: `count` of them, evenly from one time to the other.
struct Frames {
  int count = 1;
  double from = 0, to = 0;
  bool coordinate = true;  ///< the observer looks at that coordinate time; else it is his proper time

  /// Of frame 0 to count − 1; exactly `from` at the first, and `to` at the last of several.
  double time(int frame) const;
};

/// Whether a scene has frames.
bool is_sequence(const nlohmann::json& scene);

/// Of a scene that is a sequence; `place` is its file's name. Throws InputError.
Frames read_frames(const nlohmann::json& scene, const std::string& place);

/// The plain scene of a frame: without `frames`, with numbers in the place of keyframes (but for those of its
/// look, which go by the number of a picture) and, by coordinate time, the observer's event at the frame's
/// time. Throws InputError.
nlohmann::json scene_at(nlohmann::json scene, const Frames& frames, int frame, const std::string& place);

/// Throws InputError where a scene has frames or keyframes outside its look.
void refuse_sequence(const nlohmann::json& scene, const std::string& place);

}  // namespace nullcone
