// Pictures, textures and traced scenes for the page.
#include <array>
#include <cstdio>
#include <filesystem>
#include <fstream>

#include "apps/postrender_options.h"
#include "apps/view/api.h"
#include "apps/view/api_answers.h"
#include "core/base/json.h"
#include "postrender/picture_file.h"

namespace nullcone::view {

namespace pr = postrender;
using nlohmann::json;
using nlohmann::ordered_json;

namespace {

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

std::string milliseconds(double seconds) {
  std::array<char, 32> out{};
  std::snprintf(out.data(), out.size(), "%.2f", 1e3 * seconds);
  return out.data();
}

/// A file that was just written, as an answer; and the file is gone.
Answer sent_file(const std::string& path, const std::string& name, const std::string& type) {
  std::ifstream in(path, std::ios::binary);
  Answer out{200, type, std::string(std::istreambuf_iterator<char>(in), {})};
  std::filesystem::remove(path);
  if (!in) throw WorkError(path, "cannot be read");
  out.headers = {{"Content-Disposition", "attachment; filename=\"" + name + "\""}};
  return out;
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

/// Step by step the picture of a look, as the page wants it.
Answer Api::shown(Viewer& viewer, const Subject& subject, int scale, Query& query, const json& look,
                  double trace_seconds) {
  const Format format = format_of(query);
  query.finish();
  Stopwatch watch;
  std::vector<std::string> notes;
  const pr::Image& image = viewer.render(subject.loaded, scale, look_of(look, subject), notes);
  const double render_seconds = watch.lap();
  Answer out{
      200, std::string(content_type(format)),
      encode(format, image.width, image.height, image.encoded, format == Format::raw ? buffers_.take() : "")};
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
  const Held held = hold(request, query);
  const int scale = scale_of(query);
  return shown(*held.viewer, held.subject, scale, query, parse_json(request.body, "look"), 0);
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
  if (scene == viewer->scenes.end())
    scene = viewer->scenes.emplace(data, LiveScene(entry.manifest, entry.path, library_.meshes())).first;
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
  LiveScene(entry.manifest, entry.path, library_.meshes()).save(changes.scene, changes.look, path);
  return sent_file(path, "dataset.exr", "image/x-exr");
}

}  // namespace nullcone::view
