#include "services/base/warning.h"

#include "tests/support/matchers.h"

namespace spindrift::warning_test {

TEST(Warning, IsKeptWithItsCodeAndValuesTheFirstThousand) {
  const auto before = with_warnings({{"runs", 2}});
  EXPECT_EQ(before["runs"], 2);
  const std::size_t first = before["warnings"].size();
  for (int i = 0; i < 1100; ++i) {
    warn("bad_rows", {{"rows", i}}, "bad rows of telemetry");
  }
  const auto warnings = with_warnings(nlohmann::json::object())["warnings"];
  ASSERT_EQ(warnings.size(), 1000U);
  EXPECT_EQ(warnings[first], nlohmann::json({{"code", "bad_rows"},
                                             {"values", {{"rows", 0}}},
                                             {"text", "bad rows of telemetry"}}));
}

}  // namespace spindrift::warning_test
