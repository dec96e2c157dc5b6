// The samples of a picture as the pixels of a larger one.
#pragma once

#include "core/record/dataset.h"

namespace nullcone::postrender {

/// The records of a dataset of n x n samples a pixel as those of one of n * width by n * lines pixels of one
/// sample each: every crossing goes to its ray, the nearest first as before. Steps of texture coordinates
/// (duv) are then those from sample to sample. Rays are left out, because nothing is shaded by them. A
/// dataset with one sample a pixel is returned as it is. Throws InputError where the channel `sample` is
/// missing or names a sample that a pixel does not have.
Dataset by_samples(Dataset dataset);

}  // namespace nullcone::postrender
