// Meshes that were read, for all scenes that use them: frames of a sequence, a scene that is changed by hand.
#pragma once

#include <filesystem>
#include <functional>
#include <list>
#include <memory>
#include <mutex>
#include <string>
#include <vector>

#include "core/scene/mesh.h"
#include "core/scene/mesh_hashes.h"

namespace nullcone {

struct ReadMesh {
  std::shared_ptr<const Mesh> mesh;
  MeshHashes hashes;
  bool has_normals = false;  ///< in the file
};

/// For any number of threads: while one reads, the others wait.
class MeshShelf {
 public:
  /// Beyond so many triangles those go that nobody has asked for the longest; the latest stays.
  explicit MeshShelf(std::size_t most_triangles = std::size_t{1} << 22) : most_triangles_(most_triangles) {}

  /// What read() gives of a file (read in this `variant` of ways), unless it is here and its files have had
  /// their sizes and times since. What read() throws is passed on.
  ReadMesh get(const std::string& path, const std::string& variant, const std::function<ReadMesh()>& read);

 private:
  struct Stamp {
    std::string path;
    std::uintmax_t size = 0;
    std::filesystem::file_time_type time;

    /// Of what is not there all zero: reading it will tell.
    explicit Stamp(std::string of);
    bool holds() const;
  };
  struct Entry {
    std::string path, variant;
    std::vector<Stamp> stamps;  ///< of the file, and of those beside it that it was read from
    ReadMesh mesh;
  };
  void make_room();

  std::size_t most_triangles_;
  std::mutex mutex_;
  std::list<Entry> entries_;  ///< the latest first
};

}  // namespace nullcone
