#include "apps/cluster/lock.h"

#include <fcntl.h>
#include <sys/stat.h>
#include <unistd.h>

#include <cerrno>
#include <chrono>
#include <csignal>
#include <cstring>
#include <filesystem>
#include <fstream>
#include <sstream>

#include "core/base/error.h"
#include "core/base/version.h"
#include "core/record/whole_file.h"

namespace nullcone::cluster {

namespace fs = std::filesystem;

namespace {

constexpr std::chrono::seconds kRenewal{20};
constexpr double kOld_s = 120;  // six renewals missed

/// When a process began, in ticks since the host did; empty if there is none. Its number alone is given to
/// others when it is dead.
std::string beginning_of(pid_t process) {
  const std::string stat = read_text("/proc/" + std::to_string(process) + "/stat");
  const std::size_t name_end = stat.rfind(')');  // names may hold anything
  if (name_end == std::string::npos) return "";
  std::istringstream fields(stat.substr(name_end + 1));
  std::string field;
  constexpr int kBeginning = 20;  // after the name (proc(5): starttime)
  for (int i = 0; i < kBeginning; ++i) fields >> field;
  return field;
}

/// Process numbers mean something within one name space of one start of one host.
std::string numbering() {
  std::error_code error;
  std::string boot = read_text("/proc/sys/kernel/random/boot_id");
  while (!boot.empty() && boot.back() == '\n') boot.pop_back();
  return boot + "/" + fs::read_symlink("/proc/self/ns/pid", error).string();
}

struct Holder {
  std::string host, numbering, beginning;
  pid_t process = 0;

  static Holder self() { return {host_name(), cluster::numbering(), beginning_of(::getpid()), ::getpid()}; }
  std::string text() const {
    std::ostringstream out;
    out << host << '\n' << process << '\n' << numbering << '\n' << beginning << '\n';
    return out.str();
  }
  static Holder from(const std::string& text) {
    Holder out;
    std::istringstream in(text);
    std::string process;
    std::getline(in, out.host), std::getline(in, process);
    std::getline(in, out.numbering), std::getline(in, out.beginning);
    out.process = static_cast<pid_t>(std::strtol(process.c_str(), nullptr, 10));
    return out;
  }
};

/// `taken` or renewed then; both times by the clock of the file system.
bool stale(double taken, const Holder& holder, double now) {
  if (holder.process > 0 && holder.numbering == numbering()) {
    if (::kill(holder.process, 0) != 0) return errno == ESRCH;  // else it lives, and is another user's
    return beginning_of(holder.process) != holder.beginning;
  }
  return now - taken > kOld_s;
}

/// A file of our own beside the lock, with our name in it, that is removed in the end.
class Claim {
 public:
  explicit Claim(const std::string& lock)
      : path_(lock + "." + host_name() + "." + std::to_string(::getpid())) {
    ::unlink(path_.c_str());  // of one with our number who was killed
    const Descriptor file(path_, O_WRONLY | O_CREAT | O_EXCL);
    const std::string text = Holder::self().text();
    if (!file || ::write(file.number(), text.data(), text.size()) != static_cast<ssize_t>(text.size()))
      throw WorkError(path_, "cannot write there");
  }
  ~Claim() { ::unlink(path_.c_str()); }
  Claim(const Claim&) = delete;
  Claim& operator=(const Claim&) = delete;

  bool becomes(const std::string& lock) const {
    if (::link(path_.c_str(), lock.c_str()) == 0) return true;
    struct stat file {};  // over a network the answer may have been lost, not the link
    const int error = errno;
    const bool linked = ::stat(path_.c_str(), &file) == 0 && file.st_nlink > 1;
    errno = error;
    return linked;
  }
  /// The time of the file system.
  double now() const {
    ::utimensat(AT_FDCWD, path_.c_str(), nullptr, 0);
    return modified(path_);
  }

 private:
  std::string path_;
};

/// Puts a stale lock away. Somebody else may do so at the same moment, and even hold the next one already:
/// then that is what we took, and it goes back.
void put_away(const std::string& lock, const std::string& judged) {
  const std::string away = lock + ".stale." + host_name() + "." + std::to_string(::getpid());
  if (std::rename(lock.c_str(), away.c_str()) != 0) return;
  if (read_text(away) == judged || ::link(away.c_str(), lock.c_str()) == 0) ::unlink(away.c_str());
}

}  // namespace

SubmissionLock::SubmissionLock(const Folder& folder, double patience_s) : path_(folder.cluster("lock")) {
  const Claim claim(path_);
  const auto end = std::chrono::steady_clock::now() + std::chrono::duration<double>(patience_s);
  while (!claim.becomes(path_)) {
    const int error = errno;
    const std::string text = read_text(path_);
    const Holder holder = Holder::from(text);
    if (error != EEXIST) throw WorkError(path_, "cannot be made: " + std::string(std::strerror(error)));
    const double taken = modified(path_);  // 0 if it was given back just now
    if (taken > 0 && stale(taken, holder, claim.now())) {
      put_away(path_, text);
    } else if (std::chrono::steady_clock::now() > end) {
      throw WorkError(folder.path(), "another nullcone-submit is at work there (process " +
                                         std::to_string(holder.process) + " on " + printable(holder.host) +
                                         ")");
    } else {
      std::this_thread::sleep_for(std::chrono::milliseconds(100));
    }
  }
  renewal_ = std::thread([this] { renew(); });
}

SubmissionLock::~SubmissionLock() {
  {
    const std::lock_guard hold(mutex_);
    ending_ = true;
  }
  end_.notify_all();
  renewal_.join();
  if (held()) ::unlink(path_.c_str());
}

bool SubmissionLock::held() const { return read_text(path_) == Holder::self().text(); }

void SubmissionLock::renew() {
  std::unique_lock hold(mutex_);
  while (!end_.wait_for(hold, kRenewal, [this] { return ending_; }))
    if (held()) ::utimensat(AT_FDCWD, path_.c_str(), nullptr, 0);
}

bool is_locked(const Folder& folder) {
  const std::string path = folder.cluster("lock"), text = read_text(path);
  const double taken = modified(path);
  return taken > 0 && !stale(taken, Holder::from(text), now());
}

}  // namespace nullcone::cluster
