// nullcone-postrender --show: one channel of a dataset in false colours, or as numbers.
#pragma once

#include "apps/postrender_options.h"

namespace nullcone {

/// Writes the picture of the channel `options.show`; only that channel is read. Returns the exit status;
/// throws InputError for a channel or range that there is not.
int show_channel(const PostrenderOptions& options);

}  // namespace nullcone
