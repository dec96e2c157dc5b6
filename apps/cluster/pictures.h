// Pictures and a movie of the frames that are there.
#pragma once

#include <vector>

#include "apps/cluster/folder.h"
#include "apps/cluster/settings.h"

namespace nullcone::cluster {

/// How many frames have a picture that is newer than their dataset and all looks.
int count_pictures(const Folder& folder, const Settings& settings, const std::vector<int>& frames);

/// Writes down, and tells, that these pictures are asked for: by their looks, and all else.
void note_pictures(const Folder& folder, const Settings& settings);
bool are_noted(const Folder& folder, const Settings& settings);

/// Whether all frames have one that was made as is asked for, and the movie is newer than these.
bool pictures_are_there(const Folder& folder, const Settings& settings, const std::vector<int>& frames);

/// The command that makes pictures, but for "--frames LIST".
std::vector<std::string> picture_command(const Folder& folder, const Settings& settings);
/// What it takes besides to make the movie; nothing if none is asked for.
std::vector<std::string> movie_options(const Folder& folder, const Settings& settings);

}  // namespace nullcone::cluster
