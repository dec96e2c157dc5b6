// The integrated side of one spacetime for one instruction set: a file of its own, so that it compiles beside
// kernel.cpp.
#include NULLCONE_METRIC_HEADER

#include "core/trace/integrated_geodesic.h"
#include "core/trace/integrated_tracer.h"
#include "core/trace/shoot_connections.h"
#include "metrics/make_metric.h"

namespace nullcone {

std::unique_ptr<Tracer> NULLCONE_PREPARE_INTEGRATED(std::span<const double> values, const Scene& scene,
                                                    Unfit& unfit) {
  using namespace NULLCONE_ISA;
  auto tracer =
      std::make_unique<IntegratedTracer<NULLCONE_METRIC>>(make_metric<NULLCONE_METRIC>(values), scene);
  if (!tracer->place_objects(scene, unfit)) return nullptr;
  return tracer;
}

std::vector<GeodesicPoint> NULLCONE_GEODESIC_INTEGRATED(std::span<const double> values, const Event& event,
                                                        const Event& k, std::span<const double> lambda,
                                                        const Accuracy& accuracy) {
  using namespace NULLCONE_ISA;
  return integrated_geodesic(make_metric<NULLCONE_METRIC>(values), Vec4<double>{event}, Vec4<double>{k},
                             lambda, accuracy);
}

ConnectionsReport NULLCONE_CONNECT_BY_SHOOTING(std::span<const double> values, const Event& event,
                                               const Triple& source, int windings) {
  using namespace NULLCONE_ISA;
  if constexpr (!HasConnections<NULLCONE_METRIC> && is_stationary<NULLCONE_METRIC>()) {
    const Accuracy accuracy{kReference.rtol};  // its address would be shared between instruction sets
    return shoot_connections(make_metric<NULLCONE_METRIC>(values), accuracy, Vec4<double>{event},
                             Vec3<double>{source}, windings);
  }
  return {{}, false};
}

}  // namespace nullcone
