#include "apps/view/looks.h"

#include <algorithm>
#include <filesystem>
#include <fstream>

#include "core/base/error.h"
#include "core/base/sha256.h"
#include "postrender/texture_file.h"

namespace nullcone::view {

namespace pr = postrender;
using nlohmann::json;

namespace {

constexpr std::size_t kMostTextures = 200, kMostTextureBytes = std::size_t{1} << 29;

/// All names under "file", wherever they stand in a look.
void collect_files(const json& value, const std::string& folder, std::map<std::string, std::string>& out) {
  if (value.is_object() && value.contains("file") && value["file"].is_string()) {
    const std::string name = value["file"];
    out[name] = (std::filesystem::path(folder) / name).lexically_normal().string();
  }
  if (value.is_structured())
    for (const json& item : value) collect_files(item, folder, out);
}

/// The last part of a path, with nothing in it that means anything to a shell or a file system.
std::string plain_name(const std::string& name) {
  std::string out = name.substr(name.find_last_of("/\\") + 1).substr(0, 80);
  const auto plain = [](char c) {
    return (c >= 'a' && c <= 'z') || (c >= 'A' && c <= 'Z') || (c >= '0' && c <= '9') || c == '.' || c == '_';
  };
  std::ranges::replace_if(
      out, [&](char c) { return !plain(c); }, '-');
  const std::size_t first = out.find_first_not_of(".-");
  return first == out.npos ? "texture" : out.substr(first);
}

}  // namespace

Looks::Looks(const Manifest& manifest, const std::string& data, const std::string& look_file,
             const std::vector<std::string>& settings, const TemporaryFolder& folder)
    : first_(pr::read_document(manifest, data, look_file, settings)), folder_(folder) {
  pr::look_at(first_, manifest, 0);
  auto names = std::make_shared<Names>();
  collect_files(*first_.json, first_.source.folder, *names);
  names_ = names;
}

std::shared_ptr<const Looks::Names> Looks::names() const {
  const std::scoped_lock lock(mutex_);
  return names_;
}

pr::Look Looks::parse(const json& look, const Manifest& manifest, double frame,
                      pr::LookInFull* in_full) const {
  const std::shared_ptr<const Names> names = this->names();
  pr::LookDocument document{std::make_shared<const json>(look), {"look", "", first_.source.folder}};
  document.source.names = names.get();
  return pr::look_at(document, manifest, frame, in_full);
}

/// The mutex is held. A name that is taken gets a number.
std::string Looks::free_name(const std::string& name) const {
  const std::filesystem::path path(name);
  std::string out = name;
  for (int number = 2; names_->contains(out); ++number)
    out = path.stem().string() + "-" + std::to_string(number) + path.extension().string();
  return out;
}

/// The mutex is held.
Looks::Texture Looks::keep(const std::string& name, const std::string& path, const std::string& sha256) {
  const pr::TextureLevel picture = pr::read_texture(path, "/file");
  const Texture out{free_name(plain_name(name)), picture.width, picture.height};
  auto names = std::make_shared<Names>(*names_);
  (*names)[out.name] = path;
  names_ = names;
  return sent_[sha256] = out;
}

Looks::Texture Looks::add_texture(const std::string& name, const std::string& bytes) {
  const std::string sha256 = nullcone::sha256(bytes), path = folder_.file(sha256);
  const std::scoped_lock lock(mutex_);
  if (const auto known = sent_.find(sha256); known != sent_.end()) return known->second;
  if (sent_.size() >= kMostTextures || bytes_ + bytes.size() > kMostTextureBytes)
    throw InputError("texture", "too many were sent to this server; expected at most " +
                                    std::to_string(kMostTextures) + ", 512 MiB together");
  std::ofstream(path, std::ios::binary) << bytes;
  try {
    const Texture out = keep(name, path, sha256);
    bytes_ += bytes.size();
    return out;
  } catch (...) {
    std::filesystem::remove(path);
    throw;
  }
}

std::string Looks::told(std::string message) const {
  const std::string folder = folder_.path() + "/";
  for (std::size_t at = message.find(folder); at != message.npos; at = message.find(folder))
    message.replace(at, folder.size() + 64, "the file that was sent");
  return message;
}

}  // namespace nullcone::view
