#include "apps/view/encode.h"

#include <png.h>
#include <turbojpeg.h>
#include <webp/encode.h>

#include <array>
#include <bit>
#include <cstring>
#include <memory>
#include <utility>

#include "core/base/error.h"

namespace nullcone::view {

namespace {

constexpr std::array<std::pair<std::string_view, Format>, 4> kNames = {
    {{"raw", Format::raw}, {"jpeg", Format::jpeg}, {"webp", Format::webp}, {"png", Format::png}}};

/// With colours at full resolution (4:4:4): a world map of 1280 x 1024 takes 4.8 ms of one core and 241 kB,
/// at half of it (4:2:0) 2.8 ms and 185 kB; but that smears colours over edges, and WebP, which has no other
/// way, serves the slowest links with 159 kB (20 ms).
constexpr int kJpegQuality = 85;
constexpr float kWebpQuality = 80;
/// With the filter "up", and of zlib runs of equal bytes alone: 25 ms and 1.27 MB for that map, where looking
/// for all repetitions takes 32 ms and 1.36 MB.
constexpr int kPngLevel = 1, kPngStrategy = 3;  ///< Z_RLE

struct Pixels {
  int width, height;
  std::span<const std::uint8_t> rgb;
  std::size_t count() const { return static_cast<std::size_t>(width) * static_cast<std::size_t>(height); }
};

[[noreturn]] void fail(std::string_view format, std::string_view why) {
  throw WorkError("picture", "cannot be encoded as " + std::string(format) + ": " + std::string(why));
}

std::string to_rgba(const Pixels& in, std::string out) {
  static_assert(std::endian::native == std::endian::little);
  out.resize(4 * in.count());
  if (in.count() == 0) return out;
  const std::uint8_t* from = in.rgb.data();
  char* to = out.data();
  // Four bytes at once, of which the last belongs to the next pixel; so the last pixel stands apart.
  std::uint32_t pixel = 0;
  for (std::size_t i = 0; i + 1 < in.count(); ++i, from += 3, to += 4) {
    std::memcpy(&pixel, from, 4);
    pixel |= 0xff000000U;
    std::memcpy(to, &pixel, 4);
  }
  std::memcpy(to, from, 3);
  to[3] = static_cast<char>(0xff);
  return out;
}

std::string to_jpeg(const Pixels& in) {
  const std::unique_ptr<void, int (*)(tjhandle)> encoder(tjInitCompress(), tjDestroy);
  if (!encoder) fail("JPEG", "libjpeg-turbo does not start");
  const auto largest = tjBufSize(in.width, in.height, TJSAMP_444);
  if (largest == static_cast<unsigned long>(-1)) fail("JPEG", "the picture is too large");
  std::string out(largest, '\0');
  auto* bytes = reinterpret_cast<unsigned char*>(out.data());
  unsigned long size = largest;
  if (tjCompress2(encoder.get(), in.rgb.data(), in.width, 0, in.height, TJPF_RGB, &bytes, &size, TJSAMP_444,
                  kJpegQuality, TJFLAG_NOREALLOC) != 0)
    fail("JPEG", tjGetErrorStr2(encoder.get()));
  out.resize(size);
  return out;
}

int append_webp(const std::uint8_t* data, std::size_t size, const WebPPicture* picture) {
  static_cast<std::string*>(picture->custom_ptr)->append(reinterpret_cast<const char*>(data), size);
  return 1;
}

std::string to_webp(const Pixels& in) {
  WebPConfig config;
  WebPPicture picture;
  if (WebPConfigPreset(&config, WEBP_PRESET_DEFAULT, kWebpQuality) == 0 || WebPPictureInit(&picture) == 0)
    fail("WebP", "another version of libwebp");
  config.method = 0;  // the fastest
  config.segments = 1;
  config.thread_level = 1;
  const std::unique_ptr<WebPPicture, void (*)(WebPPicture*)> freed(&picture, WebPPictureFree);
  std::string out;
  picture.width = in.width;
  picture.height = in.height;
  picture.writer = append_webp;
  picture.custom_ptr = &out;
  const bool done =
      WebPPictureImportRGB(&picture, in.rgb.data(), 3 * in.width) != 0 && WebPEncode(&config, &picture) != 0;
  if (!done) fail("WebP", "error " + std::to_string(picture.error_code) + " of libwebp");
  return out;
}

void append_png(png_structp png, png_bytep data, std::size_t size) {
  static_cast<std::string*>(png_get_io_ptr(png))->append(reinterpret_cast<const char*>(data), size);
}

/// libpng leaves by an exception, which its frames let through: they hold nothing that must be freed.
[[noreturn]] void png_failed(png_structp, const char* why) { fail("PNG", why); }
void png_warned(png_structp, const char*) {}

std::string to_png(const Pixels& in) {
  struct Writer {
    png_structp png = png_create_write_struct(PNG_LIBPNG_VER_STRING, nullptr, png_failed, png_warned);
    png_infop info = png == nullptr ? nullptr : png_create_info_struct(png);
    Writer() = default;
    Writer(const Writer&) = delete;
    Writer& operator=(const Writer&) = delete;
    ~Writer() { png_destroy_write_struct(&png, &info); }
  } writer;
  if (writer.info == nullptr) fail("PNG", "libpng does not start");
  std::string out;
  png_set_write_fn(writer.png, &out, append_png, nullptr);
  png_set_IHDR(writer.png, writer.info, static_cast<png_uint_32>(in.width),
               static_cast<png_uint_32>(in.height), 8, PNG_COLOR_TYPE_RGB, PNG_INTERLACE_NONE,
               PNG_COMPRESSION_TYPE_DEFAULT, PNG_FILTER_TYPE_DEFAULT);
  png_set_compression_level(writer.png, kPngLevel);
  png_set_compression_strategy(writer.png, kPngStrategy);
  png_set_filter(writer.png, PNG_FILTER_TYPE_BASE, PNG_FILTER_UP);
  png_write_info(writer.png, writer.info);
  for (std::size_t y = 0; y < static_cast<std::size_t>(in.height); ++y)
    png_write_row(writer.png, in.rgb.data() + y * 3 * static_cast<std::size_t>(in.width));
  png_write_end(writer.png, nullptr);
  return out;
}

}  // namespace

std::optional<Format> find_format(std::string_view name) {
  for (const auto& [known, format] : kNames)
    if (known == name) return format;
  return {};
}

std::string_view content_type(Format format) {
  switch (format) {
    case Format::jpeg:
      return "image/jpeg";
    case Format::webp:
      return "image/webp";
    case Format::png:
      return "image/png";
    case Format::raw:
      break;
  }
  return "application/octet-stream";
}

std::string encode(Format format, int width, int height, std::span<const std::uint8_t> rgb,
                   std::string memory) {
  const Pixels pixels{width, height, rgb};
  if (width < 1 || height < 1 || rgb.size() != 3 * pixels.count())
    throw WorkError("picture", "has " + std::to_string(rgb.size()) + " bytes, which are not " +
                                   std::to_string(width) + " x " + std::to_string(height) + " pixels");
  switch (format) {
    case Format::jpeg:
      return to_jpeg(pixels);
    case Format::webp:
      return to_webp(pixels);
    case Format::png:
      return to_png(pixels);
    case Format::raw:
      break;
  }
  return to_rgba(pixels, std::move(memory));
}

}  // namespace nullcone::view
