#include "postrender/texture_cache.h"

#include <filesystem>

#include "postrender/texture_file.h"

namespace nullcone::postrender {

namespace {

/// Empty where the file cannot be looked at; then reading it says why.
std::string stamp_of(const std::string& path) {
  std::error_code error;
  const auto time = std::filesystem::last_write_time(path, error);
  if (error) return {};
  const auto size = std::filesystem::file_size(path, error);
  if (error) return {};
  return std::to_string(time.time_since_epoch().count()) + "/" + std::to_string(size);
}

}  // namespace

std::shared_ptr<const Pyramid> TextureCache::get(const std::string& path, const std::string& pointer,
                                                 bool alpha, MaterialGroup materials) {
  const std::lock_guard lock(mutex_);
  const std::string stamp = stamp_of(path);
  if (const auto found = entries_.find({path, alpha, materials});
      found != entries_.end() && found->second.stamp == stamp && !stamp.empty())
    return found->second.image;
  auto image = std::make_shared<const Pyramid>(make_pyramid(
      materials.first < 0 ? read_texture(path, pointer, alpha) : read_materials(path, pointer, materials)));
  entries_[{path, alpha, materials}] = {stamp, image};
  return image;
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
