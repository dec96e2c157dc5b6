#include "postrender/texture_file.h"

#include <OpenImageIO/imageio.h>

#include <algorithm>
#include <array>
#include <cstdint>
#include <cstring>
#include <filesystem>
#include <fstream>
#include <limits>
#include <string_view>

#include "core/base/error.h"
#include "postrender/color.h"

namespace nullcone::postrender {

namespace {

using OIIO::ImageInput;
using OIIO::ImageSpec;
using OIIO::TypeDesc;

/// What complaints begin with.
struct Place {
  const std::string& path;
  const std::string& pointer;
  [[noreturn]] void refuse(const std::string& message) const {
    throw InputError(path + ": " + pointer, message);
  }
};

struct Magic {
  std::string_view bytes, format;
};
using namespace std::string_view_literals;
constexpr std::array kMagics = {
    Magic{"\xff\xd8\xff"sv, "jpeg"}, Magic{"\x89PNG"sv, "png"}, Magic{"\x76\x2f\x31\x01"sv, "openexr"},
    Magic{"II*\0"sv, "tiff"},        Magic{"MM\0*"sv, "tiff"},  Magic{"#?RADIANCE"sv, "hdr"},
    Magic{"#?RGBE"sv, "hdr"},
};

/// OpenImageIO would try every plug-in it has on a file that it does not know: name the one that fits.
std::string format_of(const Place& place) {
  std::error_code error;
  if (!std::filesystem::exists(place.path, error)) place.refuse("no such file; expected a picture");
  if (!std::filesystem::is_regular_file(place.path, error)) place.refuse("not a file; expected a picture");
  std::ifstream in(place.path, std::ios::binary);
  std::string head(16, '\0');
  in.read(head.data(), static_cast<std::streamsize>(head.size()));
  for (const Magic& magic : kMagics)
    if (std::string_view(head).starts_with(magic.bytes)) return std::string(magic.format);
  place.refuse("not a picture; expected JPEG, PNG, TIFF, OpenEXR or Radiance HDR");
}

void check_size(const ImageSpec& spec, const Place& place) {
  const std::string size = std::to_string(spec.width) + " x " + std::to_string(spec.height);
  if (spec.deep || spec.depth > 1) place.refuse("a deep or volume image; expected a flat picture");
  if (spec.width < 1 || spec.height < 1 || spec.nchannels < 1) place.refuse("an empty picture");
  if (spec.width > kLargestTextureSide || spec.height > kLargestTextureSide)
    place.refuse("is " + size + "; expected at most " + std::to_string(kLargestTextureSide) + " a side");
  const auto texels = static_cast<std::size_t>(spec.width) * static_cast<std::size_t>(spec.height);
  if (texels > kLargestTextureBytes / sizeof(Rgb))
    place.refuse("is " + size + "; expected at most " + std::to_string(kLargestTextureBytes / sizeof(Rgb)) +
                 " texels (1 GiB decoded)");
}

/// Reads the first one or three channels as T and turns each into linear light by `linear(T)`.
template <class T, class Linear>
std::vector<Rgb> read_as(ImageInput& in, TypeDesc type, const Place& place, Linear&& linear) {
  const ImageSpec spec = in.spec();
  const std::size_t channels = spec.nchannels >= 3 ? 3 : 1;
  const auto texels = static_cast<std::size_t>(spec.width) * static_cast<std::size_t>(spec.height);
  std::vector<T> raw(texels * channels);
  // OpenImageIO reports success for a TIFF file with strips missing, but keeps the error.
  if (!in.read_image(0, 0, 0, static_cast<int>(channels), type, raw.data()) || in.has_error())
    place.refuse("cannot be read whole: " + in.geterror());
  std::vector<Rgb> out(texels);
  for (std::size_t i = 0; i < texels; ++i) {
    const T* c = raw.data() + channels * i;
    out[i] = {linear(c[0]), linear(c[channels == 3 ? 1 : 0]), linear(c[channels == 3 ? 2 : 0])};
  }
  return out;
}

template <class T>
std::vector<float> decoding_table() {
  std::vector<float> table(std::size_t{std::numeric_limits<T>::max()} + 1);
  for (std::size_t i = 0; i < table.size(); ++i)
    table[i] =
        static_cast<float>(srgb_decoded(static_cast<double>(i) / static_cast<double>(table.size() - 1)));
  return table;
}

std::vector<Rgb> read_linear(ImageInput& in, const Place& place) {
  switch (in.spec().format.basetype) {
    case TypeDesc::UINT8:
      return read_as<std::uint8_t>(in, TypeDesc::UINT8, place,
                                   [table = decoding_table<std::uint8_t>()](auto c) { return table[c]; });
    case TypeDesc::UINT16:
      return read_as<std::uint16_t>(in, TypeDesc::UINT16, place,
                                    [table = decoding_table<std::uint16_t>()](auto c) { return table[c]; });
    case TypeDesc::HALF:
    case TypeDesc::FLOAT:
    case TypeDesc::DOUBLE:
      return read_as<float>(in, TypeDesc::FLOAT, place, [](float c) { return c; });
    default:
      place.refuse("holds numbers of an unusual kind; expected 8 or 16 bit or float");
  }
}

/// Sets the level's alpha from the picture's, and multiplies the colours by it if they are not yet.
void read_alpha(ImageInput& in, const Place& place, bool multiplied, TextureLevel& out) {
  const int channel = in.spec().alpha_channel;
  if (channel < 0) place.refuse("has no alpha channel; expected one, because the look says \"alpha\": true");
  out.alpha.resize(out.texels.size());
  if (!in.read_image(0, 0, channel, channel + 1, TypeDesc::FLOAT, out.alpha.data()) || in.has_error())
    place.refuse("cannot be read whole: " + in.geterror());
  for (std::size_t i = 0; i < out.texels.size(); ++i) {
    out.alpha[i] = out.alpha[i] > 0 ? std::min(out.alpha[i], 1.0f) : 0.0f;
    if (!multiplied) out.texels[i] = out.alpha[i] * out.texels[i];
  }
}

/// libjpeg fills what is missing with grey and only warns, so look for the marker that ends every JPEG
/// stream.
void check_jpeg_end(const Place& place) {
  std::ifstream in(place.path, std::ios::binary | std::ios::ate);
  const std::streamoff size = in.tellg(), tail = std::min<std::streamoff>(size, 1 << 16);
  std::string bytes(static_cast<std::size_t>(tail), '\0');
  in.seekg(size - tail).read(bytes.data(), tail);
  if (bytes.find("\xff\xd9") == std::string::npos)
    place.refuse("cannot be read whole: the JPEG file is cut off");
}

/// libpng prints to standard error by itself when a file is cut off, so walk its chunks to the last one
/// first.
void check_png_end(const Place& place) {
  std::ifstream in(place.path, std::ios::binary);
  in.seekg(8);
  std::array<unsigned char, 8> head{};  // length, big-endian, and type
  while (in.read(reinterpret_cast<char*>(head.data()), 8)) {
    if (std::memcmp(head.data() + 4, "IEND", 4) == 0) return;
    std::streamoff length = 0;
    for (std::size_t i = 0; i < 4; ++i) length = 256 * length + head[i];
    in.seekg(length + 4, std::ios::cur);  // and the checksum
  }
  place.refuse("cannot be read whole: the PNG file is cut off");
}

/// A picture that is whole, as far as can be told before it is read.
std::unique_ptr<ImageInput> open(const Place& place, ImageSpec& spec) {
  const std::string format = format_of(place);
  if (format == "jpeg") check_jpeg_end(place);
  if (format == "png") check_png_end(place);
  std::unique_ptr<ImageInput> in = ImageInput::create(format);
  ImageSpec options;
  options.attribute("oiio:UnassociatedAlpha", 1);  // colours stay as stored
  if (!in) place.refuse("this build of OpenImageIO cannot read " + format);
  if (!in->open(place.path, spec, options)) place.refuse("cannot be read: " + in->geterror());
  check_size(spec, place);
  return in;
}

}  // namespace

TextureLevel read_texture(const std::string& path, const std::string& pointer, bool alpha) {
  const Place place{path, pointer};
  ImageSpec spec;
  const std::unique_ptr<ImageInput> in = open(place, spec);
  TextureLevel out{spec.width, spec.height, read_linear(*in, place)};
  if (alpha) read_alpha(*in, place, std::string_view(in->format_name()) == "openexr", out);
  in->close();
  return out;
}

TextureLevel read_materials(const std::string& path, const std::string& pointer, MaterialGroup group) {
  const Place place{path, pointer};
  ImageSpec spec;
  const std::unique_ptr<ImageInput> in = open(place, spec);
  if (spec.format.basetype != TypeDesc::UINT8)
    place.refuse("expected 8 bits: red is the number of a material, green how much of it there is");
  const int channels = spec.nchannels >= 3 ? 2 : 1;
  TextureLevel out{spec.width, spec.height, {}};
  out.texels.resize(static_cast<std::size_t>(spec.width) * static_cast<std::size_t>(spec.height));
  std::vector<std::uint8_t> raw(out.texels.size() * static_cast<std::size_t>(channels));
  if (!in->read_image(0, 0, 0, channels, TypeDesc::UINT8, raw.data()) || in->has_error())
    place.refuse("cannot be read whole: " + in->geterror());
  for (std::size_t i = 0; i < out.texels.size(); ++i) {
    const std::size_t at = i * static_cast<std::size_t>(channels);
    const int material = raw[at], component = material - group.first;
    if (material >= group.count)
      place.refuse("names material " + std::to_string(material) + "; the spectrum has " +
                   std::to_string(group.count) + ", numbered from 0");
    const float amount = channels == 1 ? 1.0f : static_cast<float>(raw[at + 1]) / 255;
    if (component == 0) out.texels[i].r = amount;
    if (component == 1) out.texels[i].g = amount;
    if (component == 2) out.texels[i].b = amount;
  }
  in->close();
  return out;
}

}  // namespace nullcone::postrender
