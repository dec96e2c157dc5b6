// nullcone-postrender --frames: many pictures, in parallel; those that are there already are skipped.
#pragma once

#include "apps/postrender_options.h"

namespace nullcone {

/// All frames, and the movie. Exit status 0, or 3 when SIGINT or SIGTERM stopped it; throws InputError and
/// WorkError. Names are checked before any work.
int render_sequence(const PostrenderOptions& options);

}  // namespace nullcone
