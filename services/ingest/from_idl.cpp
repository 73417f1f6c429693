#include "services/ingest/from_idl.h"

#include <fmt/format.h>

#include <algorithm>
#include <cmath>
#include <cstdint>
#include <cstring>
#include <optional>
#include <string_view>
#include <utility>

#include "services/ingest/coded_check.h"
#include "services/ingest/spacecraft_id.h"
#include "services/ingest/telemetry_time.h"

namespace spindrift {
namespace {

constexpr bool is_printable(char c) { return c >= ' ' && c <= '~'; }

/// Text of a stranger, safe to store and to show.
std::string printable(std::string_view text) {
  std::string shown{text};
  std::replace_if(
      shown.begin(), shown.end(), [](char c) { return !is_printable(c); }, '?');
  return shown;
}

/// As bytes: a newer IDL may know a channel that ours does not, and an enum must not hold it.
std::uint32_t channel_value(const spindrift_Pulse& pulse) {
  std::uint32_t value = 0;
  static_assert(sizeof value == sizeof pulse.channel);
  std::memcpy(&value, &pulse.channel, sizeof value);
  return value;
}

/// What every telemetry sample has.
template <class Sample>
std::string why_common_fields_impossible(const Sample& sample) {
  const std::string_view source{sample.source};
  if (!is_spacecraft_id(sample.spacecraft)) {
    return fmt::format("spacecraft = \"{}\": must be {}", printable(sample.spacecraft),
                       kSpacecraftIdAllowed);
  }
  if (!std::all_of(source.begin(), source.end(), is_printable)) {
    return fmt::format("source = \"{}\": must be printable ASCII", printable(source));
  }
  if (!is_telemetry_time(tai_from_ns(sample.t_tai_ns))) {
    return fmt::format("t_tai_ns = {}: must lie in the years 1972 to 2099, [{}, {}) ns",
                       sample.t_tai_ns, tai_ns(kEarliestTelemetry), tai_ns(kLatestTelemetry));
  }
  return {};
}

std::string why_no_channel(std::uint32_t channel) {
  return channel < kPulseChannels
             ? std::string{}
             : fmt::format("channel = {}: must be 0 to {}", channel, kPulseChannels - 1);
}

std::optional<double> received(double value) {
  return std::isnan(value) ? std::nullopt : std::optional{value};
}

}  // namespace

Expected<PulseSample> from_idl(const spindrift_Pulse& pulse) {
  const std::uint32_t channel = channel_value(pulse);
  auto reason = why_common_fields_impossible(pulse);
  if (reason.empty()) {
    reason = why_no_channel(channel);
  }
  if (!reason.empty()) {
    return Unexpected{Error{ErrorCode::InvalidInput, std::move(reason)}};
  }
  return PulseSample{
      .spacecraft = pulse.spacecraft,
      .origin = origin_from_idl(pulse),
      .pulse = {.t = tai_from_ns(pulse.t_tai_ns), .channel = static_cast<PulseChannel>(channel)}};
}

Expected<CodedSample> from_idl(const spindrift_CodedFrame& frame) {
  CodedSample sample{
      .spacecraft = frame.spacecraft,
      .origin = origin_from_idl(frame),
      .frame = {.t = tai_from_ns(frame.t_tai_ns),
                .period_s = received(frame.period_s),
                .delay_s = {std::nullopt, received(frame.sun2_s), received(frame.north_in_s),
                            received(frame.north_out_s), received(frame.south_in_s),
                            received(frame.south_out_s)}}};
  auto reason = why_common_fields_impossible(frame);
  if (reason.empty()) {
    reason = why_impossible(sample.frame);
  }
  if (!reason.empty()) {
    return Unexpected{Error{ErrorCode::InvalidInput, std::move(reason)}};
  }
  return sample;
}

RejectedInput rejected_from_idl(const Origin& origin, std::string reason) {
  return {.source = printable(origin.source),
          .line = static_cast<std::int64_t>(origin.seq),
          .reason = std::move(reason),
          .session = origin.session};
}

}  // namespace spindrift
