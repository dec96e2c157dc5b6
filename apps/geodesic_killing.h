// The flow of a Killing field, found from the constant of motion that belongs to it.
#pragma once

#include "core/trace/spacetime.h"

namespace nullcone {

/// Each constant of motion that is linear in the tangent is g(K, k) of a Killing field K.
class KillingField {
 public:
  /// `near`: an event where a static observer exists. Throws InputError for a name that no field belongs to.
  KillingField(const Spacetime& spacetime, std::span<const double> parameters, const std::string& name,
               const Event& near);

  /// Chart components of K at an event; NaN where no static observer exists.
  Event at(const Event& event) const;

  /// An event, and a vector there, carried along the field by the isometry of parameter eta. Throws
  /// InputError where that leads out of what numbers can hold.
  struct Carried {
    Event event, vector;
  };
  Carried carry(const Carried& start, double eta) const;

 private:
  double charge(const Event& event, const Event& tangent) const;

  const Spacetime& spacetime_;
  std::span<const double> parameters_;
  std::size_t number_ = 0;
};

}  // namespace nullcone
