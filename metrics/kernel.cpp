// One spacetime for one instruction set: compiled once for each pair, see CMakeLists.txt.
#include NULLCONE_METRIC_HEADER

#include "core/trace/closed_tracer.h"
#include "metrics/make_metric.h"

namespace nullcone {

// In integrated.cpp.
std::unique_ptr<Tracer> NULLCONE_PREPARE_INTEGRATED(std::span<const double> values, const Scene& scene,
                                                    Unfit& unfit);
std::vector<GeodesicPoint> NULLCONE_GEODESIC_INTEGRATED(std::span<const double> values, const Event& event,
                                                        const Event& k, std::span<const double> lambda,
                                                        const Accuracy& accuracy);
ConnectionsReport NULLCONE_CONNECT_BY_SHOOTING(std::span<const double> values, const Event& event,
                                               const Triple& source, int windings);

}  // namespace nullcone

NULLCONE_KERNEL_BEGIN

template <HasConnections M>
ConnectionsReport connections(const M& metric, const Event& event, const Triple& source, int windings) {
  LampLine<M> lamp{metric, true, {{event[0], source[0], source[1], source[2]}}, {}, {}};
  ConnectionsReport out;
  for (int branch = 0; branch < branches(metric, windings); ++branch) {
    const Connection<double> c = connect(metric, Vec4<double>{event}, lamp, branch);
    if (!c.found) continue;
    const ConnectionReport one = {c.lambda,           event[0] - c.emitted[0],
                                  spatial(c.past).c,  std::sqrt(std::fabs(c.det)),
                                  c.det < 0 ? -1 : 1, branch / branches(metric, 1)};
    // Nearly in order as they come. (std::sort would be code that kernels share.)
    std::size_t place = out.connections.size();
    out.connections.push_back(one);
    for (; place > 0 && one.lambda < out.connections[place - 1].lambda; --place)
      out.connections[place] = out.connections[place - 1];
    out.connections[place] = one;
  }
  return out;
}

template <Metric M>
class Kernel final : public Spacetime {
 public:
  std::string_view isa() const override { return NULLCONE_ISA_NAME; }
  MetricDescription description() const override {
    MetricDescription out{M::name, {}, skies_of<M>(), HasClosedPaths<M>, is_stationary<M>(), HasIsometry<M>};
    const M defaults;
    std::apply(
        [&](const auto&... p) {
          (out.parameters.push_back({p.name, defaults.*p.member, p.least, p.most, p.words}), ...);
        },
        M::parameters);
    return out;
  }
  double default_lookback(std::span<const double> values) const override {
    return NULLCONE_ISA::default_lookback(make_metric<M>(values));
  }

  std::array<Event, 4> static_tetrad(std::span<const double> values, const Event& event) const override {
    const auto tetrad = NULLCONE_ISA::static_tetrad(make_metric<M>(values), Vec4<double>{event});
    return {tetrad.e[0].c, tetrad.e[1].c, tetrad.e[2].c, tetrad.e[3].c};
  }
  std::array<Event, 4> observer_tetrad(std::span<const double> values, const Event& event,
                                       ObserverFrame frame) const override {
    const auto tetrad = NULLCONE_ISA::observer_tetrad(make_metric<M>(values), Vec4<double>{event}, frame);
    return {tetrad.e[0].c, tetrad.e[1].c, tetrad.e[2].c, tetrad.e[3].c};
  }
  CameraRayReport camera_ray(std::span<const double> values, const Camera& camera, const Observer& observer,
                             double x, double y) const override {
    const CameraRays<M> rays{camera, {make_metric<M>(values), observer}};
    const RayStart<double> ray = rays.start(x, y);
    return {ray.event.c, ray.past.c, has_film(camera) ? rays.from.frame_beside() : observer.frame};
  }
  Event connection(std::span<const double> values, const Event& event, const Event& u,
                   const Event& v) const override {
    return NULLCONE_ISA::connection(make_metric<M>(values), Vec4<double>{event}, Vec4<double>{u},
                                    Vec4<double>{v})
        .c;
  }
  std::array<Event, 4> metric(std::span<const double> values, const Event& event) const override {
    const auto g = make_metric<M>(values).g(Vec4<double>{event});
    return {g[0].c, g[1].c, g[2].c, g[3].c};
  }
  std::vector<GeodesicPoint> geodesic(std::span<const double> values, const Event& event, const Event& k,
                                      std::span<const double> lambda, const Accuracy* accuracy,
                                      ObserverFrame frame) const override {
    const M metric = make_metric<M>(values);
    if (accuracy || !HasClosedPaths<M>) {
      const auto tangent =
          NULLCONE_ISA::observer_tetrad(metric, Vec4<double>{event}, frame).to_chart(Vec4<double>{k});
      return NULLCONE_GEODESIC_INTEGRATED(values, event, tangent.c, lambda,
                                          accuracy ? *accuracy : Accuracy{});
    }
    std::vector<GeodesicPoint> out;
    if constexpr (HasClosedPaths<M>) {
      const auto path = metric.path(Vec4<double>{event}, Vec4<double>{k});
      for (const double l : lambda) {
        const auto P = path.at(l);
        out.push_back({l, P.event.c, P.tangent.c});
      }
    }
    return out;
  }

  ConnectionsReport connect(std::span<const double> values, const Event& event, const Triple& source,
                            int windings) const override {
    if constexpr (HasConnections<M>) return connections(make_metric<M>(values), event, source, windings);
    return NULLCONE_CONNECT_BY_SHOOTING(values, event, source, windings);
  }

  double walk(std::span<const double> values, const Event& event, const Event& k, double step,
              std::size_t count) const override {
    const M metric = make_metric<M>(values);
    const Vec4<Wide> start = convert<Wide>(Vec4<double>{event}), tangent = convert<Wide>(Vec4<double>{k});
    std::array<double, Lanes<Wide>::count> first{};
    for (std::size_t lane = 0; lane < first.size(); ++lane) first[lane] = static_cast<double>(lane) * step;
    Wide lambda = Lanes<Wide>::load(first.data()), sum(0.0);
    const auto go = [&](const auto& event_at) {
      for (std::size_t i = 0; i < count; i += first.size()) {
        const Vec4<Wide> x = event_at(lambda);
        sum = sum + ((x[0] + x[1]) + (x[2] + x[3]));
        lambda = lambda + Wide(step * static_cast<double>(first.size()));
      }
    };
    if constexpr (HasClosedPaths<M>) {
      const auto path = metric.path(start, tangent);
      go([&](const Wide& l) { return path.at(l).event; });
    } else {
      go([&](const Wide& l) { return rhs(metric, start + l * tangent, tangent).p; });
    }
    Lanes<Wide>::store(sum, first.data());
    double total = 0;
    for (const double lane : first) total += lane;
    return total;
  }

  std::vector<NamedValue> conserved(std::span<const double> values,
                                    const GeodesicPoint& point) const override {
    std::vector<NamedValue> out;
    const M metric = make_metric<M>(values);
    const Vec4<double> x{point.event}, k{point.tangent};
    if constexpr (requires { metric.conserved(x, k); })
      for (const auto& [name, value] : metric.conserved(x, k)) out.push_back({name, value});
    return out;
  }

  std::unique_ptr<Tracer> prepare(std::span<const double> values, const Scene& scene,
                                  Unfit& unfit) const override {
    if constexpr (HasClosedPaths<M>) {
      if (!scene.integrated) {
        auto tracer = std::make_unique<ClosedTracer<M>>(make_metric<M>(values), scene);
        if (!tracer->place_objects(scene, unfit)) return nullptr;
        return tracer;
      }
    }
    return NULLCONE_PREPARE_INTEGRATED(values, scene, unfit);
  }
};

NULLCONE_KERNEL_END

namespace nullcone {

const Spacetime& NULLCONE_FACTORY() {
  static const NULLCONE_ISA::Kernel<NULLCONE_ISA::NULLCONE_METRIC> kernel;
  return kernel;
}

}  // namespace nullcone
