// What the server keeps for each page that looks: renderers of what it looks at, and its traced scene.
#pragma once

#include <chrono>
#include <map>
#include <memory>
#include <mutex>
#include <string>

#include "apps/postrender_frame.h"
#include "apps/view/library.h"
#include "apps/view/live.h"

namespace nullcone::view {

/// For one thread at a time: hold `mutex`.
struct Viewer {
  std::mutex mutex;
  std::shared_ptr<const Loaded> live;  ///< what was traced last
  std::map<int, LiveScene> scenes;     ///< by number of the dataset they come from

  /// The picture of a look, 8 bit, encoded; with the notes about it. Keeps renderers of the last dataset.
  const postrender::Image& render(const std::shared_ptr<const Loaded>& loaded, int scale,
                                  const postrender::Look& look, std::vector<std::string>& notes);

 private:
  std::shared_ptr<const Loaded> shown_;
  std::map<int, postrender::Renderer> renderers_;  ///< of `shown_`, by scale
  PictureMaker maker_{"picture.png", 8};
};

class Viewers {
 public:
  explicit Viewers(std::size_t most) : most_(most) {}
  /// The viewer of that name; makes room for a new one by forgetting the one that was silent longest.
  std::shared_ptr<Viewer> get(const std::string& id);

 private:
  struct Entry {
    std::shared_ptr<Viewer> viewer;
    std::chrono::steady_clock::time_point last;
  };
  std::size_t most_;
  std::mutex mutex_;
  std::map<std::string, Entry> entries_;
};

}  // namespace nullcone::view
