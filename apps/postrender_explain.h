// nullcone-postrender --explain, and the words that complete --set.
#pragma once

#include "apps/postrender_options.h"

namespace nullcone {

/// Prints the look of one frame in full, as JSON that gives the same picture. The exit status.
int explain_look(const PostrenderOptions& options);

/// Prints, one a line, what the last step of a path (or, after "=", the value) may be: a path that ends in
/// "." goes on, one that ends in "=" wants a value.
int complete_set(const PostrenderOptions& options);

}  // namespace nullcone
