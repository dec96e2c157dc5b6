#include "postrender/picture_file.h"

#include <OpenImageIO/filesystem.h>
#include <OpenImageIO/imageio.h>
#include <unistd.h>

#include <algorithm>
#include <array>
#include <cerrno>
#include <cstring>
#include <filesystem>
#include <fstream>
#include <string_view>

#include "core/base/error.h"
#include "postrender/color.h"
#include "postrender/color_space.h"
#include "postrender/icc_profile.h"
#include "postrender/picture_stamp.h"

namespace nullcone::postrender {

namespace {

using OIIO::ImageOutput;
using OIIO::ImageSpec;
using OIIO::TypeDesc;
namespace fs = std::filesystem;

static_assert(sizeof(Rgb) == 3 * sizeof(float), "pictures go to files as they lie in memory");

/// Of PNG: zlib's level, and libpng's filter PNG_FILTER_UP. See docs/look.md for what others would cost.
constexpr int kPngLevel = 1, kPngFilter = 32;

/// A kind of file.
struct Kind {
  std::string_view format;                  ///< OpenImageIO's name
  std::array<std::string_view, 2> endings;  ///< the second may be empty
  std::array<int, 3> bits;                  ///< the usual one first; 0 is none
  std::string_view bits_text;
};

constexpr std::array<Kind, 4> kKinds = {{{"png", {".png", ""}, {8, 16, 0}, "8 or 16"},
                                         {"jpeg", {".jpg", ".jpeg"}, {8, 0, 0}, "8"},
                                         {"tiff", {".tif", ".tiff"}, {8, 16, 32}, "8, 16 or 32"},
                                         {"openexr", {".exr", ""}, {32, 16, 0}, "16 or 32"}}};

const Kind* find_kind(const std::string& path) {
  std::string ending = fs::path(path).extension().string();
  std::ranges::transform(ending, ending.begin(),
                         [](char c) { return c >= 'A' && c <= 'Z' ? char(c + 32) : c; });
  for (const Kind& kind : kKinds)
    if (!ending.empty() && std::ranges::count(kind.endings, ending) > 0) return &kind;
  return nullptr;
}

/// What a file holds: its kind, and bits a component as OpenImageIO calls them.
struct Content {
  const Kind& kind;
  TypeDesc type;
  bool linear() const { return type.is_floating_point(); }
};

Content content_of(const std::string& path, int bits) {
  const Kind* kind = find_kind(path);
  if (kind == nullptr)
    throw InputError(path, "unknown kind of picture; expected .png, .jpg, .jpeg, .tif, .tiff or .exr");
  if (bits == 0) bits = kind->bits.front();
  if (bits < 0 || std::ranges::count(kind->bits, bits) == 0)
    throw InputError("--bits", "expected " + std::string(kind->bits_text) + " for " +
                                   std::string(kind->endings.front()) + " files");
  const bool half = kind->format == "openexr" && bits == 16;
  return {*kind, half         ? TypeDesc::HALF
                 : bits == 32 ? TypeDesc::FLOAT
                 : bits == 16 ? TypeDesc::UINT16
                              : TypeDesc::UINT8};
}

/// A file that is removed unless it is renamed into place.
class PartFile {
 public:
  explicit PartFile(const std::string& path)
      : path_(path), part_(path + ".part" + std::to_string(::getpid())) {}
  ~PartFile() {
    std::error_code ignored;
    if (!done_) fs::remove(part_, ignored);
  }
  PartFile(const PartFile&) = delete;
  PartFile& operator=(const PartFile&) = delete;

  const std::string& name() const { return part_; }
  void rename() {
    std::error_code error;
    fs::rename(part_, path_, error);
    if (error) throw WorkError(path_, "cannot be put in place: " + error.message());
    done_ = true;
  }

 private:
  std::string path_, part_;
  bool done_ = false;
};

/// Where the primaries and the white stand, for OpenEXR.
void add_chromaticities(ImageSpec& spec, OutputSpace space) {
  const Primaries p = primaries_of(space);
  std::array<float, 8> xy{};
  std::size_t i = 0;
  for (const Chromaticity& c : {p.red, p.green, p.blue, p.white}) {
    xy[i++] = static_cast<float>(c.x);
    xy[i++] = static_cast<float>(c.y);
  }
  spec.attribute("chromaticities", TypeDesc(TypeDesc::FLOAT, 8), xy.data());
}

/// sRGB in PNG has a chunk of its own; EXR has chromaticities; all else has a profile.
void add_color_space(ImageSpec& spec, const Content& content, OutputSpace space) {
  if (content.kind.format == "openexr") return add_chromaticities(spec, space);
  if (!content.linear() && space == OutputSpace::srgb) spec.attribute("oiio:ColorSpace", "sRGB");
  if (content.kind.format == "png" && space == OutputSpace::srgb) return;
  const std::vector<std::uint8_t> profile = icc_profile(space, content.linear());
  if (!profile.empty())
    spec.attribute("ICCProfile", TypeDesc(TypeDesc::UINT8, static_cast<int>(profile.size())), profile.data());
}

ImageSpec spec_of(const Image& image, const Content& content, const std::string& fingerprint) {
  ImageSpec spec(image.width, image.height, 3, content.type);
  if (!fingerprint.empty()) spec.attribute("ImageDescription", fingerprint_comment(fingerprint));
  add_color_space(spec, content, image.output.space);
  if (content.kind.format == "jpeg") {
    spec.attribute("Compression", "jpeg:" + std::to_string(image.output.jpeg_quality));
    spec.attribute("jpeg:subsampling", "4:4:4");
  }
  if (content.kind.format == "png") {
    spec.attribute("png:compressionLevel", kPngLevel);
    spec.attribute("png:filter", kPngFilter);
  }
  if (content.linear() || content.kind.format == "tiff") spec.attribute("compression", "zip");
  return spec;
}

void write(const std::string& path, const std::string& part, std::string_view format, ImageSpec spec,
           TypeDesc type, const void* pixels) {
  spec.attribute("DateTime", "");  // else that of writing, and the same picture would make other bytes
  const std::unique_ptr<ImageOutput> out = ImageOutput::create(std::string(format));
  if (!out) throw WorkError(path, "this build of OpenImageIO cannot write " + std::string(format));
  // PNG and JPEG go through memory: their libraries say nothing of a full disk, or end the program.
  OIIO::Filesystem::IOVecOutput memory;
  const bool through_memory =
      (format == "png" || format == "jpeg") && out->supports("ioproxy") && out->set_ioproxy(&memory);
  const bool written = out->open(part, spec) && out->write_image(type, pixels) && out->close();
  if (!written) throw WorkError(path, "cannot be written: " + out->geterror());
  if (!through_memory) return;
  std::ofstream file(part, std::ios::binary);
  const std::vector<unsigned char>& bytes = memory.buffer();
  file.write(reinterpret_cast<const char*>(bytes.data()), static_cast<std::streamsize>(bytes.size()));
  file.close();
  if (!file) throw WorkError(path, "cannot be written: " + std::string(std::strerror(errno)));
}

/// As far as half floats go.
std::vector<Rgb> limited_to_half(const std::vector<Rgb>& colors) {
  constexpr float kMost = 65504;
  std::vector<Rgb> out(colors);
  for (Rgb& c : out)
    for (float* x : {&c.r, &c.g, &c.b}) *x = std::clamp(*x, -kMost, kMost);
  return out;
}

void check_output(const std::string& path, const Content& content, OutputSpace space) {
  if (content.linear() || space == OutputSpace::srgb || space == OutputSpace::display_p3) return;
  throw InputError(path, "output space " + std::string(name_of(space)) +
                             " is linear; expected .exr, or .tif with --bits 32");
}

}  // namespace

void check_picture_name(const std::string& path, int bits) { content_of(path, bits); }

void check_output(const std::string& path, int bits, const Output& output) {
  check_output(path, content_of(path, bits), output.space);
}

ImageParts parts_in(const std::string& path, int bits) {
  const Content content = content_of(path, bits);
  const bool bytes = content.type == TypeDesc::UINT8;
  return {.exposed = content.linear(), .display = !content.linear() && !bytes, .encoded = bytes};
}

void write_picture(const std::string& path, const Image& image, int bits, const std::string& fingerprint) {
  const Content content = content_of(path, bits);
  check_output(path, content, image.output.space);
  if (content.linear() && image.exposed.empty())
    throw InputError(path, "this picture has no more than 8 or 16 bits; expected .png, .jpg or .tif");
  PartFile part(path);
  const auto put = [&](TypeDesc type, const void* pixels) {
    write(path, part.name(), content.kind.format, spec_of(image, content, fingerprint), type, pixels);
  };
  if (content.type == TypeDesc::HALF) {
    put(TypeDesc::FLOAT, limited_to_half(image.exposed).data());
  } else if (content.linear()) {
    put(TypeDesc::FLOAT, image.exposed.data());
  } else if (content.type == TypeDesc::UINT16) {
    put(TypeDesc::UINT16, encode_srgb16(image.display).data());
  } else {
    put(TypeDesc::UINT8, (image.encoded.empty() ? encode_srgb8(image.display) : image.encoded).data());
  }
  part.rename();
}

bool is_exr_name(const std::string& path) {
  const Kind* kind = find_kind(path);
  return kind != nullptr && kind->format == "openexr";
}

void write_channel(const std::string& path, const std::string& channel, const Manifest& manifest,
                   std::span<const float> values) {
  PartFile part(path);
  ImageSpec spec(manifest.width, manifest.lines, 1, TypeDesc::FLOAT);
  spec.y = manifest.first_line;
  spec.full_height = manifest.height;
  spec.channelnames = {channel};
  spec.z_channel = -1;
  spec.attribute("compression", "zip");
  write(path, part.name(), "openexr", spec, TypeDesc::FLOAT, values.data());
  part.rename();
}

}  // namespace nullcone::postrender
