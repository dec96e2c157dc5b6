// The lamps of a scene with integrated rays, and what stands in their light.
#pragma once

#include "core/trace/integrated_lamps.h"
#include "core/trace/integrated_shadow.h"

NULLCONE_KERNEL_BEGIN

template <Metric M>
struct Illuminator {
  LightRules rules;
  typename LampsOf<M>::Type lamps;
  Shades<M> shades;

  bool place(const MarchSetting<M>& setting, const Scene& scene, Unfit& unfit) {
    rules = LightRules(scene.lights);
    if (rules.lamps == 0) return true;
    shades.place(setting, scene);
    return lamps.place(setting.system.metric, scene, setting.objects, setting.count, unfit);
  }

  /// Writes what falls on a group of crossings with object `own`. Light is followed with one stepper whatever
  /// the scene's rays are followed with: all would take four times as long to compile.
  void illuminate(const LitPoint<Wide>& lit, const Group<Wide>& group, std::uint32_t own, double t0,
                  const HitRoom& to) const {
    PrinceDormand87<Wide> stepper;
    const auto let_through = [&](const Connection<Wide>& c, const Mask<Wide>& wanted, std::uint32_t body) {
      return rules.shadows ? shades.let_through(stepper, lit, c, wanted, own, body) : Wide(1.0);
    };
    lamps.illuminate(rules, lit, group, own, t0, let_through, to);
  }
};

NULLCONE_KERNEL_END
