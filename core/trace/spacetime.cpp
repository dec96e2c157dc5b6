#include "core/trace/spacetime.h"

namespace nullcone {

// Here, so that no kernel holds a copy of their tables.
HitSink::~HitSink() = default;
Tracer::~Tracer() = default;
Spacetime::~Spacetime() = default;

}  // namespace nullcone
