// Any bytes, read as a dataset file: they give a dataset or a complaint, never anything else.
#include <sys/mman.h>
#include <unistd.h>

#include <cstdint>
#include <string>

#include "core/base/error.h"
#include "core/record/dataset_file.h"

extern "C" int LLVMFuzzerTestOneInput(const std::uint8_t* data, std::size_t size) {
  const int file = ::memfd_create("dataset", MFD_CLOEXEC);
  if (file < 0 || ::write(file, data, size) != static_cast<ssize_t>(size)) return -1;
  const std::string path = "/proc/self/fd/" + std::to_string(file);
  try {
    nullcone::verify_file(path);
  } catch (const nullcone::InputError&) {
  }
  try {  // some channels only
    nullcone::read_dataset(path, nullcone::ChannelSet::of("shift") | nullcone::ChannelSet::of("id"));
  } catch (const nullcone::InputError&) {
  }
  ::close(file);
  return 0;
}
