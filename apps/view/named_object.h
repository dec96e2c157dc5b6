// Objects of a dataset by their names, as requests have them.
#pragma once

#include <cstdint>
#include <string>

#include "core/base/error.h"
#include "core/record/dataset.h"

namespace nullcone::view {

/// The number of the object in Hits::id. Throws InputError that lists what there is.
inline std::uint32_t number_of_object(const Manifest& manifest, const std::string& name) {
  std::string all;
  for (std::uint32_t i = 0; i < manifest.objects.size(); ++i) {
    if (manifest.objects[i].name == name) return i + 1;
    all += (i == 0 ? "" : ", ") + manifest.objects[i].name;
  }
  throw InputError("object", "there is no '" + printable(name, 40) + "'; expected " +
                                 (all.empty() ? "none: the dataset has no objects" : "one of " + all));
}

}  // namespace nullcone::view
