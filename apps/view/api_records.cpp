// What the page may ask about datasets, looks and records.
#include <filesystem>

#include "apps/view/api.h"
#include "apps/view/api_answers.h"
#include "apps/view/channel_view.h"
#include "apps/view/histogram.h"
#include "apps/view/image_list.h"
#include "apps/view/inspect.h"
#include "core/base/json.h"
#include "core/base/version.h"
#include "postrender/needed_channels.h"

namespace nullcone::view {

namespace pr = postrender;
using nlohmann::json;
using nlohmann::ordered_json;

namespace {

constexpr int kMostPixels = 1 << 24;  ///< in a line or column

/// The pixel of `there` in a line that has the place of pixel i of `here`.
int scaled(int i, int here, int there) {
  return static_cast<int>(static_cast<std::int64_t>(i) * there / here);
}

}  // namespace

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
  const Held held = hold(request, query);
  const Subject& subject = held.subject;
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
  const bool traced_here = subject.loaded == held.viewer->live;
  const std::string hindrance = traced_here ? "" : LiveScene::hindrance(m, subject.name, library_.meshes());
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
  const Held held = hold(request, query);
  const Subject& subject = held.subject;
  query.finish();
  const Manifest& manifest = subject.loaded->manifest();
  pr::LookInFull full;
  const pr::Look look = looks_.parse(parse_json(request.body, "look"), manifest, subject.frame, &full);
  pr::check_channels(look, manifest, manifest.channels, subject.name);
  return answer_of(
      json{{"full", json::parse(full.text)}, {"words", full.survey.words}, {"keys", full.survey.keys}});
}

Answer Api::pixel(const Request& request, Query& query) {
  const Held held = hold(request, query);
  const Subject& subject = held.subject;
  const Manifest& m = subject.loaded->manifest();
  const int width = query.integer("width", 1, kMostPixels, m.width),
            height = query.integer("height", 1, kMostPixels, m.height);
  const int x = query.integer("x", 0, width - 1), y = query.integer("y", 0, height - 1);
  query.finish();
  ordered_json out =
      inspect_pixel(subject.loaded->records(), look_of(parse_json(request.body, "look"), subject),
                    scaled(x, width, m.width), scaled(y, height, m.height));
  out["pixel"] = {x, y};
  return answer_of(out);
}

Answer Api::channel(const Request& request, Query& query) {
  const Held held = hold(request, query);
  const Subject& subject = held.subject;
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
  const Held held = hold(request, query);
  const Subject& subject = held.subject;
  const std::string object = query.text("object"), channel = query.text("channel", "t");
  const int bins = query.integer("bins", 1, 1024, 128);
  query.finish();
  return answer_of(emission_histogram(subject.loaded->records(), object, channel, bins));
}

Answer Api::images(const Request& request, Query& query) {
  const Held held = hold(request, query);
  const Subject& subject = held.subject;
  const std::string object = query.text("object");
  query.finish();
  return answer_of(images_of(subject.loaded->records(), object));
}

}  // namespace nullcone::view
