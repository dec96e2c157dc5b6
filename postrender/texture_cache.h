// Textures that stay in memory from one look to the next.
#pragma once

#include <map>
#include <memory>
#include <mutex>
#include <string>
#include <tuple>

#include "postrender/texture.h"

namespace nullcone::postrender {

/// Time and size of a file; empty where it cannot be looked at: then reading it says why.
std::string file_stamp(const std::string& path);

/// Keeps textures by path (with and without their alpha, by materials), and reads a file again when its time
/// or size has changed. Any number of threads may use it.
class TextureCache {
 public:
  /// Throws InputError as read_texture() does.
  std::shared_ptr<const Pyramid> get(const std::string& path, const std::string& pointer, bool alpha,
                                     MaterialGroup materials = {});

  /// The same of a cube map; throws as read_cube_faces() does.
  std::shared_ptr<const Pyramid> get_cube(const std::vector<std::string>& files,
                                          const std::vector<std::string>& pointers);

  /// Forgets textures that nobody else holds, while they take more than `most_bytes` together.
  void prune(std::size_t most_bytes = std::size_t{1} << 30);

 private:
  struct Entry {
    std::string stamp;  ///< time and size of the file
    std::shared_ptr<const Pyramid> image;
  };
  std::mutex mutex_;  ///< held while a texture is read: who waits, mostly waits for the same one
  std::map<std::tuple<std::string, bool, MaterialGroup>, Entry> entries_;
};

}  // namespace nullcone::postrender
