#include "core/record/exr_guard.h"

#include <array>
#include <cstdint>
#include <filesystem>
#include <fstream>

#include "core/base/error.h"

namespace nullcone {

namespace {

/// Reads header fields, each no longer than what is left of the file.
class HeaderReader {
 public:
  explicit HeaderReader(const std::string& path)
      : path_(path), in_(path, std::ios::binary), size_(std::filesystem::file_size(path)) {}

  [[noreturn]] void refuse(const std::string& what) const {
    throw InputError(path_, "damaged or incomplete: its header " + what);
  }
  template <class T>
  T number() {
    T out{};
    in_.read(reinterpret_cast<char*>(&out), sizeof out);
    if (!in_) refuse("is cut off");
    return out;
  }
  /// Up to a zero byte.
  std::string word() {
    std::string out;
    while (const char c = number<char>()) {
      out += c;
      if (out.size() > 255) refuse("holds a name of more than 255 characters");
    }
    return out;
  }
  void skip(std::uint64_t bytes) { in_.seekg(static_cast<std::streamoff>(bytes), std::ios::cur); }
  std::uint64_t left() {
    const auto at = static_cast<std::uint64_t>(in_.tellg());
    return at < size_ ? size_ - at : 0;
  }
  std::uint64_t size() const { return size_; }

 private:
  const std::string& path_;
  std::ifstream in_;
  std::uint64_t size_;
};

void check_window(HeaderReader& in, bool of_data) {
  constexpr std::int64_t kLargest = std::int64_t{1} << 29;
  std::int32_t box[4];
  for (std::int32_t& corner : box) corner = in.number<std::int32_t>();
  for (const std::int64_t corner : box)
    if (corner < -kLargest || corner > kLargest) in.refuse("has a window of more than 2^29 pixels");
  if (box[2] < box[0] || box[3] < box[1]) in.refuse("has an empty window");
  if (!of_data) return;
  // Every 16 lines or fewer are a chunk of at least 8 bytes, with 8 more in a table. Deflate shrinks 1032
  // to 1.
  const std::uint64_t width = static_cast<std::uint64_t>(std::int64_t{box[2]} - box[0] + 1),
                      height = static_cast<std::uint64_t>(std::int64_t{box[3]} - box[1] + 1);
  if (height / 16 > in.size() / 16 || width > 1100 * in.size())
    in.refuse("has a window that is too large for the file");
}

/// Bytes of the values whose length OpenEXR takes from their type, whatever the header says.
struct TypeLength {
  const char* type;
  std::int32_t length;
};
constexpr std::array kTypes = {
    TypeLength{"box2i", 16},   TypeLength{"box2f", 16},      TypeLength{"chromaticities", 32},
    TypeLength{"double", 8},   TypeLength{"compression", 1}, TypeLength{"deepImageState", 1},
    TypeLength{"envmap", 1},   TypeLength{"float", 4},       TypeLength{"int", 4},
    TypeLength{"keycode", 28}, TypeLength{"lineOrder", 1},   TypeLength{"m33f", 36},
    TypeLength{"m33d", 72},    TypeLength{"m44f", 64},       TypeLength{"m44d", 128},
    TypeLength{"rational", 8}, TypeLength{"tiledesc", 9},    TypeLength{"timecode", 8},
    TypeLength{"v2i", 8},      TypeLength{"v2f", 8},         TypeLength{"v2d", 16},
    TypeLength{"v3i", 12},     TypeLength{"v3f", 12},        TypeLength{"v3d", 24}};

/// Whether a value's length may stand in the header; lists of channels are looked at by themselves.
bool length_fits(const std::string& type, std::int32_t length) {
  for (const TypeLength& known : kTypes)
    if (type == known.type) return length == known.length;
  return type != "preview" && type != "idmanifest";  // of no use here, and with lengths of their own
}

/// Names, each with 16 bytes, up to an empty one: OpenEXR reads until there, whatever the length says.
void check_channels(HeaderReader& in, std::int32_t length) {
  const std::uint64_t before = in.left();
  while (!in.word().empty()) in.skip(16);
  if (before - in.left() != static_cast<std::uint64_t>(length)) in.refuse("lists channels wrongly");
}

/// One attribute; false at the end of a part's header.
bool check_attribute(HeaderReader& in) {
  const std::string name = in.word();
  if (name.empty()) return false;
  const std::string type = in.word();
  const auto length = in.number<std::int32_t>();
  if (length < 0 || static_cast<std::uint64_t>(length) > in.left())
    in.refuse("has an attribute that is longer than the file");
  if (!length_fits(type, length)) in.refuse("has an attribute of a wrong length");
  const std::uint64_t before = in.left();
  if (type == "chlist") check_channels(in, length);
  if (type == "box2i") check_window(in, name == "dataWindow");
  if (name == "chunkCount" && type == "int") {
    const auto count = in.number<std::int32_t>();
    if (count < 0 || static_cast<std::uint64_t>(count) > in.size() / 16)
      in.refuse("counts more chunks than the file can hold");
  }
  in.skip(static_cast<std::uint64_t>(length) - (before - in.left()));
  return true;
}

}  // namespace

void check_exr_header(const std::string& path) {
  HeaderReader in(path);
  in.number<std::uint32_t>();  // what it is
  constexpr std::uint32_t kMultiPart = 0x1000;
  const bool many = (in.number<std::uint32_t>() & kMultiPart) != 0;
  for (int part = 0; part < 64; ++part) {
    if (!check_attribute(in)) {
      if (part > 0 && many) return;  // an empty header ends the list
      in.refuse("is empty");
    }
    while (check_attribute(in)) {
    }
    if (!many) return;
  }
  in.refuse("has more than 64 parts");
}

}  // namespace nullcone
