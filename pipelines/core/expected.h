/// @file
/// The one way anything in spindrift reports failure: as a value.

#pragma once

#include <string>
#include <tl/expected.hpp>
#include <utility>

namespace spindrift {

/// A code names the decision that the caller can take; the message is for a person.
enum class ErrorCode {
  InvalidConfiguration,  ///< Wrong before any telemetry arrived: refuse to start.
  InvalidInput,          ///< This sample or row cannot be true: record it and go on.
  Unobservable,          ///< Plausible, but it does not determine the answer.
  NoCoverage,            ///< The orbit or another table ends before the time asked for.
  Unavailable,           ///< The world said no (disk, network, lock): stop, or try again.
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
