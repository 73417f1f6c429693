#include "services/ingest/from_idl.h"

#include <fmt/format.h>

#include <algorithm>
#include <cstdint>
#include <cstring>
#include <string_view>
#include <utility>

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

std::string why_impossible(const spindrift_Pulse& pulse, std::uint32_t channel) {
  const std::string_view source{pulse.source};
  if (!is_spacecraft_id(pulse.spacecraft)) {
    return fmt::format("spacecraft = \"{}\": must be {}", printable(pulse.spacecraft),
                       kSpacecraftIdAllowed);
  }
  if (!std::all_of(source.begin(), source.end(), is_printable)) {
    return fmt::format("source = \"{}\": must be printable ASCII", printable(source));
  }
  if (!is_telemetry_time(tai_from_ns(pulse.t_tai_ns))) {
    return fmt::format("t_tai_ns = {}: must lie in the years 1972 to 2099, [{}, {}) ns",
                       pulse.t_tai_ns, tai_ns(kEarliestTelemetry), tai_ns(kLatestTelemetry));
  }
  if (channel >= kPulseChannels) {
    return fmt::format("channel = {}: must be 0 to {}", channel, kPulseChannels - 1);
  }
  return {};
}

}  // namespace

Origin origin_from_idl(const spindrift_Pulse& pulse) {
  return {.source = pulse.source, .session = pulse.session, .seq = pulse.seq};
}

Expected<PulseSample> from_idl(const spindrift_Pulse& pulse) {
  const std::uint32_t channel = channel_value(pulse);
  if (auto reason = why_impossible(pulse, channel); !reason.empty()) {
    return Unexpected{Error{ErrorCode::InvalidInput, std::move(reason)}};
  }
  return PulseSample{
      .spacecraft = pulse.spacecraft,
      .origin = origin_from_idl(pulse),
      .pulse = {.t = tai_from_ns(pulse.t_tai_ns), .channel = static_cast<PulseChannel>(channel)}};
}

RejectedInput rejected_from_idl(const spindrift_Pulse& pulse, std::string reason) {
  return {.source = printable(pulse.source),
          .line = static_cast<std::int64_t>(pulse.seq),
          .reason = std::move(reason),
          .session = pulse.session};
}

}  // namespace spindrift
