#include "postrender/sky_mesh.h"

#include <nlohmann/json.hpp>

namespace nullcone::postrender {

namespace {

void set_angles(SkyVertex& vertex) {
  const auto [x, y, z] = vertex.direction;
  vertex.latitude = std::asin(std::clamp(z, -1.0, 1.0));
  vertex.longitude = std::atan2(y, x);
}

/// The map goes on as it came from `b` to `a`, by `steps` more.
SkyVertex continued(const SkyVertex& a, const SkyVertex& b, double steps) {
  SkyVertex out = a;
  out.on_sky = a.on_sky && b.on_sky;
  if (!out.on_sky) return out;
  double square = 0;
  for (std::size_t i = 0; i < 3; ++i) {
    out.direction[i] = a.direction[i] + steps * (a.direction[i] - b.direction[i]);
    square += out.direction[i] * out.direction[i];
  }
  for (double& component : out.direction) component /= std::sqrt(square);
  set_angles(out);
  return out;
}

bool is_round_panorama(const Camera& camera) {
  return camera.type == CameraType::panorama && camera.fov_horizontal > 2 * std::numbers::pi * (1 - 1e-9);
}

}  // namespace

std::optional<Camera> camera_of(const Manifest& manifest) {
  if (manifest.setting.empty()) return {};
  const nlohmann::json setting = nlohmann::json::parse(manifest.setting, nullptr, false);
  const auto camera = setting.is_object() ? setting.find("camera") : setting.end();
  if (camera == setting.end() || !camera->is_object()) return {};
  const auto type = camera->find("type"), fov = camera->find("fov_rad");
  if (type == camera->end() || !type->is_string() || fov == camera->end() || !fov->is_array() ||
      fov->size() != 2 || !(*fov)[0].is_number() || !(*fov)[1].is_number())
    return {};
  const auto name = std::ranges::find(kCameraNames, type->get<std::string>());
  if (name == kCameraNames.end()) return {};
  Camera out;
  out.type = static_cast<CameraType>(name - kCameraNames.begin());
  out.width = manifest.width;
  out.height = manifest.height;
  out.fov_horizontal = (*fov)[0].get<double>();
  out.fov_vertical = (*fov)[1].get<double>();
  return out;
}

SkyMesh::SkyMesh(const Dataset& samples, const Manifest& picture, std::uint32_t id, double beyond)
    : samples_(samples),
      id_(id),
      per_pixel_(picture.samples),
      wraps_(false),
      beyond_(beyond * picture.samples + 0.5) {
  // Step 1: columns, in pieces that are continuous.
  const std::optional<Camera> camera = camera_of(picture);
  const int width = samples.manifest.width, lines = samples.manifest.lines;
  wraps_ = camera && (is_round_panorama(*camera) || camera->type == CameraType::tetrahedron_map);
  if (wraps_) {
    for (int i = 0; i <= width; ++i)
      columns_.push_back({(i + 0.5) / per_pixel_, i % width, 0, i < width, 0, picture.width});
  } else {
    const int faces = camera && camera->type == CameraType::cube_map && width % 6 == 0 ? 6 : 1;
    for (int face = 0; face < faces; ++face)
      add_columns(face * (width / faces), (face + 1) * (width / faces), beyond);
  }
  // Step 2: rows; the first and the last go beyond the picture.
  y_.push_back((0.5 - beyond_) / per_pixel_);
  for (int j = 0; j < lines; ++j) y_.push_back((j + 0.5) / per_pixel_);
  y_.push_back((lines - 0.5 + beyond_) / per_pixel_);
}

void SkyMesh::add_columns(int first, int last, double beyond) {
  const std::int32_t left = first / per_pixel_, right = last / per_pixel_;
  columns_.push_back({left - beyond, -1, 1, true, left, right});
  for (int i = first; i < last; ++i) columns_.push_back({(i + 0.5) / per_pixel_, i, 0, true, left, right});
  columns_.push_back({right + beyond, -1, -1, false, left, right});
}

SkyVertex SkyMesh::vertex_of(std::uint32_t ray) const {
  const Hits& hits = samples_.hits;
  SkyVertex out{{}, 0, 0, 1, ray, false};
  for (std::size_t hit = hits.offset[ray]; hit < hits.offset[ray + std::size_t{1}]; ++hit) {
    if (hits.id[hit] != id_) continue;
    const auto u = static_cast<double>(hits.u[hit]), v = static_cast<double>(hits.v[hit]);
    out.on_sky = u >= 0 && u <= 1 && v >= 0 && v <= 1;
    if (!out.on_sky) return out;
    out.longitude = 2 * std::numbers::pi * (u - 0.5);
    out.latitude = std::numbers::pi * (v - 0.5);
    const double low = std::cos(out.latitude);
    out.direction = {low * std::cos(out.longitude), low * std::sin(out.longitude), std::sin(out.latitude)};
    if (!hits.shift.empty()) out.shift = hits.shift[hit];
  }
  return out;
}

void SkyMesh::read_rays(int row, std::vector<SkyVertex>& out) const {
  out.resize(columns_.size());
  const auto width = static_cast<std::size_t>(samples_.manifest.width);
  for (std::size_t i = 0; i < columns_.size(); ++i)
    if (columns_[i].ray >= 0)
      out[i] = vertex_of(static_cast<std::uint32_t>(static_cast<std::size_t>(row) * width +
                                                    static_cast<std::size_t>(columns_[i].ray)));
  for (std::size_t i = 0; i < columns_.size(); ++i) {
    if (columns_[i].ray >= 0) continue;
    const auto at = [&](int steps) -> const SkyVertex& {
      return out[static_cast<std::size_t>(static_cast<int>(i) + steps * columns_[i].inwards)];
    };
    const bool alone = columns_[i].left + 1 == columns_[i].right && per_pixel_ == 1;
    out[i] = continued(at(1), at(alone ? 1 : 2), beyond_);
  }
}

void SkyMesh::read_row(std::size_t row, std::vector<SkyVertex>& out) const {
  const int lines = samples_.manifest.lines, ray_row = static_cast<int>(row) - 1;
  if (ray_row >= 0 && ray_row < lines) return read_rays(ray_row, out);
  const int edge = ray_row < 0 ? 0 : lines - 1, next = std::clamp(ray_row < 0 ? 1 : lines - 2, 0, lines - 1);
  std::vector<SkyVertex> inner;
  read_rays(edge, out);
  read_rays(next, inner);
  for (std::size_t i = 0; i < out.size(); ++i) out[i] = continued(out[i], inner[i], beyond_);
}

}  // namespace nullcone::postrender
