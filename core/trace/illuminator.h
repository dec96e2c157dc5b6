// The lamps of a scene with integrated rays, and what stands in their light.
#pragma once

#include "core/trace/integrated_lamps.h"
#include "core/trace/integrated_shadow.h"

NULLCONE_KERNEL_BEGIN

template <Metric M>
class Illuminator {
 public:
  bool place(const MarchSetting<M>& setting, const Scene& scene, Unfit& unfit) {
    setting_ = &setting;
    rules_ = LightRules(scene.lights);
    if (rules_.lamps == 0) return true;
    opacity_.reset(new double[scene.objects.size()]);
    for (std::size_t i = 0; i < scene.objects.size(); ++i) opacity_[i] = scene.objects[i].opacity;
    return lamps_.place(setting.system.metric, scene, setting.objects, setting.count, unfit);
  }
  double tau_origin(std::size_t lamp) const { return lamps_.tau_origin(lamp); }
  /// How often light may have been missed so far.
  std::uint64_t doubts() const { return lamps_.doubts(); }

  /// Number of an opaque object that holds the lamp at the time of the observation, and is not its body; or
  /// 0.
  std::uint32_t object_about(std::size_t lamp) const {
    const Vec4<double> event = lamps_.event_at_observation(lamp), at_rest = {{1, 0, 0, 0}};
    for (std::size_t i = 0; i < setting_->count; ++i) {
      const MarchObject<M>& object = setting_->objects[i];
      const bool opaque = opacity_[object.number - 1] == 1 && !lamps_.is_body(lamp, object.number);
      if (opaque && !object.starts_inside() && object.holds(event, at_rest)) return object.number;
    }
    return 0;
  }

  /// Writes what falls on a group of crossings with object `own`. Light is followed with one stepper,
  /// whatever the scene's rays are followed with: all would take four times as long to compile.
  void illuminate(const LitPoint<Wide>& lit, const Group<Wide>& group, std::uint32_t own, double t0,
                  const HitRoom& to) const {
    const M& metric = setting_->system.metric;
    PrinceDormand87<Wide> stepper;
    const auto let_through = [&](const Connection<Wide>& c, const Mask<Wide>& wanted, std::uint32_t body) {
      if (!rules_.shadows) return Wide(1.0);
      const Vec4<Wide> k = static_tetrad(metric, lit.event).to_chart(c.past);
      const ShadowSetting<M> shadow{setting_, opacity_.get(), body};
      const Wide until = Wide(1 - 1e-9) * c.lambda;  // what holds the lamp is not in its way
      return light_through(stepper, shadow, own, lit.event, k, until, wanted).through;
    };
    lamps_.illuminate(rules_, lit, group, own, t0, let_through, to);
  }

 private:
  const MarchSetting<M>* setting_ = nullptr;
  LightRules rules_;
  typename LampsOf<M>::Type lamps_;
  std::unique_ptr<double[]> opacity_;  ///< by the object's number - 1
};

NULLCONE_KERNEL_END
