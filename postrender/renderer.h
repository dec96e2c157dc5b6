// The renderer: a dataset in, a picture for every look out.
#pragma once

#include <memory>
#include <optional>
#include <span>

#include "core/record/dataset.h"
#include "postrender/light_tables.h"
#include "postrender/look.h"
#include "postrender/reflection.h"
#include "postrender/shade.h"
#include "postrender/shift_ranges.h"
#include "postrender/star_light.h"
#include "postrender/texture_cache.h"

namespace nullcone::postrender {

class TextureMaker;

/// How bright it is when, and its temperature; without opacity.
Emission emission_of(const AppearanceLook& look, const Effects& effects);

/// Holds a dataset and what depends on unchanged parts of the look: textures, where stars are seen, and the
/// shaded radiance when only exposure, tone curve or gamut mapping change. One thread at a time may call it;
/// inside it works on all of them, and the pictures do not depend on how many there are.
class Renderer {
 public:
  /// Throws InputError when the columns do not fit the manifest (counts, objects' numbers, samples). Only the
  /// channels that the looks need must be there (needed_channels.h).
  explicit Renderer(Dataset dataset, const Kernel& kernel = *kernels().front(),
                    std::shared_ptr<TextureCache> textures = std::make_shared<TextureCache>());
  /// Another renderer of the same dataset, for another thread. They share dataset, textures and stars.
  Renderer sibling() const { return Renderer(source_, kernel_, textures_, stars_); }

  /// Of the picture.
  const Manifest& manifest() const { return source_->manifest; }
  /// What is shaded: its pixels are the samples of the picture.
  const Dataset& dataset() const { return source_->dataset; }

  /// Step 1 of a picture: textures read, spectra tabulated. Throws InputError for channels that the look
  /// needs and the dataset lacks, and for textures that cannot be read.
  Shading prepare(const Look& look);

  /// Throws InputError as prepare() does.
  Image render(const Look& look);

  /// The same for viewers: only the parts that are asked for, in the memory that `image` already has.
  void render(const Look& look, const ImageParts& parts, Image& image);

  /// What users should know of the last picture, as spectra that are not known where they are seen.
  std::vector<std::string> notes() const { return shaded_ ? shaded_->notes : std::vector<std::string>{}; }

 private:
  /// What siblings share; it never changes.
  struct Source {
    Manifest manifest;
    Dataset dataset;
    std::vector<std::uint8_t> one_each;                  ///< lines_with_one_each()
    std::vector<ShiftRange> shifts;                      ///< by object
    std::vector<std::vector<LightShifts>> light_shifts;  ///< by object and lamp
  };
  static std::shared_ptr<const Source> make_source(Dataset dataset);
  Renderer(std::shared_ptr<const Source> source, const Kernel& kernel, std::shared_ptr<TextureCache> textures,
           std::shared_ptr<StarCache> stars);

  /// What lamps send out, by Shading::lamp_states, and which lamp each of them is.
  struct LampLight {
    LampSpectrum light;
    std::size_t lamp;
  };
  std::vector<LampLight> add_lamps(Shading& shading, const Look& look) const;
  void add_lamp_state(Shading& shading, std::vector<LampLight>& out, const AppearanceLook& own,
                      std::size_t lamp, const Effects& effects) const;
  void light_up(Appearance& out, const SpectrumLook& spectrum, std::span<const LampLight> lamps,
                std::uint32_t id, const Look& look);
  void note_light(Shading& shading, const Look& look, std::span<const LampLight> lamps) const;

  std::size_t add_appearance(Shading& shading, TextureMaker& textures, const AppearanceLook& own,
                             const ObjectLook& object, std::span<const LampLight> lamps, std::uint32_t id,
                             const Look& look);
  void add_materials(Appearance& out, TextureMaker& textures, const TextureLook& texture,
                     const SpectrumLook& materials, std::uint32_t id, const Look& look);
  void add_stars_of(Shading& shading, const ObjectLook& object, std::uint32_t id, const Look& look);
  void draw_stars(const Shading& shading);
  Light light_of(const SpectrumLook& spectrum, const Emission& emission, std::uint32_t id, const Look& look);

  void keep_radiance(const Shading& shading);
  void keep_filtered(const Shading& shading, const PixelFilter& filter);
  void develop_kept(const DevelopLook& look, Image& image) const;
  void shade_and_develop(const Shading& shading, const DevelopLook& look, Image& image);
  void decide_keeping(const Shading& shading);
  void begin_keeping();
  void end_keeping();
  KeptColors kept_colors(std::size_t row);

  std::shared_ptr<const Source> source_;
  const Manifest& manifest_;
  const Dataset& dataset_;
  std::span<const std::uint8_t> one_each_;
  std::span<const ShiftRange> shifts_;
  std::span<const std::vector<LightShifts>> light_shifts_;
  const Kernel& kernel_;
  LightTables lights_;
  ReflectionTables reflections_;
  std::shared_ptr<TextureCache> textures_;
  std::shared_ptr<StarCache> stars_;
  std::optional<Shading> shaded_;  ///< of the last picture
  PixelFilter filter_;             ///< of the last picture
  bool kept_ = false;              ///< whether radiance_ shows it
  Radiance radiance_;
  std::vector<float> visible_;  ///< by ray: how much of a sky with stars is seen; empty without stars
  /// Colours of textures, of first crossings.
  enum class Keeping { no, wanted, known } keeping_ = Keeping::no;
  std::vector<Rgbx> colors_;
};

}  // namespace nullcone::postrender
