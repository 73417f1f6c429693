/// @file
/// GoogleTest with the matchers that most tests use, and those of the project's own types.

#pragma once

#include <gmock/gmock.h>
#include <gtest/gtest.h>

#include "pipelines/core/expected.h"

namespace spindrift {

using ::testing::_;
using ::testing::AllOf;
using ::testing::Contains;
using ::testing::Each;
using ::testing::ElementsAre;
using ::testing::ElementsAreArray;
using ::testing::EndsWith;
using ::testing::Field;
using ::testing::HasSubstr;
using ::testing::IsEmpty;
using ::testing::Not;
using ::testing::SizeIs;
using ::testing::StartsWith;

/// Matches an outcome that is an error with this code and a message that matches.
MATCHER_P2(IsRefused, code, message, "") {
  if (arg.has_value()) {
    *result_listener << "which is a value";
    return false;
  }
  *result_listener << "whose message is " << arg.error().message;
  return arg.error().code == code &&
         ::testing::ExplainMatchResult(message, arg.error().message, result_listener);
}

}  // namespace spindrift
