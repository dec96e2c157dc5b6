#include "core/trace/spacetime.h"

namespace nullcone {

// Here, so that no kernel holds a copy of their tables.
Tracer::~Tracer() = default;
Spacetime::~Spacetime() = default;

}  // namespace nullcone
