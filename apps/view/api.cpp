#include "apps/view/api.h"

#include <algorithm>

#include "apps/view/api_answers.h"
#include "apps/view/page_files.h"
#include "core/base/json.h"
#include "postrender/needed_channels.h"

namespace nullcone::view {

namespace pr = postrender;
using nlohmann::json;

namespace {

std::string_view page_type(std::string_view name) {
  if (name.ends_with(".html")) return "text/html; charset=utf-8";
  if (name.ends_with(".css")) return "text/css; charset=utf-8";
  if (name.ends_with(".svg")) return "image/svg+xml";
  return "text/javascript; charset=utf-8";
}

Answer page(std::string_view name) {
  const std::span<const PageFile> files = page_files();
  const auto file = std::ranges::find(files, name.empty() ? "index.html" : name, &PageFile::name);
  if (file == files.end()) return refusal(404, "no such page");
  return {200, std::string(page_type(file->name)), std::string(file->content)};
}

}  // namespace

Api::Api(const ApiOptions& options)
    : options_(options),
      library_(options.data, options.most_bytes),
      looks_(library_.entries().front().manifest, options.data.front(), options.look_file, options.settings,
             folder_),
      viewers_(options.most_viewers) {}

const std::vector<Api::RouteEntry>& Api::routes() {
  static const std::vector<RouteEntry> table = {
      {"GET", "state", &Api::state},      {"GET", "dataset", &Api::dataset},
      {"POST", "look", &Api::look},       {"POST", "frame", &Api::frame},
      {"POST", "pixel", &Api::pixel},     {"GET", "channel", &Api::channel},
      {"GET", "images", &Api::images},    {"GET", "histogram", &Api::histogram},
      {"POST", "texture", &Api::texture}, {"POST", "picture", &Api::picture},
      {"POST", "trace", &Api::trace},     {"POST", "dataset", &Api::save}};
  return table;
}

Answer Api::answer(const Request& request, std::string_view path) try {
  if (!path.starts_with("api/")) return page(path);
  const std::string_view name = path.substr(4);
  const auto by_name = [&](const RouteEntry& one) { return one.path == name; };
  if (std::ranges::none_of(routes(), by_name)) return refusal(404, "no such request");
  const auto route = std::ranges::find_if(
      routes(), [&](const RouteEntry& one) { return by_name(one) && one.method == request.head.method; });
  if (route == routes().end()) return refusal(405, "expected another method");
  Query query(request.head.target);
  return (this->*route->route)(request, query);
} catch (const Refused& error) {
  return refusal(error.status, error.message);
} catch (const InputError& error) {
  return refusal(400, looks_.told(error.what()));
}

Api::Subject Api::subject(Viewer& viewer, Query& query) {
  const std::string data = query.text("data", "0");
  const int frame = query.integer("frame", 0, 999'999'999, -1);
  if (data == "live") {
    if (!viewer.live) throw Refused{409, "nothing has been traced yet, or it is forgotten"};
    return {viewer.live, "live", std::max(frame, 0)};
  }
  const int last = static_cast<int>(library_.entries().size()) - 1;
  const auto number = static_cast<std::size_t>(query.integer("data", 0, last, 0));
  const LibraryEntry& entry = library_.entries()[number];
  return {library_.get(number), entry.path, frame < 0 ? entry.frame : frame};
}

Api::Held Api::hold(const Request& request, Query& query) {
  std::shared_ptr<Viewer> viewer = viewers_.get(request.head.viewer);
  std::unique_lock lock(viewer->mutex);
  Subject subject = this->subject(*viewer, query);
  return {std::move(viewer), std::move(lock), std::move(subject)};
}

pr::Look Api::look_of(const json& document, const Subject& subject) const {
  const Manifest& manifest = subject.loaded->manifest();
  pr::Look out = looks_.parse(document, manifest, subject.frame);
  pr::check_channels(out, manifest, manifest.channels, subject.name);
  return out;
}

}  // namespace nullcone::view
