#include "pipelines/time/utc.h"

#include <algorithm>
#include <chrono>
#include <cstdint>
#include <random>
#include <string>
#include <utility>
#include <vector>

#include "tests/support/matchers.h"

namespace spindrift::utc_test {

using std::chrono::nanoseconds;
using std::chrono::seconds;

std::int64_t utc_ns(std::string_view text) { return tai_ns(parse_utc(text).value()); }

TEST(Utc, EpochsOfTheTwoPassesAreThoseOfTheirTelemetry) {
  // Unix seconds of the same civil time (date -u) plus TAI - UTC of the year.
  EXPECT_EQ(utc_ns("2026-11-20T03:00:00Z"), (1'795'143'600LL + 37) * 1'000'000'000);
  EXPECT_EQ(utc_ns("1996-02-17T23:32:00Z"), (824'599'920LL + 30) * 1'000'000'000);
}

TEST(Utc, BeginsTenSecondsBehindTai) {
  EXPECT_EQ(utc_ns("1972-01-01T00:00:00"), (63'072'000LL + 10) * 1'000'000'000);
}

TEST(Utc, OffsetsAreThoseOfIersBulletinC) {
  // IERS, TAI - UTC: 28 values from 1972 to 2017, none since.
  const std::vector<LeapSecond> table = leap_seconds();
  ASSERT_GE(table.size(), 28U);
  for (std::size_t i = 0; i < 28; ++i) {
    EXPECT_EQ(table[i].tai_minus_utc_s, 10 + static_cast<int>(i));
  }
  EXPECT_EQ(tai_ns(table[0].start), utc_ns("1972-01-01T00:00:00"));
  EXPECT_EQ(tai_ns(table[1].start), utc_ns("1972-07-01T00:00:00"));
  EXPECT_EQ(tai_ns(table[22].start), utc_ns("1999-01-01T00:00:00"));
  EXPECT_EQ(tai_ns(table[27].start), utc_ns("2017-01-01T00:00:00"));
}

TEST(Utc, LeapSecondIsAsLongAsAnyOther) {
  const TaiTime before = parse_utc("2016-12-31T23:59:59").value();
  EXPECT_EQ(parse_utc("2016-12-31T23:59:60").value() - before, seconds{1});
  EXPECT_EQ(parse_utc("2016-12-31T23:59:60.999999999").value() - before,
            nanoseconds{1'999'999'999});
  EXPECT_EQ(parse_utc("2017-01-01T00:00:00").value() - before, seconds{2});
  EXPECT_EQ(format_utc(before + nanoseconds{1'500'000'000}), "2016-12-31T23:59:60.500Z");
}

TEST(Utc, EveryLeapSecondIsWrittenAsTheSixtyFirst) {
  const std::vector<LeapSecond> table = leap_seconds();
  for (std::size_t i = 1; i < table.size(); ++i) {
    const TaiTime start = table[i].start;
    SCOPED_TRACE(format_utc(start));
    EXPECT_THAT(format_utc(start, 0), EndsWith("T00:00:00Z"));
    EXPECT_THAT(format_utc(start - nanoseconds{1}, 9), EndsWith("T23:59:60.999999999Z"));
    EXPECT_THAT(format_utc(start - seconds{1}, 9), EndsWith("T23:59:60.000000000Z"));
    EXPECT_THAT(format_utc(start - nanoseconds{1'000'000'001}, 9),
                EndsWith("T23:59:59.999999999Z"));
  }
}

TEST(Utc, ReadsBackToTheNanosecondWhatItWritesAlsoAcrossEveryLeapSecond) {
  const TaiTime first = leap_seconds().front().start;
  std::mt19937_64 rng{1972};
  std::uniform_int_distribution<std::int64_t> any_ns{tai_ns(first), utc_ns("2189-12-31T00:00:00")};
  std::vector<TaiTime> times(20'000);
  std::ranges::generate(times, [&] { return tai_from_ns(any_ns(rng)); });
  std::uniform_int_distribution<std::int64_t> around_ns{-3'000'000'000, 3'000'000'000};
  for (const LeapSecond& leap : leap_seconds()) {
    for (int trial = 0; trial < 200; ++trial) {
      times.push_back(std::max(first, leap.start + nanoseconds{around_ns(rng)}));
    }
  }
  for (const TaiTime t : times) {
    const std::string text = format_utc(t, 9);
    ASSERT_EQ(parse_utc(text).value(), t) << text;
  }
}

TEST(Utc, TextGrowsWithTime) {
  // ISO 8601 texts of equal length sort by time, which reveals any backward jump.
  std::mt19937_64 rng{8601};
  std::uniform_int_distribution<std::int64_t> step_ns{1, 400'000'000};
  TaiTime t = parse_utc("2016-12-31T23:59:00").value();
  std::string last = format_utc(t, 9);
  for (int step = 0; step < 600; ++step) {
    t += nanoseconds{step_ns(rng)};
    std::string text = format_utc(t, 9);
    ASSERT_LT(last, text);
    last = std::move(text);
  }
}

TEST(Utc, DayOfYearAndCalendarAgree) {
  EXPECT_EQ(utc_ns("2026-324T03:00:00"), utc_ns("2026-11-20T03:00:00"));
  EXPECT_EQ(utc_ns("2024-366T00:00:00"), utc_ns("2024-12-31T00:00:00"));
  EXPECT_EQ(utc_ns("2023-001T00:00:00"), utc_ns("2023-01-01T00:00:00"));
  EXPECT_EQ(utc_ns("2016-366T23:59:60Z"), utc_ns("2016-12-31T23:59:60Z"));
}

TEST(Utc, DecimalsAreRoundedToTheNanosecond) {
  const std::int64_t second = utc_ns("2026-01-01T00:00:01");
  EXPECT_EQ(utc_ns("2026-01-01T00:00:01.5"), second + 500'000'000);
  EXPECT_EQ(utc_ns("2026-01-01T00:00:01.000000001Z"), second + 1);
  EXPECT_EQ(utc_ns("2026-01-01T00:00:01.0000000014999"), second + 1);
  EXPECT_EQ(utc_ns("2026-01-01T00:00:01.0000000015"), second + 2);
  EXPECT_EQ(utc_ns("2026-01-01T00:00:00.9999999999"), second);
}

TEST(Utc, DecimalsWrittenAreTruncated) {
  const TaiTime t = parse_utc("2026-01-01T00:00:59.999999999").value();
  EXPECT_EQ(format_utc(t, 0), "2026-01-01T00:00:59Z");
  EXPECT_EQ(format_utc(t), "2026-01-01T00:00:59.999Z");
  EXPECT_EQ(format_utc(t, 9), "2026-01-01T00:00:59.999999999Z");
}

TEST(Utc, YearsAfterTheLeapSecondTableKeepItsLastOffset) {
  EXPECT_EQ(utc_ns("2040-01-01T00:00:00") - tai_ns(parse_tai("2040-01-01T00:00:00").value()),
            37'000'000'000);
}

TEST(Utc, IsRefusedBefore1972) {
  EXPECT_THAT(parse_utc("1971-12-31T23:59:59"),
              IsRefused(ErrorCode::InvalidInput, HasSubstr("1972")));
}

TEST(Utc, TimeBefore1972IsWrittenAsTai) {
  EXPECT_EQ(format_utc(tai_from_ns(0), 0), "1970-01-01T00:00:00 TAI");
  EXPECT_EQ(format_utc(tai_from_ns(-1), 9), "1969-12-31T23:59:59.999999999 TAI");
}

TEST(Tai, HasNoLeapSeconds) {
  EXPECT_EQ(tai_ns(parse_tai("1970-01-01T00:00:00").value()), 0);
  EXPECT_EQ(parse_tai("2017-01-01T00:00:00").value() - parse_tai("2016-12-31T23:59:59").value(),
            seconds{1});
  EXPECT_FALSE(parse_tai("2016-12-31T23:59:60"));
}

TEST(Utc, RefusesWhatIsNoTime) {
  const std::vector<std::pair<std::string, std::string>> cases = {
      {"", "must read"},
      {"2026-11-20", "must read"},
      {"2026-11-20 03:00:00", "must read"},
      {"2026-11-20T03:00", "must read"},
      {"20261-1-20T03:00:00", "must read"},
      {"-026-11-20T03:00:00", "must read"},
      {"2026-11-20T03:00:00.", "decimal fraction"},
      {"2026-11-20T03:00:00,5", "decimal fraction"},
      {"2026-11-20T03:00:00+01:00", "decimal fraction"},
      {"2026-11-20T03:00:00.1e3", "decimal fraction"},
      {"2026-11-20T03:00:00ZZ", "decimal fraction"},
      {"2026-13-01T00:00:00", "calendar"},
      {"2026-00-01T00:00:00", "calendar"},
      {"2026-02-29T00:00:00", "calendar"},
      {"2026-000T00:00:00", "calendar"},
      {"2026-366T00:00:00", "calendar"},
      {"2026-11-20T24:00:00", "time of day"},
      {"2026-11-20T03:60:00", "time of day"},
      {"2026-11-20T03:00:60", "time of day"},
      {"2026-11-20T23:59:61", "time of day"},
      {"2026-11-20T23:59:60", "no leap second"},
      {"2190-01-01T00:00:00", "2189"},
      {"9999-12-31T00:00:00", "2189"},
  };
  for (const auto& [text, reason] : cases) {
    SCOPED_TRACE(text);
    EXPECT_THAT(parse_utc(text), IsRefused(ErrorCode::InvalidInput,
                                           AllOf(HasSubstr("'" + text + "'"), HasSubstr(reason))));
  }
}

}  // namespace spindrift::utc_test
