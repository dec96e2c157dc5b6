#include "apps/view/api.h"

#include <algorithm>
#include <filesystem>
#include <fstream>
#include <nlohmann/json.hpp>

#include "apps/postrender_options.h"
#include "apps/view/channel_view.h"
#include "apps/view/encode.h"
#include "apps/view/histogram.h"
#include "apps/view/image_list.h"
#include "apps/view/inspect.h"
#include "apps/view/page_files.h"
#include "core/base/error.h"
#include "core/base/json.h"
#include "core/base/version.h"
#include "postrender/needed_channels.h"
#include "postrender/picture_file.h"

namespace nullcone::view {

namespace pr = postrender;
using nlohmann::json;
using nlohmann::ordered_json;

namespace {

/// Refused with a status of its own.
struct Refused {
  int status;
  std::string message;
};

template <class Json>
Answer answer_of(const Json& body) {
  return {200, "application/json", body.dump(-1, ' ', false, Json::error_handler_t::replace)};
}

/// One of so many at a time.
class Turn {
 public:
  Turn(std::atomic<int>& count, int most) : count_(count) {
    if (++count_ > most) {
      --count_;
      throw Refused{429, "others are tracing or saving; once more, please"};
    }
  }
  ~Turn() { --count_; }
  Turn(const Turn&) = delete;
  Turn& operator=(const Turn&) = delete;

 private:
  std::atomic<int>& count_;
};
constexpr int kMostHeavy = 2;

Format format_of(Query& query) {
  const std::string name = query.text("format", "raw");
  const std::optional<Format> format = find_format(name);
  if (!format) throw InputError("?format", "expected raw, jpeg, webp or png");
  return *format;
}

int scale_of(Query& query) {
  const int scale = query.integer("scale", 1, 4, 1);
  if (scale == 3) throw InputError("?scale", "expected 1, 2 or 4");
  return scale;
}

std::string milliseconds(double seconds) {
  std::array<char, 32> out{};
  std::snprintf(out.data(), out.size(), "%.2f", 1e3 * seconds);
  return out.data();
}

std::string size_text(int width, int height) { return std::to_string(width) + "x" + std::to_string(height); }

/// A file that was just written, as an answer; and the file is gone.
Answer sent_file(const std::string& path, const std::string& name, const std::string& type) {
  std::ifstream in(path, std::ios::binary);
  Answer out{200, type, std::string(std::istreambuf_iterator<char>(in), {})};
  std::filesystem::remove(path);
  if (!in) throw WorkError(path, "cannot be read");
  out.headers = {{"Content-Disposition", "attachment; filename=\"" + name + "\""}};
  return out;
}

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

/// Scene and look of a body for tracing.
struct SceneChanges {
  json scene, look;
  explicit SceneChanges(const std::string& body) {
    const json document = parse_json(body, "request");
    JsonObject in(document, "request", "");
    scene = in.has("scene") ? in.at("scene") : json::object();
    look = in.at("look");
    in.finish();
  }
};

}  // namespace

Api::Api(const ApiOptions& options)
    : options_(options),
      library_(options.data, options.most_bytes),
      looks_(library_.entries().front().manifest, options.data.front(), options.look_file, options.settings),
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

pr::Look Api::look_of(const json& document, const Subject& subject) const {
  const Manifest& manifest = subject.loaded->manifest();
  pr::Look out = looks_.parse(document, manifest, subject.frame);
  pr::check_channels(out, manifest, manifest.channels, subject.name);
  return out;
}

Answer Api::state(const Request&, Query& query) {
  query.finish();
  ordered_json datasets = ordered_json::array();
  for (const LibraryEntry& entry : library_.entries())
    datasets.push_back({{"name", std::filesystem::path(entry.path).filename().string()},
                        {"path", entry.path},
                        {"frame", entry.frame}});
  return answer_of(ordered_json{
      {"version", version()},
      {"datasets", datasets},
      {"look_file", options_.look_file.empty() ? ordered_json(nullptr) : ordered_json(options_.look_file)},
      {"settings", options_.settings},
      {"frames", options_.frames.empty() ? ordered_json(nullptr) : ordered_json(options_.frames)},
      {"limits", {{"upload_bytes", options_.most_upload}}},
      {"formats", {"raw", "jpeg", "webp", "png"}}});
}

Answer Api::dataset(const Request& request, Query& query) {
  const auto viewer = viewers_.get(request.head.viewer);
  const std::scoped_lock lock(viewer->mutex);
  const Subject subject = this->subject(*viewer, query);
  query.finish();
  const Manifest& m = subject.loaded->manifest();
  json scene = m.scene.empty() ? json::object() : parse_json(m.scene, subject.name);
  scene.erase("look");
  ordered_json objects = ordered_json::array(), lights = ordered_json::array();
  for (std::size_t i = 0; i < m.objects.size(); ++i)
    objects.push_back(
        {{"name", m.objects[i].name},
         {"shape",
          scene.value(json::json_pointer("/objects/" + std::to_string(i) + "/shape/type"), std::string())}});
  for (const ObjectEntry& lamp : m.lights) lights.push_back(lamp.name);
  const std::string hindrance = LiveScene::hindrance(m);
  return answer_of(ordered_json{{"name", std::filesystem::path(subject.name).filename().string()},
                                {"path", subject.name},
                                {"width", m.width},
                                {"height", m.lines},
                                {"first_line", m.first_line},
                                {"picture_height", m.height},
                                {"samples", m.samples},
                                {"metric", m.metric},
                                {"objects", objects},
                                {"lights", lights},
                                {"light_paths", m.light_paths},
                                {"channels", channel_list(m)},
                                {"look", looks_.first()},
                                {"scene", scene},
                                {"live", {{"possible", hindrance.empty()}, {"why", hindrance}}}});
}

Answer Api::look(const Request& request, Query& query) {
  const auto viewer = viewers_.get(request.head.viewer);
  const std::scoped_lock lock(viewer->mutex);
  const Subject subject = this->subject(*viewer, query);
  query.finish();
  const Manifest& manifest = subject.loaded->manifest();
  pr::LookInFull full;
  const pr::Look look = looks_.parse(parse_json(request.body, "look"), manifest, subject.frame, &full);
  pr::check_channels(look, manifest, manifest.channels, subject.name);
  return answer_of(
      json{{"full", json::parse(full.text)}, {"words", full.survey.words}, {"keys", full.survey.keys}});
}

/// Step by step the picture of a look, as the page wants it.
Answer Api::shown(Viewer& viewer, const Subject& subject, int scale, Query& query, const json& look,
                  double trace_seconds) {
  const Format format = format_of(query);
  query.finish();
  Stopwatch watch;
  std::vector<std::string> notes;
  const pr::Image& image = viewer.render(subject.loaded, scale, look_of(look, subject), notes);
  const double render_seconds = watch.lap();
  Answer out{200, std::string(content_type(format)),
             encode(format, image.width, image.height, image.encoded)};
  std::string times = trace_seconds > 0 ? "trace=" + milliseconds(trace_seconds) + ";" : "";
  times += "render=" + milliseconds(render_seconds) + ";encode=" + milliseconds(watch.lap());
  std::array<char, 32> white{};
  std::snprintf(white.data(), white.size(), "%.9g", image.white_cd_m2);
  if (notes.size() > 4) notes.resize(4);
  for (std::string& note : notes) note = printable(looks_.told(note), 400);
  out.headers = {{"X-Nullcone-Size", size_text(image.width, image.height)},
                 {"X-Nullcone-White", white.data()},
                 {"X-Nullcone-Times", times},
                 {"X-Nullcone-Notes", json(notes).dump(-1, ' ', true, json::error_handler_t::replace)}};
  return out;
}

Answer Api::frame(const Request& request, Query& query) {
  const auto viewer = viewers_.get(request.head.viewer);
  const std::scoped_lock lock(viewer->mutex);
  const Subject subject = this->subject(*viewer, query);
  const int scale = scale_of(query);
  return shown(*viewer, subject, scale, query, parse_json(request.body, "look"), 0);
}

Answer Api::pixel(const Request& request, Query& query) {
  const auto viewer = viewers_.get(request.head.viewer);
  const std::scoped_lock lock(viewer->mutex);
  const Subject subject = this->subject(*viewer, query);
  const int x = query.integer("x", 0, 1 << 30), y = query.integer("y", 0, 1 << 30);
  query.finish();
  return answer_of(
      inspect_pixel(subject.loaded->records(), look_of(parse_json(request.body, "look"), subject), x, y));
}

Answer Api::channel(const Request& request, Query& query) {
  const auto viewer = viewers_.get(request.head.viewer);
  const std::scoped_lock lock(viewer->mutex);
  const Subject subject = this->subject(*viewer, query);
  const std::string name = query.text("name");
  const Format format = format_of(query);
  const int scale = scale_of(query);
  const std::optional<double> from = query.number("from"), to = query.number("to");
  query.finish();
  if (from.has_value() != to.has_value()) throw InputError("?from", "expected both from and to, or neither");
  std::optional<std::pair<double, double>> range;
  if (from) range = {*from, *to};
  const ChannelView view = view_channel(subject.loaded->records(scale), name, range);
  Answer out{200, std::string(content_type(format)), encode(format, view.width, view.height, view.rgb)};
  out.headers = {
      {"X-Nullcone-Size", size_text(view.width, view.height)},
      {"X-Nullcone-Legend", view.legend.dump(-1, ' ', true, ordered_json::error_handler_t::replace)}};
  return out;
}

Answer Api::histogram(const Request& request, Query& query) {
  const auto viewer = viewers_.get(request.head.viewer);
  const std::scoped_lock lock(viewer->mutex);
  const Subject subject = this->subject(*viewer, query);
  const std::string object = query.text("object"), channel = query.text("channel", "t");
  const int bins = query.integer("bins", 1, 1024, 128);
  query.finish();
  return answer_of(emission_histogram(subject.loaded->records(), object, channel, bins));
}

Answer Api::images(const Request& request, Query& query) {
  const auto viewer = viewers_.get(request.head.viewer);
  const std::scoped_lock lock(viewer->mutex);
  const Subject subject = this->subject(*viewer, query);
  const std::string object = query.text("object");
  query.finish();
  return answer_of(images_of(subject.loaded->records(), object));
}

Answer Api::texture(const Request& request, Query& query) {
  const std::string name = query.text("name");
  query.finish();
  const Looks::Texture texture = looks_.add_texture(name, request.body);
  return answer_of(
      ordered_json{{"file", texture.name}, {"width", texture.width}, {"height", texture.height}});
}

Answer Api::picture(const Request& request, Query& query) {
  const Turn turn(heavy_, kMostHeavy);
  const auto viewer = viewers_.get(request.head.viewer);
  std::unique_lock lock(viewer->mutex);
  const Subject subject = this->subject(*viewer, query);
  lock.unlock();
  const std::string format = query.text("format", "png");
  const int bits = query.integer("bits", 0, 32, 0);
  query.finish();
  const std::vector<std::string> kinds = {"png", "jpg", "tif", "exr"};
  if (std::ranges::count(kinds, format) == 0) throw InputError("?format", "expected png, jpg, tif or exr");
  const std::string name = "picture." + format, path = folder_.file(std::to_string(serial_++) + "." + format);
  pr::check_picture_name(path, bits);
  const pr::Look look = look_of(parse_json(request.body, "look"), subject);
  pr::check_output(path, bits, look.develop.output);
  pr::Renderer renderer = subject.loaded->renderer(1);
  PictureMaker maker(path, bits);
  pr::write_picture(path, maker.make(renderer, {look}), bits);
  return sent_file(path, name, "application/octet-stream");
}

Answer Api::trace(const Request& request, Query& query) {
  const auto viewer = viewers_.get(request.head.viewer);
  const std::scoped_lock lock(viewer->mutex);
  const int last = static_cast<int>(library_.entries().size()) - 1;
  const int data = query.integer("data", 0, last, 0), scale = scale_of(query);
  const LibraryEntry& entry = library_.entries()[static_cast<std::size_t>(data)];
  const int frame = query.integer("frame", 0, 999'999'999, entry.frame);
  const SceneChanges changes(request.body);
  Stopwatch watch;
  auto scene = viewer->scenes.find(data);
  if (scene == viewer->scenes.end()) scene = viewer->scenes.emplace(data, LiveScene(entry.manifest)).first;
  viewer->live =
      std::make_shared<const Loaded>(scene->second.trace(changes.scene, scale), library_.textures());
  return shown(*viewer, {viewer->live, "live", frame}, 1, query, changes.look, watch.lap());
}

Answer Api::save(const Request& request, Query& query) {
  const Turn turn(heavy_, kMostHeavy);
  const int last = static_cast<int>(library_.entries().size()) - 1;
  const auto number = static_cast<std::size_t>(query.integer("data", 0, last, 0));
  query.finish();
  const LibraryEntry& entry = library_.entries()[number];
  const SceneChanges changes(request.body);
  looks_.parse(changes.look, entry.manifest, entry.frame);  // only what can be read again is kept
  const std::string path = folder_.file(std::to_string(serial_++) + ".exr");
  LiveScene(entry.manifest).save(changes.scene, changes.look, path);
  return sent_file(path, "dataset.exr", "image/x-exr");
}

}  // namespace nullcone::view
