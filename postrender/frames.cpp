#include "postrender/frames.h"

#include <algorithm>
#include <filesystem>
#include <set>

#include "core/base/error.h"

namespace nullcone::postrender {

namespace fs = std::filesystem;

namespace {

/// Absolute and without links, as far as these can be followed.
std::string real_name(const fs::path& path) {
  std::error_code error;
  const fs::path real = fs::weakly_canonical(fs::absolute(path), error);
  return (error ? fs::absolute(path).lexically_normal() : real).string();
}

std::string name_in(const std::string& real_folder, const std::string& path) {
  return (fs::path(real_folder) / fs::path(path).filename()).string();
}

/// The real name of the folder of a picture.
std::string checked_folder(const fs::path& folder) {
  std::error_code error;
  if (!folder.empty() && !fs::is_directory(folder, error))
    throw InputError("--output", "the folder is not there: " + printable(folder.string()));
  return real_name(folder.empty() ? "." : folder);
}

void check_inputs(const std::vector<FrameFiles>& files) {
  std::set<std::string> asked;
  std::vector<std::string> missing;
  const auto check = [&](const std::string& path) {
    std::error_code error;
    if (asked.insert(path).second && !fs::exists(path, error)) missing.push_back(path);
  };
  for (const FrameFiles& one : files) {
    check(one.data);
    for (const std::string& look : one.looks) check(look);
  }
  if (missing.empty()) return;
  std::string more;
  for (std::size_t i = 1; i < std::min<std::size_t>(missing.size(), 4); ++i)
    more += (i == 1 ? "" : ", ") + missing[i];
  if (missing.size() > 1)
    more = "; nor are " + std::to_string(missing.size() - 1) + " more: " + more +
           (missing.size() > 4 ? ", …" : "");
  throw InputError(missing.front(), "is not there" + more);
}

void check_outputs(const std::vector<FrameFiles>& files) {
  const PictureNames pictures(files);
  std::set<std::string> inputs;
  for (const FrameFiles& one : files) {
    inputs.insert(one.data);
    inputs.insert(one.looks.begin(), one.looks.end());
  }
  for (const std::string& input : inputs) pictures.check_input(input);
}

}  // namespace

bool FramePatterns::any() const {
  return has_number(data) || has_number(picture) || std::ranges::any_of(looks, has_number);
}

PictureNames::PictureNames(const std::vector<FrameFiles>& files) {
  std::map<std::string, std::string> folders;  // by the name as it is told
  std::error_code error;
  for (const FrameFiles& one : files) {
    if (one.picture.empty()) continue;
    const std::string folder = fs::path(one.picture).parent_path().string();
    auto real = folders.find(folder);
    if (real == folders.end()) real = folders.emplace(folder, checked_folder(folder)).first;
    if (fs::is_directory(one.picture, error)) throw InputError("--output", one.picture + " is a folder");
    if (!pictures_.emplace(name_in(real->second, one.picture), one.picture).second)
      throw InputError("--output", "several frames would be written to " + one.picture +
                                       "; expected #### in the name, for the frame's number");
    in_folders_.insert(fs::path(one.picture).filename().string());
  }
}

void PictureNames::check_input(const std::string& file) const {
  // Films name many files, and real names take long.
  std::error_code error;
  if (!in_folders_.contains(fs::path(file).filename().string()) && !fs::is_symlink(file, error)) return;
  const fs::path folder = fs::path(file).parent_path();
  // A link itself would be overwritten, and so would what it leads to.
  for (const std::string& name : {name_in(real_name(folder.empty() ? "." : folder), file), real_name(file)})
    if (const auto found = pictures_.find(name); found != pictures_.end())
      throw InputError("--output", found->second + " is an input too; expected another name");
}

std::vector<FrameFiles> files_of(const FramePatterns& patterns, const std::vector<int>& frames) {
  std::vector<FrameFiles> out;
  for (const int frame : frames) {
    FrameFiles files{
        frame, numbered(patterns.data, frame, "DATA"), {}, numbered(patterns.picture, frame, "--output")};
    for (const std::string& look : patterns.looks) files.looks.push_back(numbered(look, frame, "--look"));
    out.push_back(std::move(files));
  }
  check_outputs(out);
  check_inputs(out);
  return out;
}

}  // namespace nullcone::postrender
