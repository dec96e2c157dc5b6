// Observers who move: where one is at a proper time, how fast, and how his axes stand.
#pragma once

#include "core/trace/travel.h"

namespace nullcone {

/// The observer of a motion at proper time `tau` since its event, with axes that are Fermi-Walker transported
/// (on geodesics: parallel) from the boosted axes of the tetrad `frame` there. Relative errors some 1e-13 of
/// what was passed through. Throws InputError, placed at `place`, where the motion is none of an observer, or
/// leads where none can be.
Followed follow(const Spacetime& spacetime, std::span<const double> parameters, const Motion& motion,
                ObserverFrame frame, double tau, const std::string& place);

/// Puts the event, velocity and camera axes of an observer who moves in place of his motion; does nothing for
/// one whose event and velocity are given.
void settle_observer(const Spacetime& spacetime, std::span<const double> parameters, Scene& scene,
                     const std::string& place);

}  // namespace nullcone
