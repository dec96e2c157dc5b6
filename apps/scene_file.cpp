#include "apps/scene_file.h"

#include <fstream>
#include <vector>

#include "core/base/error.h"
#include "core/base/json.h"
#include "core/record/dataset_file.h"

namespace nullcone {

WholeJson read_scene_file(const std::string& path) {
  std::ifstream in(path, std::ios::binary);  // read once, from the front: it may be a pipe
  if (!in) throw InputError(path, "cannot open the file; expected a scene (.json) or a dataset (.exr)");
  std::string text;
  std::vector<char> block(4);
  while (in.read(block.data(), static_cast<std::streamsize>(block.size())), in.gcount() > 0) {
    text.append(block.data(), static_cast<std::size_t>(in.gcount()));
    if (text == "\x76\x2f\x31\x01") return {parse_json(read_manifest(path).scene, path), {path, ""}, path};
    if (text.size() > std::size_t{64} << 20)
      throw InputError(path, "is larger than 64 MiB; expected a scene");
    block.resize(1 << 16);
  }
  if (in.bad() || text.empty())
    throw InputError(path, "is empty or cannot be read; expected a scene (.json)");
  return include_files(parse_json(text, path), path);
}

}  // namespace nullcone
