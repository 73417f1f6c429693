/// @file
/// Expectations on the checks of `spindrift doctor`.

#pragma once

#include <gmock/gmock.h>
#include <gtest/gtest.h>

#include <algorithm>
#include <functional>
#include <string>
#include <vector>

#include "services/doctor/check.h"
#include "services/doctor/report.h"

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

/// What one check says of facts that are in order but for a change.
template <class Facts>
struct Judged {
  const char* when;
  std::function<void(Facts&)> change;
  const char* check;
  Verdict verdict;
  const char* found = "";  ///< A part of what it found.
};

/// Expects facts in order to pass all checks, and each change of them to be judged as stated, with
/// advice.
template <class Facts, class AllChecks>
void expect_judged(const Facts& in_order, const AllChecks& checks_of,
                   const std::vector<Judged<Facts>>& rows) {
  for (const Check& check : checks_of(in_order)) {
    EXPECT_EQ(check.verdict, Verdict::Ok) << check.name;
  }
  for (const Judged<Facts>& row : rows) {
    SCOPED_TRACE(row.when);
    Facts facts = in_order;
    row.change(facts);
    const std::vector<Check> checks = checks_of(facts);
    EXPECT_EQ(named(checks, row.check).verdict, row.verdict);
    EXPECT_THAT(named(checks, row.check).found, ::testing::HasSubstr(row.found));
    EXPECT_TRUE(row.verdict != Verdict::Ok || worst_of(checks) == Verdict::Ok);
    expect_advice(checks);
  }
}

}  // namespace spindrift::doctor
