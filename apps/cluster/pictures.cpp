#include "apps/cluster/pictures.h"

#include <algorithm>
#include <filesystem>
#include <sstream>

#include "apps/cluster/child.h"
#include "core/base/frame_numbers.h"
#include "core/base/sha256.h"

namespace nullcone::cluster {

namespace fs = std::filesystem;

namespace {

/// Those of the settings, else the scene's as it is now: datasets hold the look of the day they were traced.
std::vector<std::string> looks_of(const Folder& folder, const Settings& settings) {
  if (!settings.looks.empty()) return settings.looks;
  return fs::exists(folder.look()) ? std::vector{folder.look()} : std::vector<std::string>{};
}

std::string movie_of(const Folder& folder, const Settings& settings) {
  return (fs::path(folder.path()) / settings.movie).string();
}

fs::file_time_type time_of(const std::string& path) {
  std::error_code error;
  return fs::last_write_time(path, error);  // the least of all times if it is not there
}

/// What tells pictures apart.
std::string request_for(const Folder& folder, const Settings& settings) {
  std::string out = shell_line(picture_command(folder, settings)) + "\n" +
                    shell_line(movie_options(folder, settings)) + "\n";
  for (const std::string& look : looks_of(folder, settings)) out += sha256(read_text(look)) + "\n";
  return out;
}

std::string picture_of(const Folder& folder, int frame) {
  return numbered(folder.pictures(), frame, "--output");
}

}  // namespace

int count_pictures(const Folder& folder, const Settings& settings, const std::vector<int>& frames) {
  fs::file_time_type look = fs::file_time_type::min();
  for (const std::string& path : looks_of(folder, settings)) look = std::max(look, time_of(path));
  return static_cast<int>(std::ranges::count_if(frames, [&](int frame) {
    const std::string data = numbered(folder.data(), frame, "--output");
    const fs::file_time_type picture = time_of(picture_of(folder, frame));
    return picture > fs::file_time_type::min() && picture >= std::max(look, time_of(data));
  }));
}

void note_pictures(const Folder& folder, const Settings& settings) {
  write_text(folder.cluster("pictures.request"), request_for(folder, settings));
}

bool are_noted(const Folder& folder, const Settings& settings) {
  return read_text(folder.cluster("pictures.request")) == request_for(folder, settings);
}

bool pictures_are_there(const Folder& folder, const Settings& settings, const std::vector<int>& frames) {
  if (!are_noted(folder, settings)) return false;
  if (count_pictures(folder, settings, frames) < static_cast<int>(frames.size())) return false;
  return settings.movie.empty() || std::ranges::all_of(frames, [&](int frame) {
           return time_of(movie_of(folder, settings)) >= time_of(picture_of(folder, frame));
         });
}

std::vector<std::string> picture_command(const Folder& folder, const Settings& settings) {
  std::vector<std::string> out = {program_folder() + "/nullcone-postrender",
                                  folder.data(),
                                  "-o",
                                  folder.pictures(),
                                  "--quiet",
                                  "--threads",
                                  std::to_string(settings.threads)};
  for (const std::string& look : looks_of(folder, settings)) out.insert(out.end(), {"--look", look});
  return out;
}

std::vector<std::string> movie_options(const Folder& folder, const Settings& settings) {
  if (settings.movie.empty()) return {};
  std::ostringstream fps;
  fps << settings.fps;
  return {"--movie", movie_of(folder, settings), "--fps", fps.str()};
}

}  // namespace nullcone::cluster
