/// @file
/// Expectations on the traits of every kind of telemetry.

#pragma once

#include <gmock/gmock.h>
#include <gtest/gtest.h>

#include <string>
#include <string_view>
#include <vector>

#include "services/telemetry/csv.h"
#include "services/telemetry/parse_row.h"
#include "services/telemetry/telemetry_layout.h"

namespace spindrift::testing {

struct BadFields {
  std::string_view row;
  const char* reason;
};

/// Parses a CSV row with a valid time in front of it.
template <class Value>
Expected<Value> value_of_row(std::string_view row) {
  const std::string line = "1772337697000000000," + std::string{row};
  Value value;
  return parse_row(CsvFields{line}.fields(), value).map([&value] { return value; });
}

template <class Value>
void expect_refused(const std::vector<BadFields>& rows) {
  for (const BadFields& bad : rows) {
    SCOPED_TRACE(bad.row);
    const auto refused = value_of_row<Value>(bad.row);
    ASSERT_FALSE(refused);
    EXPECT_EQ(refused.error().code, ErrorCode::InvalidInput);
    EXPECT_THAT(refused.error().message, ::testing::HasSubstr(bad.reason));
  }
}

}  // namespace spindrift::testing
