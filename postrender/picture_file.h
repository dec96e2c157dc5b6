// Pictures to files, by OpenImageIO.
#pragma once

#include <span>
#include <string>

#include "core/record/dataset.h"
#include "postrender/image.h"

namespace nullcone::postrender {

/// Throws InputError unless `path` ends in .png, .jpg, .jpeg or .exr; `bits` is 8, or 16 (PNG only).
void check_picture_name(const std::string& path, int bits);

/// Writes PNG (8 or 16 bit, sRGB) or JPEG (8 bit, sRGB, quality 95) from `image.display`, or EXR (float,
/// linear sRGB after exposure, before tone curve and gamut mapping) from `image.exposed`, by the ending of
/// `path`. A fingerprint goes into the file's comment (picture_stamp.h). The file is written beside its name
/// and renamed when complete; on failure nothing is left behind. Throws WorkError, and InputError as
/// check_picture_name() does.
void write_picture(const std::string& path, const Image& image, int bits = 8,
                   const std::string& fingerprint = {});

/// Whether check_picture_name() takes it for OpenEXR.
bool is_exr_name(const std::string& path);

/// Writes numbers, one a pixel of the window of `manifest`, as an EXR file of one float channel; its display
/// window is the whole picture. Otherwise like write_picture().
void write_channel(const std::string& path, const std::string& channel, const Manifest& manifest,
                   std::span<const float> values);

}  // namespace nullcone::postrender
