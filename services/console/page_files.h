/// @file
/// The files of the console's page, which the program holds.

#pragma once

#include <string_view>
#include <vector>

namespace spindrift {

struct PageFile {
  std::string_view path;  ///< As in the URL: "/index.html".
  std::string_view text;
};

std::vector<PageFile> page_files();

}  // namespace spindrift
