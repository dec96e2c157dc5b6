#include <array>

#include "postrender/kernel.h"

namespace nullcone::postrender {

extern const Kernel kernel_sse2;

#ifdef NULLCONE_ALL_ISAS
extern const Kernel kernel_avx2, kernel_avx512;

std::span<const Kernel* const> kernels() {
  static constexpr std::array<const Kernel*, 3> kAll = {&kernel_avx512, &kernel_avx2, &kernel_sse2};
  const bool wide = __builtin_cpu_supports("avx2") && __builtin_cpu_supports("fma") &&
                    __builtin_cpu_supports("bmi2") && __builtin_cpu_supports("f16c");
  const bool widest = wide && __builtin_cpu_supports("avx512f") && __builtin_cpu_supports("avx512bw") &&
                      __builtin_cpu_supports("avx512cd") && __builtin_cpu_supports("avx512dq") &&
                      __builtin_cpu_supports("avx512vl");
  return std::span(kAll).subspan(widest ? 0 : wide ? 1 : 2);
}
#else
std::span<const Kernel* const> kernels() {
  static constexpr std::array<const Kernel*, 1> kAll = {&kernel_sse2};
  return kAll;
}
#endif

}  // namespace nullcone::postrender
