// Compiled once for each instruction set: see CMakeLists.txt and core/base/isa.h.
#include "postrender/kernel.h"

#include "postrender/kernel_cube.h"
#include "postrender/kernel_develop.h"
#include "postrender/kernel_footprint.h"
#include "postrender/kernel_reflection.h"
#include "postrender/kernel_spectrum.h"
#include "postrender/kernel_texture.h"

namespace nullcone::postrender {

extern const Kernel NULLCONE_POSTRENDER_KERNEL;
const Kernel NULLCONE_POSTRENDER_KERNEL = {
    NULLCONE_ISA_NAME,
    NULLCONE_ISA::footprints,
    NULLCONE_ISA::recorded_footprints,
    NULLCONE_ISA::weigh,
    NULLCONE_ISA::image_colors,
    NULLCONE_ISA::cube_colors,
    NULLCONE_ISA::checkerboard_colors,
    NULLCONE_ISA::plain_light,
    NULLCONE_ISA::filtered_light,
    NULLCONE_ISA::mixed_light,
    NULLCONE_ISA::light_of_lines,
    NULLCONE_ISA::reflected_light,
    NULLCONE_ISA::background_light,
    NULLCONE_ISA::expose,
    NULLCONE_ISA::exponential_curve,
    NULLCONE_ISA::filmic_curve,
    NULLCONE_ISA::table_curve,
    NULLCONE_ISA::desaturate,
    NULLCONE_ISA::clip,
    NULLCONE_ISA::encode_srgb8,
    NULLCONE_ISA::interleave,
};

}  // namespace nullcone::postrender
