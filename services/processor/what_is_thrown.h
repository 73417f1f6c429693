/// @file
/// Where one spacecraft's computing fails, and another's does not.

#pragma once

#include <exception>
#include <new>
#include <optional>
#include <string>

namespace spindrift {

/// Calls `compute`. No memory is not one spacecraft's failure: std::bad_alloc goes through.
/// @return what it threw; nothing: it came to its end.
template <class Compute>
std::optional<std::string> what_is_thrown(const Compute& compute) {
  try {
    compute();
    return std::nullopt;
  } catch (const std::bad_alloc&) {
    throw;
  } catch (const std::exception& exception) {
    return exception.what();
  }
}

}  // namespace spindrift
