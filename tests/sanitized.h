// Sanitizers slow everything down: tests that trace much do less of it then.
#pragma once

namespace nullcone::test {

#if defined(__SANITIZE_ADDRESS__) || defined(__SANITIZE_THREAD__)
inline constexpr bool kSanitized = true;
#else
inline constexpr bool kSanitized = false;
#endif

}  // namespace nullcone::test
