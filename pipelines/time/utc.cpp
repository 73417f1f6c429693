#include "pipelines/time/utc.h"

#include <erfaextra.h>
#include <fmt/format.h>

#include <algorithm>
#include <charconv>
#include <chrono>
#include <iterator>
#include <optional>

#include "pipelines/core/shown.h"

namespace spindrift {
namespace {

using std::chrono::days;
using std::chrono::nanoseconds;
using std::chrono::seconds;
using std::chrono::sys_days;
using std::chrono::year;

constexpr sys_days kUtcStart{year{1972} / 1 / 1};
// 64-bit nanoseconds hold the difference of any two instants up to 292 years apart.
constexpr sys_days kFirstDay{year{1900} / 1 / 1};
constexpr sys_days kLastDay{year{2189} / 12 / 31};
constexpr std::string_view kCalendarMask = "dddd-dd-ddTdd:dd:dd";
constexpr std::string_view kOrdinalMask = "dddd-dddTdd:dd:dd";
constexpr std::size_t kClockDigits = std::string_view{"dd:dd:dd"}.size();
constexpr std::size_t kNanosecondDigits = 9;

/// Holds a calendar day and the time since its start; 86 400 s or more within a leap second.
struct CivilTime {
  sys_days day;
  seconds whole;
  nanoseconds fraction;
};

Unexpected rejected(std::string_view text, std::string_view what) {
  return Unexpected{{ErrorCode::InvalidInput, fmt::format("time '{}': {}", shown(text), what)}};
}

bool is_digit(char c) { return c >= '0' && c <= '9'; }

bool starts_with_mask(std::string_view text, std::string_view mask) {
  return text.size() >= mask.size() &&
         std::equal(mask.begin(), mask.end(), text.begin(),
                    [](char m, char c) { return m == 'd' ? is_digit(c) : m == c; });
}

/// Returns the number at [begin, begin + count), which the mask has verified to be digits.
int number_at(std::string_view text, std::size_t begin, std::size_t count) {
  int number = 0;
  std::from_chars(text.data() + begin, text.data() + begin + count, number);
  return number;
}

/// Parses the text after the whole seconds: optionally a point with digits, then optionally Z.
std::optional<nanoseconds> fraction_of(std::string_view tail) {
  if (tail.ends_with('Z')) {
    tail.remove_suffix(1);
  }
  if (tail.empty()) {
    return nanoseconds{0};
  }
  const std::string_view digits = tail.substr(1);
  if (tail.front() != '.' || digits.empty() ||
      !std::all_of(digits.begin(), digits.end(), is_digit)) {
    return std::nullopt;
  }
  std::string nine{digits.substr(0, kNanosecondDigits)};
  nine.resize(kNanosecondDigits, '0');
  const bool round_up = digits.size() > kNanosecondDigits && digits[kNanosecondDigits] >= '5';
  return nanoseconds{number_at(nine, 0, kNanosecondDigits) + (round_up ? 1 : 0)};
}

std::optional<sys_days> calendar_day(std::string_view text) {
  const std::chrono::year_month_day date{
      year{number_at(text, 0, 4)}, std::chrono::month{static_cast<unsigned>(number_at(text, 5, 2))},
      std::chrono::day{static_cast<unsigned>(number_at(text, 8, 2))}};
  return date.ok() ? std::optional{sys_days{date}} : std::nullopt;
}

std::optional<sys_days> ordinal_day(std::string_view text) {
  const year of{number_at(text, 0, 4)};
  const int number = number_at(text, 5, 3);
  if (number < 1 || number > (of.is_leap() ? 366 : 365)) {
    return std::nullopt;
  }
  return sys_days{of / 1 / 1} + days{number - 1};
}

Expected<CivilTime> parse_civil(std::string_view text) {
  const bool by_ordinal = starts_with_mask(text, kOrdinalMask);
  if (!by_ordinal && !starts_with_mask(text, kCalendarMask)) {
    return rejected(text, "must read YYYY-MM-DDThh:mm:ss[.d...][Z] or YYYY-DDDThh:mm:ss[.d...][Z]");
  }
  const std::size_t length = by_ordinal ? kOrdinalMask.size() : kCalendarMask.size();
  const std::optional<nanoseconds> fraction = fraction_of(text.substr(length));
  if (!fraction) {
    return rejected(text, "after the seconds only a decimal fraction and a final Z may follow");
  }
  const std::optional<sys_days> day = by_ordinal ? ordinal_day(text) : calendar_day(text);
  if (!day) {
    return rejected(text, "there is no such day in the calendar");
  }
  if (*day < kFirstDay || *day > kLastDay) {
    return rejected(text, "the year must lie in 1900 to 2189");
  }
  const std::size_t clock = length - kClockDigits;
  const int hour = number_at(text, clock, 2);
  const int minute = number_at(text, clock + 3, 2);
  const int second = number_at(text, clock + 6, 2);
  const bool last_minute = hour == 23 && minute == 59;
  if (hour > 23 || minute > 59 || second > (last_minute ? 60 : 59)) {
    return rejected(text, "there is no such time of day");
  }
  return CivilTime{
      .day = *day,
      .whole = std::chrono::hours{hour} + std::chrono::minutes{minute} + seconds{second},
      .fraction = *fraction};
}

bool is_second_60(const CivilTime& time) { return time.whole == days{1}; }

TaiTime tai_at(const CivilTime& time, seconds tai_minus_scale) {
  return TaiTime{time.day.time_since_epoch() + time.whole + tai_minus_scale + time.fraction};
}

TaiTime midnight_tai(sys_days utc_day, int tai_minus_utc_s) {
  return TaiTime{utc_day.time_since_epoch() + seconds{tai_minus_utc_s}};
}

std::vector<LeapSecond> read_erfa_table() {
  eraLEAPSECOND* rows = nullptr;
  const int count = eraGetLeapSeconds(&rows);
  std::vector<LeapSecond> table;
  for (const eraLEAPSECOND* row = rows; row != rows + count; ++row) {
    const sys_days day{year{row->iyear} / row->month / 1};
    if (day >= kUtcStart) {
      const int tai_minus_utc_s = static_cast<int>(row->delat);
      table.push_back({midnight_tai(day, tai_minus_utc_s), tai_minus_utc_s});
    }
  }
  return table;
}

const std::vector<LeapSecond>& leap_second_table() {
  static const std::vector<LeapSecond> table = read_erfa_table();
  return table;
}

sys_days utc_day_of(const LeapSecond& leap) {
  return sys_days{std::chrono::duration_cast<days>(leap.start.time_since_epoch() -
                                                   seconds{leap.tai_minus_utc_s})};
}

std::string civil_text(const CivilTime& time, int decimals) {
  const std::chrono::year_month_day date{time.day};
  // The 61st second belongs to the last minute of its day.
  const seconds in_minutes = is_second_60(time) ? time.whole - seconds{1} : time.whole;
  const std::chrono::hh_mm_ss clock{in_minutes};
  std::string text = fmt::format(
      "{:04}-{:02}-{:02}T{:02}:{:02}:{:02}", static_cast<int>(date.year()),
      static_cast<unsigned>(date.month()), static_cast<unsigned>(date.day()), clock.hours().count(),
      clock.minutes().count(), clock.seconds().count() + (is_second_60(time) ? 1 : 0));
  if (decimals > 0) {
    const std::string nine = fmt::format("{:09}", time.fraction.count());
    text += "." + nine.substr(0, static_cast<std::size_t>(decimals));
  }
  return text;
}

/// Converts a time in a scale whose days all have 86 400 s.
CivilTime civil_of(nanoseconds since_epoch) {
  const auto day = std::chrono::floor<days>(since_epoch);
  const auto whole = std::chrono::floor<seconds>(since_epoch);
  return {.day = sys_days{day}, .whole = whole - day, .fraction = since_epoch - whole};
}

}  // namespace

Expected<TaiTime> parse_tai(std::string_view text) {
  const Expected<CivilTime> time = parse_civil(text);
  if (!time) {
    return Unexpected{time.error()};
  }
  if (is_second_60(*time)) {
    return rejected(text, "TAI has no leap seconds");
  }
  return tai_at(*time, seconds{0});
}

Expected<TaiTime> parse_utc(std::string_view text) {
  const Expected<CivilTime> time = parse_civil(text);
  if (!time) {
    return Unexpected{time.error()};
  }
  const std::vector<LeapSecond>& table = leap_second_table();
  const auto next = std::find_if(table.begin(), table.end(), [&](const LeapSecond& leap) {
    return utc_day_of(leap) > time->day;
  });
  if (next == table.begin()) {
    return rejected(text, "UTC is known from 1972-01-01 on");
  }
  const bool day_ends_with_leap_second =
      next != table.end() && utc_day_of(*next) == time->day + days{1};
  if (is_second_60(*time) && !day_ends_with_leap_second) {
    return rejected(text, "no leap second ended that day");
  }
  return tai_at(*time, seconds{std::prev(next)->tai_minus_utc_s});
}

std::string format_utc(TaiTime t, int decimals) {
  const std::vector<LeapSecond>& table = leap_second_table();
  const auto next = std::find_if(table.begin(), table.end(),
                                 [t](const LeapSecond& leap) { return leap.start > t; });
  if (next == table.begin()) {
    return civil_text(civil_of(t.time_since_epoch()), decimals) + " TAI";
  }
  const seconds tai_minus_utc{std::prev(next)->tai_minus_utc_s};
  CivilTime time = civil_of(t.time_since_epoch() - tai_minus_utc);
  if (next != table.end() && t >= next->start - seconds{1}) {
    time.day -= days{1};
    time.whole += days{1};
  }
  return civil_text(time, decimals) + "Z";
}

std::vector<LeapSecond> leap_seconds() { return leap_second_table(); }

}  // namespace spindrift
