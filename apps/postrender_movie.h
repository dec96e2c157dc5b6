// A movie out of pictures, by ffmpeg.
#pragma once

#include <atomic>
#include <string>
#include <vector>

namespace nullcone {

/// Throws InputError unless `path` ends in .mp4 or .mkv and can be a file.
void check_movie_name(const std::string& path);

/// Throws InputError unless pictures of this name are PNG or JPEG files.
void check_movie_pictures(const std::string& picture);

/// Where ffmpeg stands on PATH. Throws InputError if it does not.
std::string find_ffmpeg();

/// Writes H.264 (yuv420p, BT.709) from PNG or JPEG files, which must be of one kind; sides that are odd are
/// made even by a black line. It is written beside its name and renamed when complete. False when `stop` came
/// first; throws WorkError with ffmpeg's last line where it fails.
bool write_movie(const std::string& path, const std::vector<std::string>& pictures, double fps,
                 const std::atomic<bool>& stop);

}  // namespace nullcone
