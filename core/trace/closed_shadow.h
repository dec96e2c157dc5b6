// Shadows along closed-form paths: how much of a lamp's light comes past the objects.
#pragma once

#include "core/trace/closed_onward.h"
#include "core/trace/illumination.h"

NULLCONE_KERNEL_BEGIN

/// Surfaces of one translucent object through which light may go before it counts as dark.
inline constexpr int kMostSheets = 64;

/// The part of the light along connections that comes past one object, for lanes with `limit` > 0; objects
/// stand where they were when the light passed them. `start`: from where on the ray is looked at. An object
/// that is met takes the part `opacity`, at each of its surfaces.
template <class S, class Placing, class Body, class Shape>
S let_past(const Placed<Placing, Body, Shape>& object, double opacity, const LitPoint<S>& lit,
           const Connection<S>& c, const S& start, const S& limit) {
  const auto launch = object.placing.launch(lit.event);
  const auto ray = object.placing.ray(launch, c.past);
  S through(1.0);
  Search<S> search(limit);
  search.active = search.active & (start < limit) & (ray.clearance(S(0.0)) < limit);
  if (!any(search.active)) return through;
  search.lambda = start;
  Mask<S> inside = starts_inside(ray, object.shape, start);
  for (int sheet = 0; sheet < kMostSheets && any(search.active); ++sheet) {
    advance(ray, Onward<S, Shape>{object.shape, inside}, limit, lit.rounding, kSearchLimit, search);
    through = select(search.met, S(1 - opacity) * through, through);
    if (opacity >= 1) return through;
    const auto met = search.met;
    search.lambda = select(met, past_crossing(ray, object.shape, search, lit.rounding), search.lambda);
    inside = (inside & !met) | (met & !inside);
    search.active = met & (search.lambda < limit);
    search.met = met & !met;
  }
  return select(search.active, S(0.0), through);
}

NULLCONE_KERNEL_END
