#include "core/scene/mesh_file.h"

#include <fcntl.h>
#include <sys/stat.h>
#include <unistd.h>

#include <cerrno>
#include <cstring>

#include "core/base/error.h"

namespace nullcone {

MeshFile::MeshFile(const std::string& path) : path_(path) {
  const int file =
      ::open(path.c_str(), O_RDONLY | O_CLOEXEC | O_NONBLOCK);  // no waiting for writers of pipes
  if (file < 0) refuse(std::string("cannot open the file: ") + std::strerror(errno));
  file_.reset(::fdopen(file, "rb"));
  struct stat found {};
  if (!file_ || ::fstat(file, &found) != 0) refuse("cannot open the file");
  if (S_ISDIR(found.st_mode)) refuse("is a folder; expected a mesh");
  if (!S_ISREG(found.st_mode)) refuse("is not a plain file; expected a mesh");
  if (found.st_size == 0) refuse("is empty; expected a mesh");
  size_ = static_cast<std::size_t>(found.st_size);
  if (size_ > kLargest) refuse("is larger than 1 GiB; meshes of that size are not read");
}

std::size_t MeshFile::read(char* to, std::size_t count) {
  const std::size_t got = std::fread(to, 1, count, file_.get());
  if (got < count && std::ferror(file_.get()) != 0) throw WorkError(path_, "cannot read the file");
  hash_.add(std::string_view(to, got));
  return got;
}

std::string MeshFile::read_all() {
  std::string out(size_, '\0');
  out.resize(read(out.data(), size_));
  return out;
}

void MeshFile::refuse(std::string_view message) const { throw InputError(path_, message); }

}  // namespace nullcone
