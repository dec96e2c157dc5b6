#include "postrender/sky_mesh.h"

#include <algorithm>
#include <nlohmann/json.hpp>

namespace nullcone::postrender {

namespace {

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
  return out;
}

/// All in one direction, that of their mean.
void join(std::vector<SkyVertex>& row) {
  if (!std::ranges::all_of(row, &SkyVertex::on_sky)) return;
  Direction mean{};
  for (const SkyVertex& vertex : row)
    for (std::size_t i = 0; i < 3; ++i) mean[i] += vertex.direction[i];
  const double length = std::hypot(mean[0], mean[1], mean[2]);
  for (SkyVertex& vertex : row)
    for (std::size_t i = 0; i < 3; ++i) vertex.direction[i] = mean[i] / length;
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
      out_{0.5, 0.5 + beyond * picture.samples} {
  // Step 1: columns, in pieces that are continuous.
  const std::optional<Camera> camera = camera_of(picture);
  const int width = samples.manifest.width, lines = samples.manifest.lines;
  wraps_ = camera && (is_round_panorama(*camera) || camera->type == CameraType::tetrahedron_map);
  const bool poles =
      camera && is_round_panorama(*camera) && camera->fov_vertical > std::numbers::pi * (1 - 1e-9);
  in_pole_ = {poles && picture.first_line == 0,
              poles && picture.first_line + picture.lines == picture.height};
  if (wraps_) {
    for (int i = 0; i <= width; ++i)
      columns_.push_back({(i + 0.5) / per_pixel_, i % width, 0, 0, 0, i < width, 0, picture.width});
  } else {
    const int faces = camera && camera->type == CameraType::cube_map && width % 6 == 0 ? 6 : 1;
    for (int face = 0; face < faces; ++face)
      add_columns(face * (width / faces), (face + 1) * (width / faces), beyond);
  }
  // Step 2: rows; the outer ones go beyond the picture.
  const double height = static_cast<double>(lines) / per_pixel_;
  y_ = {-beyond, 0};
  for (int j = 0; j < lines; ++j) y_.push_back((j + 0.5) / per_pixel_);
  y_.insert(y_.end(), {height, height + beyond});
}

void SkyMesh::add_columns(int first, int last, double beyond) {
  const std::int32_t left = first / per_pixel_, right = last / per_pixel_;
  const int next = std::min(first + 1, last - 1), before = std::max(last - 2, first);
  columns_.push_back({left - beyond, -1, first, next, out_[1], true, left, right});
  columns_.push_back({static_cast<double>(left), -1, first, next, out_[0], true, left, right});
  for (int i = first; i < last; ++i)
    columns_.push_back({(i + 0.5) / per_pixel_, i, 0, 0, 0, true, left, right});
  columns_.push_back({static_cast<double>(right), -1, last - 1, before, out_[0], true, left, right});
  columns_.push_back({right + beyond, -1, last - 1, before, out_[1], false, left, right});
}

SkyVertex SkyMesh::vertex_of(std::uint32_t ray) const {
  const Hits& hits = samples_.hits;
  SkyVertex out{{}, 1, ray, false};
  for (std::size_t hit = hits.offset[ray]; hit < hits.offset[ray + std::size_t{1}]; ++hit) {
    if (hits.id[hit] != id_) continue;
    const auto u = static_cast<double>(hits.u[hit]), v = static_cast<double>(hits.v[hit]);
    out.on_sky = u >= 0 && u <= 1 && v >= 0 && v <= 1;
    if (!out.on_sky) return out;
    const double longitude = 2 * std::numbers::pi * (u - 0.5), latitude = std::numbers::pi * (v - 0.5),
                 low = std::cos(latitude);
    out.direction = {low * std::cos(longitude), low * std::sin(longitude), std::sin(latitude)};
    if (!hits.shift.empty()) out.shift = hits.shift[hit];
  }
  return out;
}

void SkyMesh::read_rays(int row, std::vector<SkyVertex>& out) const {
  out.resize(columns_.size());
  const auto width = static_cast<std::size_t>(samples_.manifest.width);
  const auto at = [&](int column) {
    return vertex_of(
        static_cast<std::uint32_t>(static_cast<std::size_t>(row) * width + static_cast<std::size_t>(column)));
  };
  for (std::size_t i = 0; i < columns_.size(); ++i) {
    const Column& column = columns_[i];
    out[i] = column.ray >= 0 ? at(column.ray) : continued(at(column.first), at(column.second), column.steps);
  }
}

void SkyMesh::read_row(std::size_t row, std::vector<SkyVertex>& out) const {
  const int lines = samples_.manifest.lines, at = static_cast<int>(row) - static_cast<int>(kOuter);
  if (at >= 0 && at < lines) return read_rays(at, out);
  const bool above = at < 0;
  const int edge = above ? 0 : lines - 1, next = above ? std::min(1, lines - 1) : std::max(lines - 2, 0);
  std::vector<SkyVertex> inner;
  read_rays(edge, out);
  read_rays(next, inner);
  const bool border = row != 0 && row + 1 != rows();
  for (std::size_t i = 0; i < out.size(); ++i) out[i] = continued(out[i], inner[i], out_[border ? 0 : 1]);
  if (border && in_pole_[above ? 0 : 1]) join(out);
}

}  // namespace nullcone::postrender
