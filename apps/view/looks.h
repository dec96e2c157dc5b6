// Looks from the page: read as those of the command line, but they name no files of their own choice.
#pragma once

#include <map>
#include <memory>
#include <mutex>
#include <nlohmann/json.hpp>
#include <string>
#include <vector>

#include "apps/view/temporary_folder.h"
#include "postrender/look_source.h"

namespace nullcone::view {

class Looks {
 public:
  /// The look to begin with: that of the dataset in `data`, or the file, with the settings over it. Throws
  /// InputError as the command line does.
  /// What is sent is kept in `folder`, which must outlive this.
  Looks(const Manifest& manifest, const std::string& data, const std::string& look_file,
        const std::vector<std::string>& settings, const TemporaryFolder& folder);

  const nlohmann::json& first() const { return *first_.json; }

  /// A look from JSON text ("look" stands before complaints). Files in it are those of the first look, or
  /// were sent. Throws InputError.
  postrender::Look parse(const nlohmann::json& look, const Manifest& manifest, double frame,
                         postrender::LookInFull* in_full = nullptr) const;

  struct Texture {
    std::string name;  ///< for looks; not always what was asked for, as that may be another picture's
    int width, height;
  };
  /// Takes a picture in. Throws InputError for what is none, and for too many.
  Texture add_texture(const std::string& name, const std::string& bytes);

  /// A complaint as strangers may read it: without the paths of files that were sent.
  std::string told(std::string message) const;

 private:
  using Names = std::map<std::string, std::string>;
  std::shared_ptr<const Names> names() const;
  std::string free_name(const std::string& name) const;
  Texture keep(const std::string& name, const std::string& path, const std::string& sha256);

  postrender::LookDocument first_;
  const TemporaryFolder& folder_;
  mutable std::mutex mutex_;
  std::shared_ptr<const Names> names_;   ///< as looks have them, and their paths
  std::map<std::string, Texture> sent_;  ///< by the SHA-256 of their bytes
  std::size_t bytes_ = 0;
};

}  // namespace nullcone::view
