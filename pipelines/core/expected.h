/// @file
/// The error type of spindrift: all failures are returned as values.

#pragma once

#include <string>
#include <tl/expected.hpp>
#include <utility>

namespace spindrift {

/// The code tells the caller how to react; the message is for a person.
enum class ErrorCode {
  InvalidConfiguration,  ///< Wrong before any telemetry arrived: refuse to start.
  InvalidInput,          ///< This sample or row cannot be true: record it and go on.
  Unobservable,          ///< Plausible input that does not determine the answer.
  NoCoverage,            ///< The orbit or another table ends before the time asked for.
  Unavailable,           ///< Disk, network or a lock failed: stop, or try again.
};

struct Error {
  ErrorCode code;
  std::string message;  ///< Quantity, value with unit, and the bound it broke.
};

/// `std::expected` once the toolchain is C++23; same interface until then.
template <class T>
using Expected = tl::expected<T, Error>;

using Unexpected = tl::unexpected<Error>;

inline Unexpected unobservable(std::string message) {
  return Unexpected{{ErrorCode::Unobservable, std::move(message)}};
}

}  // namespace spindrift
