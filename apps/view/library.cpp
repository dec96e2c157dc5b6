#include "apps/view/library.h"

#include <algorithm>
#include <filesystem>
#include <set>

#include "apps/view/thin.h"
#include "core/record/dataset_file.h"
#include "core/record/memory.h"

namespace nullcone::view {

namespace {

std::size_t size_of(const Dataset& dataset) {
  std::size_t out = dataset.hits.offset.size() * sizeof(std::uint64_t);
  for_each_channel(
      [&](const ChannelInfo&, const auto& column) { out += column.size() * sizeof(column.front()); },
      dataset.hits);
  return out + dataset.rays.status.size() * 16;
}

/// The last run of digits in a file's name, or -1.
int number_in(const std::string& path) {
  const std::string name = std::filesystem::path(path).stem().string();
  const std::size_t last = name.find_last_of("0123456789");
  if (last == name.npos) return -1;
  const std::size_t before = name.find_last_not_of("0123456789", last);
  const std::string digits = name.substr(before == name.npos ? 0 : before + 1, last - before);
  return digits.size() > 9 ? -1 : std::stoi(digits);
}

/// Files are frames by the numbers in their names where these tell all of them apart, else in their order.
std::vector<int> frames_of(const std::vector<std::string>& paths) {
  std::vector<int> out(paths.size());
  std::ranges::transform(paths, out.begin(), number_in);
  const std::set<int> different(out.begin(), out.end());
  const bool told_apart = paths.size() > 1 && different.size() == paths.size() && *different.begin() >= 0;
  for (std::size_t i = 0; !told_apart && i < out.size(); ++i) out[i] = static_cast<int>(i);
  return out;
}

}  // namespace

Loaded::Loaded(Dataset dataset, std::shared_ptr<postrender::TextureCache> textures)
    : records_(dataset.manifest.samples > 1 ? std::make_unique<const Dataset>(dataset) : nullptr),
      textures_(std::move(textures)),
      renderer_(std::move(dataset), *postrender::kernels().front(), textures_),
      bytes_(size_of(records()) * (records_ ? 2 : 1)) {}

const Dataset& Loaded::records(int scale) const {
  if (scale > 1) return shared_renderer(scale).dataset();
  return records_ ? *records_ : renderer_.dataset();
}

const postrender::Renderer& Loaded::shared_renderer(int scale) const {
  if (scale == 1) return renderer_;
  const std::scoped_lock lock(mutex_);
  auto& place = coarse_[scale == 2 ? 0 : 1];
  if (!place)
    place = std::make_unique<postrender::Renderer>(thin(records(), scale), *postrender::kernels().front(),
                                                   textures_);
  return *place;
}

postrender::Renderer Loaded::renderer(int scale) const { return shared_renderer(scale).sibling(); }

Library::Library(const std::vector<std::string>& paths, std::size_t most_bytes)
    : most_bytes_(most_bytes), shelves_(paths.size()) {
  const std::vector<int> frames = frames_of(paths);
  for (std::size_t i = 0; i < paths.size(); ++i)
    entries_.push_back({paths[i], frames[i], read_manifest(paths[i])});
}

std::shared_ptr<const Loaded> Library::get(std::size_t number) {
  Shelf& shelf = shelves_[number];
  const std::scoped_lock reading(shelf.reading);
  {
    const std::scoped_lock lock(mutex_);
    if (shelf.loaded) {
      recent_.remove(number);
      recent_.push_front(number);
      return shelf.loaded;
    }
  }
  auto loaded = std::make_shared<const Loaded>(read_dataset(entries_[number].path), textures_);
  const std::scoped_lock lock(mutex_);
  shelf.loaded = loaded;
  recent_.push_front(number);
  make_room();
  return loaded;
}

/// Forgets those that nobody has asked for longest, but never the latest.
void Library::make_room() {
  std::size_t bytes = 0;
  for (auto at = recent_.begin(); at != recent_.end();) {
    bytes += shelves_[*at].loaded->bytes();
    if (at == recent_.begin() || bytes <= most_bytes_) {
      ++at;
      continue;
    }
    shelves_[*at].loaded.reset();
    at = recent_.erase(at);
  }
}

}  // namespace nullcone::view
