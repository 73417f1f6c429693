/// @file
/// The value of a function that may refuse, for tests that go on from it.

#pragma once

#include <stdexcept>
#include <utility>

#include "pipelines/core/expected.h"

namespace spindrift {

/// Returns the value. A test that gets an error instead ends there, with the error's message.
template <class Value>
Value value_or_throw(Expected<Value> outcome) {
  if (!outcome) {
    throw std::runtime_error{outcome.error().message};
  }
  return *std::move(outcome);
}

}  // namespace spindrift
