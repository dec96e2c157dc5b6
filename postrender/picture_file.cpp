#include "postrender/picture_file.h"

#include <OpenImageIO/imageio.h>
#include <unistd.h>

#include <algorithm>
#include <filesystem>

#include "core/base/error.h"
#include "postrender/color.h"
#include "postrender/picture_stamp.h"

namespace nullcone::postrender {

namespace {

using OIIO::ImageOutput;
using OIIO::ImageSpec;
using OIIO::TypeDesc;
namespace fs = std::filesystem;

static_assert(sizeof(Rgb) == 3 * sizeof(float), "pictures go to files as they lie in memory");

/// OpenImageIO's name of the format, or an empty text.
std::string format_of(const std::string& path) {
  std::string ending = fs::path(path).extension().string();
  std::ranges::transform(ending, ending.begin(),
                         [](char c) { return c >= 'A' && c <= 'Z' ? char(c + 32) : c; });
  if (ending == ".png") return "png";
  if (ending == ".jpg" || ending == ".jpeg") return "jpeg";
  return ending == ".exr" ? "openexr" : "";
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

/// The same picture is the same file: without this OpenImageIO puts the time of writing into it.
void finish_exr_spec(ImageSpec& spec) {
  spec.attribute("compression", "zip");
  spec.attribute("DateTime", "");
}

ImageSpec spec_of(const Image& image, const std::string& format, TypeDesc type,
                  const std::string& fingerprint) {
  ImageSpec spec(image.width, image.height, 3, type);
  if (!fingerprint.empty()) spec.attribute("ImageDescription", fingerprint_comment(fingerprint));
  spec.attribute("oiio:ColorSpace", format == "openexr" ? "Linear" : "sRGB");
  if (format == "jpeg") spec.attribute("Compression", "jpeg:95");
  if (format == "jpeg") spec.attribute("jpeg:subsampling", "4:4:4");
  if (format == "openexr") finish_exr_spec(spec);
  return spec;
}

void write(const std::string& path, const std::string& part, const std::string& format, const ImageSpec& spec,
           const void* pixels) {
  const std::unique_ptr<ImageOutput> out = ImageOutput::create(format);
  if (!out) throw WorkError(path, "this build of OpenImageIO cannot write " + format);
  const bool written = out->open(part, spec) && out->write_image(spec.format, pixels) && out->close();
  if (!written) throw WorkError(path, "cannot be written: " + out->geterror());
}

}  // namespace

void check_picture_name(const std::string& path, int bits) {
  const std::string format = format_of(path);
  if (format.empty()) throw InputError(path, "unknown kind of picture; expected .png, .jpg, .jpeg or .exr");
  if (bits != 8 && bits != 16) throw InputError("--bits", "expected 8 or 16");
  if (bits == 16 && format != "png") throw InputError("--bits", "16 bits need a .png file");
}

void write_picture(const std::string& path, const Image& image, int bits, const std::string& fingerprint) {
  check_picture_name(path, bits);
  const std::string format = format_of(path);
  PartFile part(path);
  if (format == "openexr") {
    write(path, part.name(), format, spec_of(image, format, TypeDesc::FLOAT, fingerprint),
          image.exposed.data());
  } else if (bits == 16) {
    const auto encoded = encode_srgb16(image.display);
    write(path, part.name(), format, spec_of(image, format, TypeDesc::UINT16, fingerprint), encoded.data());
  } else {
    const auto encoded = encode_srgb8(image.display);
    write(path, part.name(), format, spec_of(image, format, TypeDesc::UINT8, fingerprint), encoded.data());
  }
  part.rename();
}

bool is_exr_name(const std::string& path) { return format_of(path) == "openexr"; }

void write_channel(const std::string& path, const std::string& channel, const Manifest& manifest,
                   std::span<const float> values) {
  PartFile part(path);
  ImageSpec spec(manifest.width, manifest.lines, 1, TypeDesc::FLOAT);
  spec.y = manifest.first_line;
  spec.full_height = manifest.height;
  spec.channelnames = {channel};
  spec.z_channel = -1;
  finish_exr_spec(spec);
  write(path, part.name(), "openexr", spec, values.data());
  part.rename();
}

}  // namespace nullcone::postrender
