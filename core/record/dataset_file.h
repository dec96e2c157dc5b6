// The dataset as one OpenEXR file: parts `preview`, `hits` (deep) and `rays`.
#pragma once

#include <string>
#include <vector>

#include "core/record/dataset.h"

namespace nullcone {

/// The flat picture that any EXR viewer shows first: linear R, G, B, A a pixel, four entries each.
using Preview = std::vector<float>;

/// Throws WorkError where no dataset can be written; removes what killed writers left there.
void check_place(const std::string& path);

/// Writes beside `path` and renames when complete and safe on the disk, also from a power cut; on failure the
/// old file stays and nothing is left behind (see WholeFile). Throws WorkError.
void write_dataset(const std::string& path, const Dataset& dataset, const Preview& preview);

/// Reads a whole dataset. A foreign, truncated or newer file throws InputError with the reason; the numbers
/// are not verified against their hashes (see verify()).
Dataset read_dataset(const std::string& path);

/// The manifest alone: the header is read, not the pixels.
Manifest read_manifest(const std::string& path);

/// Whether the file begins as OpenEXR files do (false if it cannot be opened).
bool looks_like_exr(const std::string& path);

std::string manifest_to_json(const Manifest& manifest);
/// `place` stands before complaints.
Manifest manifest_from_json(const std::string& text, const std::string& place);

}  // namespace nullcone
