#include "apps/cluster/folder.h"

#include <sys/stat.h>
#include <unistd.h>

#include <algorithm>
#include <array>
#include <charconv>
#include <chrono>
#include <filesystem>
#include <fstream>
#include <sstream>

#include "core/base/error.h"
#include "core/record/whole_file.h"

namespace nullcone::cluster {

namespace fs = std::filesystem;

namespace {

std::string three_digits(int number) {
  const std::string digits = std::to_string(number);
  return std::string(std::max<std::size_t>(digits.size(), 3) - digits.size(), '0') + digits;
}

}  // namespace

Folder::Folder(const std::string& path) {
  if (path.empty()) throw InputError("--output", "is empty; expected the name of a folder");
  if (path.find_first_of("#\\\n\r") != path.npos)
    throw InputError("--output", "'" + printable(path) + "': expected a folder without # and \\ in its name");
  std::error_code error;
  if (fs::exists(path, error) && !fs::is_directory(path, error))
    throw InputError(path, "is a file; expected the name of a folder");
  path_ = fs::absolute(path).lexically_normal().string();
  while (path_.size() > 1 && path_.back() == '/') path_.pop_back();
}

std::string Folder::round(int number, const std::string& name) const {
  return cluster(three_digits(number) + "." + name);
}

std::string Folder::bundle(int round, const std::string& name) const {
  return cluster(three_digits(round) + "/" + name);
}

int Folder::last_round() const {
  int out = 0;
  std::error_code error;
  for (fs::directory_iterator entry(cluster(""), error), end; !error && entry != end;
       entry.increment(error)) {
    const std::string name = entry->path().filename().string();
    int number = 0;
    const auto [rest, bad] = std::from_chars(name.data(), name.data() + name.size(), number);
    if (bad == std::errc{} && rest - name.data() <= 6 && std::string(rest) == ".plan.json")
      out = std::max(out, number);
  }
  return out;
}

void Folder::create(int round) const {
  const std::string inner = round > 0 ? bundle(round, "") : cluster("");
  std::error_code error;
  fs::create_directories(inner, error);
  if (error) throw WorkError(inner, "cannot make the folder: " + error.message());
}

void refuse_unknown(const Folder& folder) {
  if (folder.last_round() == 0)
    throw InputError(folder.path(), "nothing was submitted there; expected a folder of nullcone-submit");
}

void write_text(const std::string& path, const std::string& text) {
  WholeFile file(path);
  file.stream() << text;
  file.finish();
}

std::string read_text(const std::string& path) {
  std::ifstream in(path, std::ios::binary);
  std::ostringstream out;
  out << in.rdbuf();
  return in ? std::move(out).str() : "";
}

double modified(const std::string& path) {
  struct stat file {};
  if (::stat(path.c_str(), &file) != 0) return 0;
  return static_cast<double>(file.st_mtim.tv_sec) + 1e-9 * static_cast<double>(file.st_mtim.tv_nsec);
}

double now() {
  return std::chrono::duration<double>(std::chrono::system_clock::now().time_since_epoch()).count();
}

std::string program_folder() { return fs::read_symlink("/proc/self/exe").parent_path().string(); }

}  // namespace nullcone::cluster
