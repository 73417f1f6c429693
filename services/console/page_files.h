/// @file
/// The files of the console's page, embedded in the program.

#pragma once

#include <string_view>
#include <vector>

namespace spindrift {

struct PageFile {
  std::string_view path;  ///< Path in the URL, as "/index.html".
  std::string_view text;
};

std::vector<PageFile> page_files();

}  // namespace spindrift
