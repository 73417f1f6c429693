/// @file
/// Confines the exceptions of one spacecraft's computation to that spacecraft.

#pragma once

#include <exception>
#include <new>
#include <optional>
#include <string>

namespace spindrift {

/// Calls `compute`. A std::bad_alloc passes through: it concerns every spacecraft.
/// @return The message of the exception; empty when `compute` returned.
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
