// A metric from its parameters' values, in their order.
#pragma once

#include <span>
#include <tuple>

#include "core/base/isa.h"

NULLCONE_KERNEL_BEGIN

template <class M>
M make_metric(std::span<const double> values) {
  M metric;
  [[maybe_unused]] std::size_t i = 0;
  std::apply([&](const auto&... parameter) { ((metric.*parameter.member = values[i++]), ...); },
             M::parameters);
  return metric;
}

NULLCONE_KERNEL_END
