// What a variant holds, in its own type.
#pragma once

#include <utility>
#include <variant>

#include "core/base/isa.h"

NULLCONE_KERNEL_BEGIN

template <std::size_t kIndex, class Result, class Variant, class F>
Result with_alternative(const Variant& object, F&& f) {
  if constexpr (kIndex + 1 < std::variant_size_v<Variant>) {
    if (object.index() != kIndex) return with_alternative<kIndex + 1, Result>(object, f);
  }
  return f(*std::get_if<kIndex>(&object));
}

/// Calls f with the object in its own type. (std::visit would bring code that instruction sets share.)
template <class F, class... Types>
decltype(auto) with_type(const std::variant<Types...>& object, F&& f) {
  using First = std::variant_alternative_t<0, std::variant<Types...>>;
  using Result = decltype(f(std::declval<const First&>()));
  return with_alternative<0, Result>(object, f);
}

NULLCONE_KERNEL_END
