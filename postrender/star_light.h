// The light of stars: each image of one a small round spot, whose sum over the pixels is exact.
#pragma once

#include <map>
#include <memory>
#include <mutex>
#include <span>
#include <string>
#include <utility>
#include <vector>

#include "postrender/kernel.h"
#include "postrender/look_stars.h"
#include "postrender/star_images.h"
#include "postrender/star_shading.h"

namespace nullcone::postrender {

/// Stars and where they are seen, as long as neither catalogue nor dataset change. Any number of threads may
/// use it.
class StarCache {
 public:
  /// Throws InputError as make_stars() does.
  std::shared_ptr<const StarField> field(const StarsLook& look);
  std::shared_ptr<const StarImages> images(const std::shared_ptr<const StarField>& field, std::uint32_t id,
                                           const Dataset& samples, const Manifest& picture);
  /// Forgets fields that nobody else holds, and their images.
  void prune();

 private:
  std::mutex mutex_;
  std::map<std::string, std::shared_ptr<const StarField>> fields_;
  std::map<std::pair<std::shared_ptr<const StarField>, std::uint32_t>, std::shared_ptr<const StarImages>>
      images_;
};

/// Adds the spots to `physical`, the pixels of the picture. `visible`: for each ray how much of the sky's
/// light comes through what stands before it, and how opaque the sky itself is.
void add_stars(const Kernel& kernel, const StarShading& stars, const StarImages& images,
               std::span<const float> visible, int width, std::vector<Rgbx>& physical);

}  // namespace nullcone::postrender
