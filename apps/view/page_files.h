// The files of the page, as they were when the program was built.
#pragma once

#include <span>
#include <string_view>

namespace nullcone::view {

struct PageFile {
  std::string_view name, content;
};

/// Made by CMake of apps/view/page/.
std::span<const PageFile> page_files();

}  // namespace nullcone::view
