#include "postrender/texture_cache.h"

#include <filesystem>

#include "postrender/cube_map.h"
#include "postrender/texture_file.h"

namespace nullcone::postrender {

std::string file_stamp(const std::string& path) {
  std::error_code error;
  const auto time = std::filesystem::last_write_time(path, error);
  if (error) return {};
  const auto size = std::filesystem::file_size(path, error);
  if (error) return {};
  return std::to_string(time.time_since_epoch().count()) + "/" + std::to_string(size);
}

std::shared_ptr<const Pyramid> TextureCache::get(const std::string& path, const std::string& pointer,
                                                 bool alpha, MaterialGroup materials) {
  const std::lock_guard lock(mutex_);
  const std::string stamp = file_stamp(path);
  if (const auto found = entries_.find({path, alpha, materials});
      found != entries_.end() && found->second.stamp == stamp && !stamp.empty())
    return found->second.image;
  auto image = std::make_shared<const Pyramid>(make_pyramid(
      materials.first < 0 ? read_texture(path, pointer, alpha) : read_materials(path, pointer, materials)));
  entries_[{path, alpha, materials}] = {stamp, image};
  return image;
}

std::shared_ptr<const Pyramid> TextureCache::get_cube(const std::vector<std::string>& files,
                                                      const std::vector<std::string>& pointers) {
  const std::lock_guard lock(mutex_);
  std::string name = "cube", stamp;  // no path of a single picture begins so: a line break follows
  bool known = true;
  for (const std::string& file : files) {
    const std::string one = file_stamp(file);
    known &= !one.empty();
    name += "\n" + file;
    stamp += one + "\n";
  }
  const std::tuple key(name, false, MaterialGroup{});
  if (const auto found = entries_.find(key); found != entries_.end() && found->second.stamp == stamp && known)
    return found->second.image;
  auto faces = std::make_shared<const Pyramid>(make_cube(read_cube_faces(files, pointers)));
  entries_[key] = {stamp, faces};
  return faces;
}

void TextureCache::prune(std::size_t most_bytes) {
  const std::lock_guard lock(mutex_);
  std::size_t sum = 0;
  for (const auto& [name, entry] : entries_) sum += entry.image->bytes();
  for (auto entry = entries_.begin(); entry != entries_.end() && sum > most_bytes;) {
    const bool unused = entry->second.image.use_count() == 1;
    if (unused) sum -= entry->second.image->bytes();
    entry = unused ? entries_.erase(entry) : std::next(entry);
  }
}

}  // namespace nullcone::postrender
