// Pictures to files, by OpenImageIO.
#pragma once

#include <span>
#include <string>

#include "core/record/dataset.h"
#include "postrender/image.h"

namespace nullcone::postrender {

/// Throws InputError unless `path` ends in .png, .jpg, .jpeg, .tif, .tiff or .exr, and `bits` a component
/// fit: PNG 8 or 16, JPEG 8, TIFF 8, 16 or 32, EXR 16 or 32. 0 stands for the usual: 8, in EXR 32.
void check_picture_name(const std::string& path, int bits);
/// Throws InputError too where the file is not one that holds this output: spaces without a transfer curve
/// need EXR, or TIFF of 32 bits.
void check_output(const std::string& path, int bits, const Output& output);

/// The parts of a picture that write_picture() reads for this file.
ImageParts parts_in(const std::string& path, int bits);

/// Writes a picture, by the ending of `path`: 8 and 16 bit files hold `image.display` (or, if there,
/// `image.encoded`) encoded with the sRGB curve; EXR (float, or half with 16 bits, limited to 65504) and TIFF
/// of 32 bits hold `image.exposed`, linear, before tone curve and gamut mapping. What the components mean
/// (`image.output`) stands in the file: an ICC profile, or in EXR the chromaticities. A fingerprint
/// goes into its comment (picture_stamp.h). The file is written beside its name and renamed when complete; on
/// failure nothing is left behind. Throws WorkError, and InputError as check_picture_name() and
/// check_output() do.
void write_picture(const std::string& path, const Image& image, int bits = 0,
                   const std::string& fingerprint = {});

/// Whether check_picture_name() takes it for OpenEXR.
bool is_exr_name(const std::string& path);

/// Writes numbers, one a pixel of the window of `manifest`, as an EXR file of one float channel; its display
/// window is the whole picture. Otherwise like write_picture().
void write_channel(const std::string& path, const std::string& channel, const Manifest& manifest,
                   std::span<const float> values);

}  // namespace nullcone::postrender
