#include "core/scene/mesh_shelf.h"

#include <algorithm>

namespace nullcone {

MeshShelf::Stamp::Stamp(std::string of) : path(std::move(of)) {
  std::error_code no_size, no_time;
  size = std::filesystem::file_size(path, no_size);
  time = std::filesystem::last_write_time(path, no_time);
  if (no_size || no_time) size = 0, time = {};
}

bool MeshShelf::Stamp::holds() const {
  const Stamp now(path);
  return now.size == size && now.time == time && size > 0;
}

ReadMesh MeshShelf::get(const std::string& path, const std::string& variant,
                        const std::function<ReadMesh()>& read) {
  const std::scoped_lock lock(mutex_);
  const auto found = std::ranges::find_if(
      entries_, [&](const Entry& entry) { return entry.path == path && entry.variant == variant; });
  if (found != entries_.end() && std::ranges::all_of(found->stamps, &Stamp::holds)) {
    entries_.splice(entries_.begin(), entries_, found);
    return found->mesh;
  }
  if (found != entries_.end()) entries_.erase(found);
  Entry entry{path, variant, {Stamp(path)}, read()};
  for (const auto& [name, hash] : entry.mesh.hashes.buffers)
    entry.stamps.emplace_back((std::filesystem::path(path).parent_path() / name).string());
  entries_.push_front(std::move(entry));
  make_room();
  return entries_.front().mesh;
}

void MeshShelf::make_room() {
  std::size_t triangles = 0;
  for (auto entry = entries_.begin(); entry != entries_.end();) {
    triangles += entry->mesh.mesh->triangles.size();
    const bool stays = entry == entries_.begin() || triangles <= most_triangles_;
    entry = stays ? std::next(entry) : entries_.erase(entry);
  }
}

}  // namespace nullcone
