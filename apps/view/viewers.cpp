#include "apps/view/viewers.h"

#include <algorithm>

namespace nullcone::view {

const postrender::Image& Viewer::render(const std::shared_ptr<const Loaded>& loaded, int scale,
                                        const postrender::Look& look, std::vector<std::string>& notes) {
  if (loaded != shown_) renderers_.clear();
  shown_ = loaded;
  auto at = renderers_.find(scale);
  if (at == renderers_.end()) at = renderers_.emplace(scale, loaded->renderer(scale)).first;
  const postrender::Image& image = maker_.make(at->second, {look});
  notes = at->second.notes();
  return image;
}

std::shared_ptr<Viewer> Viewers::get(const std::string& id) {
  const auto now = std::chrono::steady_clock::now();
  const std::scoped_lock lock(mutex_);
  Entry& entry = entries_[id];
  if (!entry.viewer) entry.viewer = std::make_shared<Viewer>();
  entry.last = now;
  if (entries_.size() > most_)
    entries_.erase(std::ranges::min_element(entries_, {}, [](const auto& one) { return one.second.last; }));
  return entries_[id].viewer;
}

}  // namespace nullcone::view
