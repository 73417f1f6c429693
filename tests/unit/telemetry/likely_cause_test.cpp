#include "services/telemetry/likely_cause.h"

#include "services/telemetry/csv.h"
#include "services/telemetry/parse_row.h"
#include "services/telemetry/telemetry_kinds.h"
#include "tests/support/matchers.h"

namespace spindrift::likely_cause_test {

template <class Value>
std::string why_refused(std::string_view row) {
  Value value{};
  CsvFields fields{row};
  const auto parsed = parse_row(fields.fields(), value);
  return parsed ? std::string{} : parsed.error().message;
}

TEST(LikelyCause, IsSaidOfTimesThatAreNoNanoseconds) {
  const auto why = [](const std::string& t) { return why_refused<Pulse>(t + ",sun1"); };
  for (const char* const seconds : {"1795143637", "1795143637.5", "1.7951436375e9"}) {
    EXPECT_THAT(why(seconds), EndsWith("; looks like s, not ns")) << seconds;
  }
  EXPECT_THAT(why("1795143637536"), EndsWith(" ns; looks like ms, not ns"));
  EXPECT_THAT(why("1795143637536787"), EndsWith(" ns; looks like us, not ns"));
  EXPECT_THAT(why("2026-11-20T03:00:00Z"),
              EndsWith("; looks like a date, not ns of TAI since 1970"));
  EXPECT_THAT(why("1.79E+18"), EndsWith("; looks rounded by a spreadsheet: all digits are needed"));
  for (const char* const any : {"", "now", "0", "-5"}) {
    EXPECT_THAT(why(any), Not(HasSubstr("looks"))) << any;
  }
}

TEST(LikelyCause, IsSaidOfColumnsThatAreTooManyOrTooFew) {
  EXPECT_EQ(likely_separator("1795143637000000000;0,5;0,1;0,2", 4),
            "; looks separated by semicolons, not commas");
  EXPECT_EQ(likely_separator("1795143637000000000,sun1,", 2),
            "; a comma too many stands at its end");
  EXPECT_EQ(likely_separator("1795143637000000000,0,5,0,1,0,2", 4),
            "; looks like decimal commas, not points");
  EXPECT_EQ(likely_separator("1795143637000000000", 2), "");
}

TEST(LikelyCause, IsSaidOfAThousandTimesTheUnit) {
  const std::string t = "1795143637000000000,";
  EXPECT_THAT(why_refused<CodedFrame>(t + "1000,100,200,300,400,500"),
              EndsWith("must be above 0, at most 60 s; looks like ms"));
  EXPECT_THAT(why_refused<CodedFrame>(t + "1,100,200,300,400,500"),
              EndsWith("must be 0 to two periods, 2 s; looks like ms"));
  EXPECT_THAT(why_refused<TimedOrbitState>(t + "7000000,0,0,0,7.5,0"), EndsWith("; looks like m"));
  EXPECT_THAT(why_refused<TimedOrbitState>(t + "7000,0,0,0,7500,0"), EndsWith("; looks like m/s"));
  EXPECT_THAT(why_refused<TimedOrbitState>(t + "7,0,0,0,7.5,0"), Not(HasSubstr("looks")));
}

}  // namespace spindrift::likely_cause_test
