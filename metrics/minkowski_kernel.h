// All that the kernel of flat spacetime is made of.
#pragma once

#include "metrics/minkowski_connect.h"
#include "metrics/minkowski_sight.h"
