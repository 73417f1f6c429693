#include "services/telemetry_files/parse_row.h"

#include <fmt/format.h>

#include <charconv>
#include <cmath>
#include <cstddef>
#include <cstdint>
#include <optional>
#include <string>
#include <system_error>
#include <utility>

#include "services/ingest/coded_check.h"
#include "services/ingest/telemetry_time.h"
#include "services/telemetry_files/csv.h"

namespace spindrift {
namespace {

Unexpected refused(std::string reason) {
  return Unexpected{{ErrorCode::InvalidInput, std::move(reason)}};
}

Expected<TaiTime> time_from(std::string_view field) {
  std::int64_t t_tai_ns = 0;
  const char* const end = field.data() + field.size();
  const auto [stop, failure] = std::from_chars(field.data(), end, t_tai_ns);
  if (failure == std::errc::invalid_argument || stop != end) {
    return refused(fmt::format("t_tai_ns = {}: must be an integer", quoted(field)));
  }
  const TaiTime t = tai_from_ns(t_tai_ns);
  if (failure != std::errc{} || !is_telemetry_time(t)) {
    return refused(fmt::format("t_tai_ns = {}: must lie in the years 1972 to 2099, [{}, {}) ns",
                               quoted(field), tai_ns(kEarliestTelemetry),
                               tai_ns(kLatestTelemetry)));
  }
  return t;
}

Expected<PulseChannel> channel_from(std::string_view field) {
  const auto channel = pulse_channel_from(field);
  if (!channel) {
    return refused(fmt::format("channel = {}: must be one of {}", quoted(field),
                               fmt::join(kPulseChannelNames, ", ")));
  }
  return *channel;
}

/// Empty: not received.
Expected<std::optional<double>> interval_from(std::string_view column, std::string_view field) {
  if (field.empty()) {
    return std::nullopt;
  }
  double interval_s = 0.0;
  const char* const end = field.data() + field.size();
  const auto [stop, failure] = std::from_chars(field.data(), end, interval_s);
  if (failure != std::errc{} || stop != end || !std::isfinite(interval_s)) {
    return refused(fmt::format("{}_s = {}: must be a number, or empty when not received", column,
                               quoted(field)));
  }
  return interval_s;
}

}  // namespace

Expected<void> parse_row(RowFields fields, Pulse& pulse) {
  const auto t = time_from(fields[0]);
  if (!t) {
    return Unexpected{t.error()};
  }
  const auto channel = channel_from(fields[1]);
  if (!channel) {
    return Unexpected{channel.error()};
  }
  pulse = {.t = *t, .channel = *channel};
  return {};
}

Expected<void> parse_row(RowFields fields, CodedFrame& frame) {
  const auto t = time_from(fields[0]);
  if (!t) {
    return Unexpected{t.error()};
  }
  frame.t = *t;
  const auto period_s = interval_from("period", fields[1]);
  if (!period_s) {
    return Unexpected{period_s.error()};
  }
  frame.period_s = *period_s;
  // In place of the delay of sun1, the first channel, stands the period.
  for (std::size_t channel = 1; channel < kPulseChannels; ++channel) {
    const auto delay_s = interval_from(kPulseChannelNames.at(channel), fields[channel + 1]);
    if (!delay_s) {
      return Unexpected{delay_s.error()};
    }
    frame.delay_s.at(channel) = *delay_s;
  }
  if (auto reason = why_impossible(frame); !reason.empty()) {
    return refused(std::move(reason));
  }
  return {};
}

}  // namespace spindrift
