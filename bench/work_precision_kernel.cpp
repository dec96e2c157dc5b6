// The timed part of the study, compiled once an instruction set: the tracer's loop over rays, and the bare
// stepper.
#include "bench/cpu_seconds.h"
#include "bench/work_precision.h"
#include "core/trace/march.h"
#include "metrics/goedel_kernel.h"
#include "metrics/kerr_schild.h"
#include "metrics/minkowski_kernel.h"

NULLCONE_KERNEL_BEGIN

using namespace nullcone::study;

template <class F>
double fastest(int repeats, F&& f) {
  double best = __builtin_inf();
  for (int i = 0; i < repeats; ++i) {
    const double begin = cpu_seconds();
    f();
    best = std::min(best, cpu_seconds() - begin);
  }
  return best;
}

template <class F>
double with_metric(const Place& place, F&& f) {
  if (place.metric == MetricId::minkowski) return f(Minkowski{});
  if (place.metric == MetricId::goedel) return f(Goedel{place.parameter});
  KerrSchild hole;
  hole.spin = place.parameter;
  return f(hole);
}

/// Nothing ends a ray but its length and the hole: no sky, no objects.
template <Metric M>
MarchSetting<M> bare_setting(const M& metric, const Accuracy& accuracy, double length) {
  MarchSetting<M> setting{};
  setting.system = {metric};
  setting.accuracy = accuracy;
  setting.lookback = length;
  setting.reach = kFar;
  return setting;
}

template <class S, class Stepper, Metric M>
void march_chunk(Stepper& stepper, const MarchSetting<M>& setting, const Rays& rays) {
  Flights flights(rays.count);
  for (std::size_t i = 0; i < rays.count; ++i) {
    flights.list[i] = static_cast<std::uint32_t>(i);
    for (std::size_t c = 0; c < 8; ++c) flights.y[c][i] = rays.start[i].y[c];
  }
  for (std::size_t i = 0; i < rays.count; i += Lanes<S>::count) {
    const Group<S> group(flights.list.get(), i, rays.count);
    const State<S> y = load(group, flights.y);
    group.store(
        first_step<Stepper::kRoots>(setting.system.metric, y, setting.system.rate(y), setting.accuracy.rtol),
        flights.h);
    group.store(S(kGrowth), flights.growth);
  }
  march<S>(stepper, setting, flights, nullptr);
  for (std::size_t i = 0; i < rays.count; ++i) {
    End& end = rays.end[i];
    const auto y = State<double>::map([&](std::size_t c) { return end.y[c] = flights.y[c][i]; });
    end.steps = flights.steps[i];
    const double drift = std::fabs(square_of_momentum(to_phase(y), to_phase(setting.system.rate(y))));
    end.error = std::sqrt(flights.error[i] * drift);  // as records have it
    end.drift = drift / (y[4] * y[4]);
    end.captured = flights.status[i] == Status::captured;
    end.lost = !end.captured && !(flights.lambda[i] >= setting.lookback);
  }
}

template <class S>
double march_rays(const Place& place, const Accuracy& accuracy, const Rays& rays, int repeats) {
  return with_metric(place, [&](const auto& metric) {
    const auto setting = bare_setting(metric, accuracy, place.length);
    return with_stepper<S>(accuracy.integrator, [&](auto& stepper) {
      return fastest(repeats, [&] {
        constexpr std::size_t kChunk = 2048;
        for (std::size_t i = 0; i < rays.count; i += kChunk)
          march_chunk<S>(stepper, setting, {rays.start + i, rays.end + i, std::min(kChunk, rays.count - i)});
      });
    });
  });
}

template <class S, class Stepper, Metric M>
double step_packs(Stepper& stepper, const HamiltonSystem<M>& system, const Accuracy& accuracy,
                  const Rays& rays, int attempts) {
  S sum(0.0);
  const S far(kFar);
  for (std::size_t i = 0; i + Lanes<S>::count <= rays.count; i += Lanes<S>::count) {
    Flight<S> flight;
    for (std::size_t c = 0; c < 8; ++c) {
      std::array<double, Lanes<S>::count> column;
      for (std::size_t lane = 0; lane < column.size(); ++lane) column[lane] = rays.start[i + lane].y[c];
      flight.y[c] = Lanes<S>::load(column.data());
    }
    flight.dy = system.rate(flight.y);
    flight.h = first_step<Stepper::kRoots>(system.metric, flight.y, flight.dy, accuracy.rtol);
    const Mask<S> all_lanes = flight.h == flight.h;
    for (int k = 0; k < attempts; ++k) {
      const Attempt<S> a = attempt(stepper, system, accuracy, flight, next_step(system.metric, flight, far));
      learn(flight, a, all_lanes);
      flight.y = select(a.accepted, a.y1, flight.y);
      flight.dy = select(a.accepted, a.dy1, flight.dy);
      flight.lambda = select(a.accepted, flight.lambda + a.h, flight.lambda);
    }
    sum = sum + flight.lambda + flight.error + flight.y[0];
  }
  return Lanes<S>::get(sum, 0);
}

template <class S>
double loop_rays(const Place& place, const Accuracy& accuracy, const Rays& rays, int attempts, int repeats) {
  return with_metric(place, [&](const auto& metric) {
    const HamiltonSystem<std::remove_cvref_t<decltype(metric)>> system{metric};
    return with_stepper<S>(accuracy.integrator, [&](auto& stepper) {
      volatile double sink = 0;
      return fastest(repeats, [&] { sink = step_packs<S>(stepper, system, accuracy, rays, attempts); });
    });
  });
}

NULLCONE_KERNEL_END

namespace nullcone::study {
using namespace nullcone::NULLCONE_ISA;
extern const Kernel NULLCONE_STUDY_LANE{NULLCONE_ISA_NAME " one lane", march_rays<double>, loop_rays<double>};
extern const Kernel NULLCONE_STUDY_PACK{NULLCONE_ISA_NAME, march_rays<Pack>, loop_rays<Pack>};
}  // namespace nullcone::study
