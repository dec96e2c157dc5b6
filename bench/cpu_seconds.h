// Processor time of this thread, for loops that are compiled once an instruction set.
#pragma once

#include <ctime>

#include "core/base/isa.h"

NULLCONE_KERNEL_BEGIN

inline double cpu_seconds() {
  timespec now;
  clock_gettime(CLOCK_THREAD_CPUTIME_ID, &now);
  return static_cast<double>(now.tv_sec) + 1e-9 * static_cast<double>(now.tv_nsec);
}

NULLCONE_KERNEL_END
