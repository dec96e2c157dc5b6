// From what a look says of textures to textures at hand.
#pragma once

#include <memory>
#include <vector>

#include "core/record/dataset.h"
#include "postrender/look_texture.h"
#include "postrender/shade.h"
#include "postrender/texture_cache.h"

namespace nullcone::postrender {

/// All frames of the films of a look, in memory: 14 bytes a texel with the smaller copies and the borders of
/// tiles, so 150 frames of 1920 x 1080.
inline constexpr std::size_t kLargestFilmBytes = std::size_t{4} << 30;

/// Makes the textures of one look.
class TextureMaker {
 public:
  explicit TextureMaker(TextureCache& cache, std::size_t most_bytes = kLargestFilmBytes)
      : cache_(cache), most_bytes_(most_bytes) {}

  /// Of films no frame is read yet. Throws InputError as read_texture() does.
  Texture make(const TextureLook& look);

  /// Reads the frames that any crossing sees. Throws InputError as read_texture() does, and when they take
  /// more memory than there may be.
  void read_films(const Dataset& dataset, const Shading& shading);

 private:
  struct Film {
    std::shared_ptr<MovingTexture::Parts> parts;
    std::vector<ImageLook> looks;  ///< of the frames
    std::vector<char> seen;
  };
  void read_frames(Film& film);

  TextureCache& cache_;
  std::size_t most_bytes_;
  std::size_t bytes_ = 0;  ///< of frames
  std::vector<Film> films_;
};

}  // namespace nullcone::postrender
