// Developed 8 bit pictures as bytes for the browser.
#pragma once

#include <cstdint>
#include <optional>
#include <span>
#include <string>
#include <string_view>

namespace nullcone::view {

enum class Format { raw, jpeg, webp, png };

/// By the name that requests use.
std::optional<Format> find_format(std::string_view name);
std::string_view content_type(Format format);

/// `rgb`: 3 bytes a pixel, encoded with the sRGB curve. raw: RGBA; png: lossless too; jpeg (4:4:4) and
/// webp: lossy. `memory` is taken for the bytes where it helps. Throws WorkError.
std::string encode(Format format, int width, int height, std::span<const std::uint8_t> rgb,
                   std::string memory = {});

}  // namespace nullcone::view
