// The renderer: a dataset in, a picture for every look out.
#pragma once

#include <optional>

#include "core/record/dataset.h"
#include "postrender/light_tables.h"
#include "postrender/look.h"
#include "postrender/shade.h"
#include "postrender/texture_cache.h"

namespace nullcone::postrender {

/// Holds a dataset and what depends on unchanged parts of the look: textures, and the shaded radiance when
/// only exposure, tone curve or gamut mapping change. One thread at a time may call it; inside it works on
/// all of them, and the pictures do not depend on how many there are.
class Renderer {
 public:
  /// Throws InputError when the columns do not fit the manifest (counts, objects' numbers, samples). Only the
  /// channels that the looks need must be there (needed_channels.h).
  explicit Renderer(Dataset dataset, const Kernel& kernel = *kernels().front());

  /// Of the picture.
  const Manifest& manifest() const { return manifest_; }
  /// What is shaded: its pixels are the samples of the picture.
  const Dataset& dataset() const { return dataset_; }

  /// Step 1 of a picture: textures read, spectra tabulated. Throws InputError for channels that the look
  /// needs and the dataset lacks, and for textures that cannot be read.
  Shading prepare(const Look& look);

  /// Throws InputError as prepare() does.
  Image render(const Look& look);

  /// The same for viewers: only the parts that are asked for, in the memory that `image` already has.
  void render(const Look& look, const ImageParts& parts, Image& image);

 private:
  std::size_t add_appearance(Shading& shading, const AppearanceLook& own, double opacity, std::uint32_t id,
                             const Look& look);

  void keep_radiance(const Shading& shading);
  void keep_filtered(const Shading& shading, const PixelFilter& filter);
  void develop_kept(const DevelopLook& look, Image& image) const;
  void shade_and_develop(const Shading& shading, const DevelopLook& look, Image& image) const;

  Manifest manifest_;
  Dataset dataset_;
  std::vector<std::uint8_t> one_each_;  ///< lines_with_one_each()
  std::vector<ShiftRange> shifts_;      ///< by object
  const Kernel& kernel_;
  LightTables lights_;
  TextureCache textures_;
  std::optional<Shading> shaded_;  ///< of the last picture
  PixelFilter filter_;             ///< of the last picture
  bool kept_ = false;              ///< whether radiance_ shows it
  Radiance radiance_;
};

}  // namespace nullcone::postrender
