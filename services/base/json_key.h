/// @file
/// Converts words to a JSON key.

#pragma once

#include <algorithm>
#include <string>
#include <string_view>

namespace spindrift {

/// Converts "coded frames" to "coded_frames".
inline std::string json_key(std::string_view words) {
  std::string key{words};
  std::replace(key.begin(), key.end(), ' ', '_');
  return key;
}

}  // namespace spindrift
