// What the page may ask for: each request in docs/viewer.md is one function here.
#pragma once

#include <atomic>
#include <memory>
#include <mutex>
#include <string>
#include <vector>

#include "apps/view/buffers.h"
#include "apps/view/guard.h"
#include "apps/view/http_server.h"
#include "apps/view/library.h"
#include "apps/view/looks.h"
#include "apps/view/query.h"
#include "apps/view/viewers.h"

namespace nullcone::view {

struct ApiOptions {
  std::vector<std::string> data;  ///< files, as named
  std::string look_file;
  std::vector<std::string> settings;
  std::vector<int> frames;  ///< of a time line for one dataset: least and greatest; or none
  std::size_t most_bytes = 0, most_viewers = 8, most_upload = 0;
};

/// Answers requests; any number of threads may call it.
class Api {
 public:
  /// Throws InputError for datasets and looks that are wrong.
  explicit Api(const ApiOptions& options);

  /// `path` as Guard::path() has it.
  Answer answer(const Request& request, std::string_view path);
  /// Where bodies go that were sent.
  void reuse(std::string body) { buffers_.give(std::move(body)); }

 private:
  using Route = Answer (Api::*)(const Request&, Query&);
  struct RouteEntry {
    std::string_view method, path;
    Route route;
  };
  static const std::vector<RouteEntry>& routes();

  Answer state(const Request&, Query&);
  Answer dataset(const Request&, Query&);
  Answer look(const Request&, Query&);
  Answer frame(const Request&, Query&);
  Answer pixel(const Request&, Query&);
  Answer channel(const Request&, Query&);
  Answer histogram(const Request&, Query&);
  Answer images(const Request&, Query&);
  Answer texture(const Request&, Query&);
  Answer picture(const Request&, Query&);
  Answer trace(const Request&, Query&);
  Answer save(const Request&, Query&);

  /// What a request is about.
  struct Subject {
    std::shared_ptr<const Loaded> loaded;
    std::string name;  ///< for complaints
    int frame;
  };
  Subject subject(Viewer& viewer, Query& query);
  /// The viewer who asks, for this request alone, and what it is about.
  struct Held {
    std::shared_ptr<Viewer> viewer;
    std::unique_lock<std::mutex> lock;
    Subject subject;
  };
  Held hold(const Request& request, Query& query);
  postrender::Look look_of(const nlohmann::json& document, const Subject& subject) const;
  Answer shown(Viewer& viewer, const Subject& subject, int scale, Query& query, const nlohmann::json& look,
               double trace_seconds);

  ApiOptions options_;
  Library library_;
  TemporaryFolder folder_;
  Buffers buffers_;
  Looks looks_;
  Viewers viewers_;
  std::atomic<int> heavy_ = 0, serial_ = 0;
};

}  // namespace nullcone::view
