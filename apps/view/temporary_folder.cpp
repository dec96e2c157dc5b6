#include "apps/view/temporary_folder.h"

#include <stdlib.h>  // mkdtemp

#include <cerrno>
#include <cstring>
#include <filesystem>

#include "core/base/error.h"

namespace nullcone::view {

TemporaryFolder::TemporaryFolder() {
  std::error_code error;
  const std::filesystem::path place = std::filesystem::temp_directory_path(error);
  if (error) throw WorkError("TMPDIR", error.message());
  path_ = place / "nullcone-view-XXXXXX";
  if (mkdtemp(path_.data()) == nullptr) throw WorkError(path_, std::strerror(errno));
}

TemporaryFolder::~TemporaryFolder() {
  std::error_code ignored;
  std::filesystem::remove_all(path_, ignored);
}

}  // namespace nullcone::view
