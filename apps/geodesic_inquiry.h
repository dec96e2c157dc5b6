// What nullcone-geodesic is asked: some geodesics, and at which affine parameters.
#pragma once

#include "apps/geodesic_options.h"
#include "apps/geodesic_ray.h"

namespace nullcone {

/// A geodesic of a family, and its number within it.
struct Member {
  double parameter = 0;
  Ray ray;
};

/// The pixel that a ray belongs to, and what tracing recorded there.
struct TracedPixel {
  Scene scene;
  std::vector<int> pixel;
  RayRecord record;
  std::vector<HitRecord> hits;
  std::vector<double> tau_origins;  ///< an object
};

struct Inquiry {
  const Spacetime* spacetime;
  std::vector<double> parameters;
  std::string parameter_name;  ///< of a family's members; empty for a single ray
  std::vector<Member> members;
  std::vector<double> lambda;
  double plot_from, plot_to;  ///< the stretch that pictures show
  std::string title;
  std::optional<TracedPixel> traced;  ///< for the ray of a pixel

  bool integrated() const { return members[0].ray.accuracy.has_value(); }
};

/// --metric ... --event ... --direction ... --at, with --fan or --killing.
Inquiry inquire_by_numbers(const GeodesicOptions& options);

/// SCENE --pixel X,Y: traces the pixel; the ray is that of the camera, followed into the past.
Inquiry inquire_pixel(const GeodesicOptions& options);

}  // namespace nullcone
