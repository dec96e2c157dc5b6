#include "postrender/picture_stamp.h"

#include <ImfHeader.h>
#include <ImfInputFile.h>

#include <algorithm>
#include <filesystem>
#include <fstream>
#include <string_view>

#include "core/base/error.h"
#include "postrender/picture_file.h"

namespace nullcone::postrender {

namespace fs = std::filesystem;

namespace {

constexpr std::string_view kMark = "nullcone sha256 ";
constexpr std::size_t kDigits = 64, kHead = 1 << 16;

/// The last `count` bytes of a file, or fewer.
std::string tail_of(std::ifstream& in, std::size_t count) {
  in.clear();
  in.seekg(0, std::ios::end);
  const auto size = static_cast<std::streamoff>(in.tellg());
  const std::streamoff length = std::min(size, static_cast<std::streamoff>(count));
  std::string out(static_cast<std::size_t>(std::max<std::streamoff>(length, 0)), '\0');
  in.seekg(size - length).read(out.data(), length);
  return out;
}

/// The last scan line can be read: it is written last.
bool is_whole_exr(const std::string& path) {
  try {
    Imf::InputFile file(path.c_str(), 0);
    const char* bytes = nullptr;
    int size = 0;
    file.rawPixelData(file.header().dataWindow().max.y, bytes, size);
    return file.isComplete();
  } catch (const std::exception&) {
    return false;
  }
}

bool is_whole(const std::string& path, std::ifstream& in) {
  if (is_exr_name(path)) return is_whole_exr(path);
  const std::string tail = tail_of(in, 12);
  return tail.ends_with("\xff\xd9") || tail.find("IEND") != tail.npos;
}

}  // namespace

std::string fingerprint_comment(const std::string& fingerprint) { return std::string(kMark) + fingerprint; }

std::string fingerprint_of_picture(const std::string& path) {
  std::ifstream in(path, std::ios::binary);
  std::string head(kHead, '\0');
  in.read(head.data(), static_cast<std::streamsize>(head.size()));
  head.resize(static_cast<std::size_t>(std::max<std::streamsize>(in.gcount(), 0)));
  const std::size_t at = head.find(kMark);
  if (at == head.npos || at + kMark.size() + kDigits > head.size() || !is_whole(path, in)) return {};
  return head.substr(at + kMark.size(), kDigits);
}

std::string stamp_of_file(const std::string& path) {
  std::error_code error;
  const auto time = fs::last_write_time(path, error);
  const auto size = error ? 0 : fs::file_size(path, error);
  if (error) throw InputError(path, "cannot be looked at; expected a file");
  return std::to_string(time.time_since_epoch().count()) + "/" + std::to_string(size);
}

std::string stamp_if_there(const std::string& path) {
  std::error_code error;
  return fs::exists(path, error) ? stamp_of_file(path) : "absent";
}

bool is_newer(const std::string& path, const std::vector<std::string>& inputs) {
  std::error_code error;
  const auto time = fs::last_write_time(path, error);
  return !error && std::ranges::all_of(inputs, [&](const std::string& input) {
    const auto other = fs::last_write_time(input, error);
    return !error && other <= time;
  });
}

}  // namespace nullcone::postrender
