#include "apps/postrender_movie.h"

#include <fcntl.h>
#include <spawn.h>
#include <sys/wait.h>
#include <unistd.h>

#include <array>
#include <cerrno>
#include <csignal>
#include <cstdio>
#include <cstdlib>
#include <filesystem>
#include <fstream>
#include <memory>
#include <sstream>
#include <utility>

#include "core/base/error.h"

namespace nullcone {

namespace fs = std::filesystem;

namespace {

/// A running ffmpeg that reads pictures from us. It hears no signals of the terminal: we stop it ourselves.
class Ffmpeg {
 public:
  Ffmpeg(const std::string& program, const std::vector<std::string>& arguments) {
    std::array<int, 2> ends{};
    if (!complaints_ || ::pipe2(ends.data(), O_CLOEXEC) != 0) throw WorkError(program, "cannot be started");
    input_ = ends[1];
    std::vector<char*> words = {const_cast<char*>(program.c_str())};
    for (const std::string& word : arguments) words.push_back(const_cast<char*>(word.c_str()));
    words.push_back(nullptr);
    posix_spawn_file_actions_t files;
    posix_spawn_file_actions_init(&files);
    posix_spawn_file_actions_adddup2(&files, ends[0], STDIN_FILENO);
    posix_spawn_file_actions_addopen(&files, STDOUT_FILENO, "/dev/null", O_WRONLY, 0);
    posix_spawn_file_actions_adddup2(&files, fileno(complaints_.get()), STDERR_FILENO);
    posix_spawnattr_t attributes;
    posix_spawnattr_init(&attributes);
    posix_spawnattr_setflags(&attributes, POSIX_SPAWN_SETPGROUP);
    const int error = ::posix_spawn(&process_, program.c_str(), &files, &attributes, words.data(), environ);
    posix_spawnattr_destroy(&attributes);
    posix_spawn_file_actions_destroy(&files);
    ::close(ends[0]);
    if (error != 0) process_ = -1;
    if (error != 0) throw WorkError(program, "cannot be started");
  }
  ~Ffmpeg() {
    if (input_ >= 0) ::close(input_);
    if (process_ < 0) return;
    ::kill(process_, SIGKILL);
    ::waitpid(process_, nullptr, 0);
  }
  Ffmpeg(const Ffmpeg&) = delete;
  Ffmpeg& operator=(const Ffmpeg&) = delete;

  /// False when it reads no more.
  bool feed(const std::string& bytes) const {
    for (std::size_t done = 0; done < bytes.size();) {
      const ssize_t n = ::write(input_, bytes.data() + done, bytes.size() - done);
      if (n < 0 && errno == EINTR) continue;
      if (n < 0) return false;
      done += static_cast<std::size_t>(n);
    }
    return true;
  }
  /// Whether it ends well.
  bool finish() {
    ::close(std::exchange(input_, -1));
    int status = 0;
    while (::waitpid(process_, &status, 0) < 0 && errno == EINTR) {
    }
    process_ = -1;
    return WIFEXITED(status) && WEXITSTATUS(status) == 0;
  }
  std::string last_complaint() const {
    std::rewind(complaints_.get());
    std::string last;
    std::array<char, 400> line{};
    while (std::fgets(line.data(), line.size(), complaints_.get()) != nullptr) last = line.data();
    while (!last.empty() && last.back() == '\n') last.pop_back();
    return last.empty() ? "it says nothing" : last;
  }

 private:
  struct Close {
    void operator()(std::FILE* file) const { std::fclose(file); }
  };
  std::unique_ptr<std::FILE, Close> complaints_{std::tmpfile()};
  pid_t process_ = -1;
  int input_ = -1;
};

/// Removed unless it is renamed.
struct PartOf {
  explicit PartOf(const std::string& path) : name(path + ".part" + std::to_string(::getpid())) {}
  ~PartOf() { ::unlink(name.c_str()); }
  PartOf(const PartOf&) = delete;
  PartOf& operator=(const PartOf&) = delete;
  std::string name;
};

/// In small letters, with its dot.
std::string ending_of(const std::string& path) {
  std::string out = fs::path(path).extension().string();
  for (char& c : out) c = c >= 'A' && c <= 'Z' ? static_cast<char>(c - 'A' + 'a') : c;
  return out;
}

std::string bytes_of(const std::string& path) {
  std::ifstream in(path, std::ios::binary);
  std::ostringstream out;
  out << in.rdbuf();
  if (!in || out.str().empty()) throw WorkError(path, "cannot be read for the movie");
  return std::move(out).str();
}

std::vector<std::string> arguments_for(const std::string& movie, const std::string& part, bool png,
                                       double fps) {
  std::ostringstream rate;
  rate << fps;
  return {"-hide_banner",
          "-loglevel",
          "error",
          "-y",
          "-f",
          "image2pipe",
          "-framerate",
          rate.str(),
          "-c:v",
          png ? "png" : "mjpeg",
          "-i",
          "pipe:0",
          "-vf",
          "pad=ceil(iw/2)*2:ceil(ih/2)*2,scale=out_color_matrix=bt709:out_range=tv,format=yuv420p",
          "-c:v",
          "libx264",
          "-crf",
          "16",
          "-color_range",
          "tv",
          "-colorspace",
          "bt709",
          "-color_primaries",
          "bt709",
          "-color_trc",
          "iec61966-2-1",
          "-movflags",
          "+faststart",
          "-f",
          movie.ends_with(".mp4") ? "mp4" : "matroska",
          "file:" + part};
}

}  // namespace

void check_movie_name(const std::string& path) {
  if (path.size() < 5 || !(path.ends_with(".mp4") || path.ends_with(".mkv")))
    throw InputError("--movie", "'" + printable(path, 80) + "' is no name of a movie; expected .mp4 or .mkv");
  std::error_code error;
  if (fs::is_directory(path, error)) throw InputError("--movie", path + " is a folder");
  const fs::path folder = fs::path(path).parent_path();
  if (!folder.empty() && !fs::is_directory(folder, error))
    throw InputError("--movie", "the folder is not there: " + printable(folder.string()));
}

void check_movie_pictures(const std::string& picture) {
  const std::string ending = ending_of(picture);
  if (ending != ".png" && ending != ".jpg" && ending != ".jpeg")
    throw InputError("--movie",
                     "is made of the pictures; expected .png or .jpg for them, not " + printable(ending));
}

std::string find_ffmpeg() {
  const char* path = std::getenv("PATH");
  std::istringstream folders(path == nullptr ? "" : path);
  for (std::string folder; std::getline(folders, folder, ':');) {
    const std::string program = (fs::path(folder.empty() ? "." : folder) / "ffmpeg").string();
    if (fs::is_regular_file(program) && ::access(program.c_str(), X_OK) == 0) return program;
  }
  throw InputError("--movie", "needs ffmpeg, which is not on PATH; install it, or leave --movie out");
}

bool write_movie(const std::string& path, const std::vector<std::string>& pictures, double fps,
                 const std::atomic<bool>& stop) {
  std::signal(SIGPIPE, SIG_IGN);  // an ffmpeg that ends early is an error to report, not a death
  const PartOf part(path);
  const bool png = ending_of(pictures.front()) == ".png";
  Ffmpeg ffmpeg(find_ffmpeg(), arguments_for(path, part.name, png, fps));
  bool reads = true;
  for (std::size_t i = 0; i < pictures.size() && reads; ++i) {
    if (stop) return false;
    reads = ffmpeg.feed(bytes_of(pictures[i]));
  }
  if (stop) return false;
  if (!ffmpeg.finish() || !reads)
    throw WorkError(path, "ffmpeg cannot make the movie: " + ffmpeg.last_complaint());
  if (std::rename(part.name.c_str(), path.c_str()) != 0)
    throw WorkError(path, "cannot rename the finished file");
  return true;
}

}  // namespace nullcone
