#include <array>

#include "postrender/kernel.h"

namespace nullcone::postrender {

extern const Kernel kernel_sse2;

#ifdef NULLCONE_ALL_ISAS
extern const Kernel kernel_avx2;

std::span<const Kernel* const> kernels() {
  static constexpr std::array<const Kernel*, 2> kAll = {&kernel_avx2, &kernel_sse2};
  const bool wide = __builtin_cpu_supports("avx2") && __builtin_cpu_supports("fma") &&
                    __builtin_cpu_supports("bmi2") && __builtin_cpu_supports("f16c");
  return std::span(kAll).subspan(wide ? 0 : 1);
}
#else
std::span<const Kernel* const> kernels() {
  static constexpr std::array<const Kernel*, 1> kAll = {&kernel_sse2};
  return kAll;
}
#endif

}  // namespace nullcone::postrender
