// All that the kernel of the Gödel universe is made of.
#pragma once

#include "metrics/goedel_connect.h"
#include "metrics/goedel_orbit.h"
#include "metrics/goedel_sight.h"
