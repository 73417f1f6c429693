/// @file
/// Expectations on the checks of `spindrift doctor`.

#pragma once

#include <gmock/gmock.h>
#include <gtest/gtest.h>

#include <algorithm>
#include <string>
#include <vector>

#include "services/doctor/check.h"

namespace spindrift::doctor {

inline Check named(const std::vector<Check>& checks, const std::string& name) {
  const auto found = std::find_if(checks.begin(), checks.end(),
                                  [&](const Check& check) { return check.name == name; });
  return found == checks.end() ? Check{"absent: " + name, Verdict::Failure, "", ""} : *found;
}

/// Expects advice from every check that is not OK, and a finding from every check.
inline void expect_advice(const std::vector<Check>& checks) {
  for (const Check& check : checks) {
    if (check.verdict != Verdict::Ok) {
      EXPECT_THAT(check.advice, ::testing::Not(::testing::IsEmpty())) << check.name;
    }
    EXPECT_THAT(check.found, ::testing::Not(::testing::IsEmpty())) << check.name;
  }
}

}  // namespace spindrift::doctor
