#include "apps/trace_job.h"

#include <algorithm>
#include <charconv>
#include <filesystem>
#include <nlohmann/json.hpp>

#include "apps/preview.h"
#include "core/base/error.h"

namespace nullcone {

namespace {

bool read_whole(std::string_view text, int& out) {
  const auto end = text.data() + text.size();
  return std::from_chars(text.data(), end, out) == std::from_chars_result{end, std::errc{}};
}

/// The file of a mesh that is another, where scenes differ in nothing but that; else empty.
std::string other_mesh(const Manifest& a, const Manifest& b) {
  using nlohmann::json;
  json scene = json::parse(a.scene, nullptr, false), other = json::parse(b.scene, nullptr, false);
  if (!scene.is_object() || !other.is_object()) return {};
  scene.erase("look"), other.erase("look");
  std::string out;
  for (const json& step : json::diff(scene, other)) {
    const std::string path = step.at("path");
    const std::size_t entry = std::max(path.find("/shape/sha256") + 1, path.find("/shape/buffers") + 1);
    if (entry == 0) return {};
    const json::json_pointer file(path.substr(0, entry - 1) + "/shape/file");
    if (scene.contains(file) && scene.at(file).is_string()) out = scene.at(file).get<std::string>();
  }
  return out;
}

}  // namespace

void check_output_name(const std::string& path) {
  const bool fits = path.size() > 4 && path.ends_with(".exr");
  if (!fits) throw InputError(path, "expected a name that ends in .exr");
  if (std::filesystem::is_directory(path)) throw InputError(path, "is a folder; expected the name of a file");
  check_place(path);
}

Shard read_shard(const std::string& text) {
  const std::size_t slash = text.find('/');
  Shard out;
  if (slash == std::string::npos || !read_whole(std::string_view(text).substr(0, slash), out.number) ||
      !read_whole(std::string_view(text).substr(slash + 1), out.count) || out.count < 1 || out.number < 1 ||
      out.number > out.count)
    throw InputError("--shard", "expected i/n with i from 1 to n, found '" + printable(text, 40) + "'");
  return out;
}

Lines lines_of(const Shard& shard, int height) {
  const std::int64_t bands = (height + kBandLines - 1) / kBandLines;
  if (shard.count > bands)
    throw InputError("--shard", "the picture has " + std::to_string(bands) + " bands of " +
                                    std::to_string(kBandLines) +
                                    " scan lines; expected at most as many shards");
  const auto line = [&](std::int64_t n) { return static_cast<int>(kBandLines * (bands * n / shard.count)); };
  return {line(shard.number - 1), std::min(line(shard.number), height)};
}

std::string shard_path(const std::string& output, const Shard& shard) {
  return output.substr(0, output.size() - 4) + ".shard-" + std::to_string(shard.number) + "-of-" +
         std::to_string(shard.count) + ".exr";
}

std::string partial_path(const std::string& output) {
  return output.substr(0, output.size() - 4) + ".partial.exr";
}

std::string difference(const Manifest& a, const Manifest& b) {
  const auto other = [](const char* what, const auto& x, const auto& y) {
    return std::string("has another ") + what + ": " + printable(x, 80) + " instead of " + printable(y, 80);
  };
  if (const std::string mesh = a.scene_sha256 == b.scene_sha256 ? "" : other_mesh(a, b); !mesh.empty())
    return "was traced with another mesh file '" + printable(mesh) + "'";
  if (a.scene_sha256 != b.scene_sha256) return other("scene", a.scene_sha256, b.scene_sha256);
  if (a.version != b.version) return other("version", a.version, b.version);
  if (a.format != b.format) return other("format", std::to_string(a.format), std::to_string(b.format));
  if (a.setting != b.setting) return other("setting", a.setting, b.setting);
  if (a.width != b.width || a.height != b.height || a.samples != b.samples || a.channels != b.channels ||
      a.objects != b.objects || a.lights != b.lights || a.light_paths != b.light_paths)
    return "has another size, or other channels, objects or lamps, though the scene is the same";
  return {};
}

Traced trace_into(DatasetWriter& writer, const Tracer& tracer, const Scene& scene, int threads,
                  const Progress& progress, const StopFlag* stop) {
  Traced out;
  const Manifest& manifest = writer.manifest();
  const Lines lines = {manifest.first_line + writer.lines(), manifest.first_line + manifest.lines};
  out.effort.core_seconds = trace_bands(
      tracer, scene, lines, threads, progress,
      [&](const Band& band) {
        writer.add(band, make_preview(band.hits));
        out.hits += band.hits.count();
      },
      stop);
  out.effort.light_doubts = tracer.light_doubts();
  return out;
}

Manifest resume_from(const std::string& path, DatasetWriter& writer) {
  for (const std::string& fault : verify_file(path)) throw InputError(path, "cannot go on from it: " + fault);
  DatasetReader reader(path);
  const Manifest &found = reader.manifest(), &expected = writer.manifest();
  std::string fault = difference(found, expected);
  if (fault.empty() && (found.first_line != expected.first_line || found.lines != expected.lines))
    fault = "has another window";
  if (!fault.empty()) throw InputError(path, "cannot go on from it: it " + fault);
  for_each_band(found.traced_lines, [&](int first, int lines) {
    const Band band = reader.band(first, lines);
    writer.add(band, make_preview(band.hits));
  });
  return found;
}

}  // namespace nullcone
