#include "core/scene/read_camera.h"

#include <cmath>
#include <numbers>
#include <string>

#include "core/scene/read_placing.h"

namespace nullcone {

namespace {

constexpr double kRadians = std::numbers::pi / 180;
constexpr long kMostPixels = 1L << 28;

/// The frame of the camera: azimuth from e1 towards e2, elevation towards e3, then roll about the look
/// direction.
void orient(Camera& camera, double azimuth, double elevation, double roll) {
  const double ca = std::cos(azimuth), sa = std::sin(azimuth), ce = std::cos(elevation),
               se = std::sin(elevation);
  camera.forward = {ce * ca, ce * sa, se};
  const Triple left = {-sa, ca, 0}, up = cross(camera.forward, left);
  const double cr = std::cos(roll), sr = std::sin(roll);
  for (std::size_t i = 0; i < 3; ++i) {
    camera.left[i] = cr * left[i] + sr * up[i];
    camera.up[i] = cr * up[i] - sr * left[i];
  }
}

/// The same by directions: `up` as near as can be to the one given.
void orient_along(Camera& camera, JsonObject& in) {
  for (const char* key : {"azimuth_deg", "elevation_deg", "roll_deg"})
    if (in.has(key)) in.refuse(key, "stands beside forward or up; expected either angles or directions");
  if (!in.has("forward")) in.refuse("up", "expected forward beside it");
  camera.forward = read_direction(in, "forward", {1, 0, 0});
  const Triple wish = read_direction(in, "up", {0, 0, 1});
  camera.left = cross(wish, camera.forward);
  const double length = std::hypot(camera.left[0], camera.left[1], camera.left[2]);
  if (!(length > 1e-9))
    in.refuse(in.has("up") ? "up" : "forward", in.has("up")
                                                   ? "expected a direction that is not parallel to forward"
                                                   : "is parallel to [0, 0, 1]; expected up beside it");
  for (double& component : camera.left) component /= length;
  camera.up = cross(camera.forward, camera.left);
}

void read_orientation(JsonObject& in, Camera& camera) {
  if (in.has("forward") || in.has("up")) return orient_along(camera, in);
  orient(camera, in.number_or("azimuth_deg", 0, -1e6, 1e6) * kRadians,
         in.number_or("elevation_deg", 0, -90, 90) * kRadians,
         in.number_or("roll_deg", 0, -1e6, 1e6) * kRadians);
}

void read_resolution(JsonObject& in, Camera& camera) {
  const auto resolution = in.numbers("resolution", 2, 1, kMostPixels);
  if (resolution[0] != std::floor(resolution[0]) || resolution[1] != std::floor(resolution[1]))
    in.refuse("resolution", "expected two whole numbers, width and height in pixels");
  if (resolution[0] * resolution[1] > static_cast<double>(kMostPixels))
    in.refuse("resolution", "asks for more than 268435456 pixels");
  camera.width = static_cast<int>(resolution[0]);
  camera.height = static_cast<int>(resolution[1]);
  const int cells = camera.type == CameraType::cube_map ? 6 : 2;
  if ((camera.type == CameraType::cube_map || camera.type == CameraType::tetrahedron_map) &&
      camera.width != cells * camera.height)
    in.refuse("resolution", "expected a width of " + std::to_string(cells) + " times the height");
}

void read_projection(JsonObject& in, Camera& camera, bool whole_sphere) {
  if (has_film(camera)) {  // square pixels
    camera.extent_horizontal = in.number("extent", 1e-9, 1e15);
    camera.extent_vertical = camera.extent_horizontal * camera.height / camera.width;
  } else if (whole_sphere) {
    camera.fov_horizontal = 2 * std::numbers::pi;
    camera.fov_vertical = std::numbers::pi;
  } else if (camera.type == CameraType::panorama) {
    const auto fov = in.numbers("fov_deg", 2, 1e-9, 360);
    if (fov[1] > 180) in.refuse("fov_deg/1", "expected a vertical field of view of at most 180");
    camera.fov_horizontal = fov[0] * kRadians;
    camera.fov_vertical = fov[1] * kRadians;
  } else if (camera.type == CameraType::fisheye) {
    camera.fov_horizontal = camera.fov_vertical = in.number("fov_deg", 1e-9, 360) * kRadians;
  } else {  // square pixels: the vertical field of view follows
    camera.fov_horizontal = in.number("fov_deg", 1e-9, 179.9) * kRadians;
    camera.fov_vertical = 2 * std::atan(std::tan(0.5 * camera.fov_horizontal) * camera.height / camera.width);
  }
}

}  // namespace

Camera read_camera(JsonObject camera) {
  Camera out;
  std::vector<std::string> names(kCameraNames.begin(), kCameraNames.end());
  names.emplace_back("sphere");  // a panorama of all directions
  const std::string name = camera.word("type", names);
  const auto type = std::find(kCameraNames.begin(), kCameraNames.end(), name);
  if (type != kCameraNames.end()) out.type = static_cast<CameraType>(type - kCameraNames.begin());
  read_resolution(camera, out);
  read_projection(
      camera, out,
      name == "sphere" || out.type == CameraType::cube_map || out.type == CameraType::tetrahedron_map);
  out.samples = camera.has("samples") ? static_cast<int>(camera.integer("samples", 1, 16)) : 1;
  if (static_cast<double>(out.width) * out.height * out.samples * out.samples >
      static_cast<double>(kMostPixels))
    camera.refuse("samples", "asks for more than 268435456 rays");
  read_orientation(camera, out);
  camera.finish();
  return out;
}

}  // namespace nullcone
