#include <fmt/format.h>

#include <charconv>
#include <cmath>
#include <cstdint>
#include <system_error>

#include "services/telemetry/csv.h"
#include "services/telemetry/likely_cause.h"
#include "services/telemetry/parse_row.h"
#include "services/telemetry/telemetry_time.h"

namespace spindrift {
namespace {

/// Returns empty when the field is not a finite number.
std::optional<double> number_from(std::string_view field) {
  double number = 0.0;
  const char* const end = field.data() + field.size();
  const auto [stop, failure] = std::from_chars(field.data(), end, number);
  return failure == std::errc{} && stop == end && std::isfinite(number) ? std::optional{number}
                                                                        : std::nullopt;
}

}  // namespace

std::string parse_field(std::string_view column, std::string_view field, TaiTime& t) {
  std::int64_t t_tai_ns = 0;
  const char* const end = field.data() + field.size();
  const auto [stop, failure] = std::from_chars(field.data(), end, t_tai_ns);
  if (failure == std::errc::invalid_argument || stop != end) {
    return fmt::format("{} = {}: must be an integer{}", column, quoted(field), likely_time(field));
  }
  t = tai_from_ns(t_tai_ns);
  if (failure != std::errc{} || !is_telemetry_time(t)) {
    return fmt::format("{} = {}: must lie in the years 1972 to 2099, [{}, {}) ns{}", column,
                       quoted(field), tai_ns(kEarliestTelemetry), tai_ns(kLatestTelemetry),
                       likely_time(field));
  }
  return {};
}

std::string parse_field(std::string_view column, std::string_view field, double& number) {
  const auto found = number_from(field);
  if (!found) {
    return fmt::format("{} = {}: must be a number", column, quoted(field));
  }
  number = *found;
  return {};
}

std::string parse_field(std::string_view column, std::string_view field,
                        std::optional<double>& number) {
  number = number_from(field);
  if (!number && !field.empty()) {
    return fmt::format("{} = {}: must be a number, or empty when not received", column,
                       quoted(field));
  }
  return {};
}

std::string parse_field(std::string_view column, std::string_view field, PulseChannel& channel) {
  const auto found = pulse_channel_from(field);
  if (!found) {
    return fmt::format("{} = {}: must be one of {}", column, quoted(field),
                       fmt::join(kPulseChannelNames, ", "));
  }
  channel = *found;
  return {};
}

}  // namespace spindrift
