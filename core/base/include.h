// Documents in several files: {"include": "file.json"} stands for what that file holds.
#pragma once

#include <map>
#include <nlohmann/json.hpp>
#include <string>
#include <string_view>

#include "core/base/error.h"

namespace nullcone {

/// Where a part of a document was written.
struct JsonOrigin {
  std::string file, pointer;
  /// By key (escaped) or index: those that do not stand under theirs in this same place.
  std::map<std::string, JsonOrigin> parts = {};

  JsonOrigin part(const std::string& key) const;
  /// A complaint "place: /pointer: …" about the whole document, told of where that part was written.
  InputError told(const InputError& error, const std::string& place) const;
};

/// A document with all that it includes, which knows where its parts come from.
struct WholeJson {
  nlohmann::json document;
  JsonOrigin origin;
  std::string path = {};  ///< of the file that includes all others

  /// Does `work`, which reads the document. Complaints name the file and the pointer where what they are
  /// about was written.
  template <class Work>
  auto read(const Work& work) const {
    try {
      return work();
    } catch (const InputError& error) {
      throw origin.told(error, path);
    }
  }
};

/// Whether a path stays below where it starts: relative, without "..".
bool stays_below(std::string_view path);

/// Puts in place what `document`, which was read from the file `path`, includes: an object with "include" is
/// the object in that file, with the other entries put over it as a merge patch (RFC 7386); in a list,
/// {"include": …} stands for all elements of the list in that file. Names are relative to the file in which
/// they stand; nothing outside of the folder of `path` is read. What names the schema of a file is left out.
/// Throws InputError.
WholeJson include_files(nlohmann::json document, const std::string& path);

}  // namespace nullcone
