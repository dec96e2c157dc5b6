// Kernel code is compiled once for each instruction set. Everything that a kernel sees stands in
// `namespace nullcone::NULLCONE_ISA { namespace { … } }`, so that no two copies can be merged by the linker.
// Ordinary code (tests, cold tools) gets the copy named `host`: one lane or SSE2, the baseline of x86-64.
#pragma once

#ifndef NULLCONE_ISA
#define NULLCONE_ISA host
#define NULLCONE_ARCH sse2
#endif

// clang-format off
#define NULLCONE_KERNEL_BEGIN namespace nullcone::NULLCONE_ISA { namespace {
#define NULLCONE_KERNEL_END } }
// clang-format on

/// For small functions in the innermost loops, and for formulas of which a caller needs only a part: the
/// compiler's own limits would leave calls that carry packs through memory.
#define NULLCONE_INLINE __attribute__((always_inline)) inline

namespace nullcone::NULLCONE_ISA {}
