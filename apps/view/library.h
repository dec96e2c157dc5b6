// The datasets that the user named: read when they are wanted, and kept while there is room.
#pragma once

#include <array>
#include <list>
#include <memory>
#include <mutex>
#include <string>
#include <vector>

#include "core/record/dataset.h"
#include "core/scene/mesh_shelf.h"
#include "postrender/renderer.h"

namespace nullcone::view {

/// A dataset in memory, and coarser copies of it.
class Loaded {
 public:
  Loaded(Dataset dataset, std::shared_ptr<postrender::TextureCache> textures);

  const Manifest& manifest() const { return renderer_.manifest(); }
  /// As it was read or traced: crossings by pixel, with the records of rays; or of every `scale`-th pixel.
  const Dataset& records(int scale = 1) const;
  std::size_t bytes() const { return bytes_; }
  /// A renderer of every `scale`-th pixel (1, 2 or 4), for one thread.
  postrender::Renderer renderer(int scale) const;

 private:
  const postrender::Renderer& shared_renderer(int scale) const;

  std::unique_ptr<const Dataset> records_;  ///< where pixels have samples, which renderers put apart
  std::shared_ptr<postrender::TextureCache> textures_;
  postrender::Renderer renderer_;
  std::size_t bytes_;
  mutable std::mutex mutex_;
  mutable std::array<std::unique_ptr<postrender::Renderer>, 2> coarse_;  ///< of scales 2 and 4
};

struct LibraryEntry {
  std::string path;
  int frame = 0;  ///< the number of its time
  Manifest manifest;
};

class Library {
 public:
  /// Reads all headers. Throws InputError.
  Library(const std::vector<std::string>& paths, std::size_t most_bytes);

  const std::vector<LibraryEntry>& entries() const { return entries_; }
  /// Reads it, unless it is there; whoever waits, waits for that one alone. Throws InputError.
  std::shared_ptr<const Loaded> get(std::size_t number);
  std::shared_ptr<postrender::TextureCache> textures() const { return textures_; }
  /// Of scenes that are traced again.
  MeshShelf* meshes() { return &meshes_; }

 private:
  struct Shelf {
    std::mutex reading;
    std::shared_ptr<const Loaded> loaded;
  };
  void make_room();

  std::vector<LibraryEntry> entries_;
  std::size_t most_bytes_;
  std::shared_ptr<postrender::TextureCache> textures_ = std::make_shared<postrender::TextureCache>();
  MeshShelf meshes_;
  std::mutex mutex_;               ///< of all below
  std::vector<Shelf> shelves_;     ///< by number
  std::list<std::size_t> recent_;  ///< those that are loaded, the latest first
};

}  // namespace nullcone::view
