// The renderer: a dataset in, a picture for every look out.
#pragma once

#include <optional>

#include "core/record/dataset.h"
#include "postrender/look.h"
#include "postrender/shade.h"
#include "postrender/texture_cache.h"

namespace nullcone::postrender {

/// Holds a dataset and what depends on unchanged parts of the look: textures, and the shaded radiance when
/// only exposure, tone curve or gamut mapping change. One thread at a time may call it; inside it works on
/// all of them, and the pictures do not depend on how many there are.
class Renderer {
 public:
  /// Throws InputError when the columns do not fit the manifest (counts, objects' numbers).
  explicit Renderer(Dataset dataset);

  const Dataset& dataset() const { return dataset_; }

  /// Throws InputError for textures that cannot be read.
  Image render(const Look& look);

 private:
  Shading prepare(const Look& look);
  std::size_t add_appearance(Shading& shading, const AppearanceLook& look, Rgb fallback, Effects effects);

  Dataset dataset_;
  TextureCache textures_;
  std::optional<Shading> shaded_;  ///< what radiance_ shows
  Radiance radiance_;
};

}  // namespace nullcone::postrender
