// What other libraries order between threads, told to ThreadSanitizer, which does not see into them.
#pragma once

#if defined(__SANITIZE_THREAD__)
#include <sanitizer/tsan_interface.h>
#endif

namespace nullcone {

/// What this thread has done before comes before what others do after take_over() of the same token.
inline void hand_over([[maybe_unused]] void* token) {
#if defined(__SANITIZE_THREAD__)
  __tsan_release(token);
#endif
}
inline void take_over([[maybe_unused]] void* token) {
#if defined(__SANITIZE_THREAD__)
  __tsan_acquire(token);
#endif
}

/// Calls f; for libraries that copy what they call, unseen.
template <class F>
auto unwatched(const F& f) {
  return [&f](auto&&... arguments) __attribute__((no_sanitize("thread"))) {
    return f(static_cast<decltype(arguments)>(arguments)...);
  };
}

}  // namespace nullcone
