/// @file
/// Parses the target of an HTTP request.

#pragma once

#include <cstdint>
#include <map>
#include <string>
#include <string_view>

#include "pipelines/core/expected.h"

namespace spindrift {

struct RequestTarget {
  std::string path;
  std::map<std::string, std::string> query;

  /// @return InvalidInput, saying which parameter is missing, or what it must be.
  Expected<std::string> text(const std::string& parameter) const;
  Expected<std::int64_t> integer(const std::string& parameter, std::int64_t least,
                                 std::int64_t most) const;
};

/// @return InvalidInput for a malformed escape and for a parameter that is given twice.
Expected<RequestTarget> request_target(std::string_view text);

}  // namespace spindrift
