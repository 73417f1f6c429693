#include "services/ingest/from_idl.h"

#include <fmt/format.h>

#include <algorithm>

#include "services/telemetry/spacecraft_id.h"
#include "services/telemetry/telemetry_time.h"

namespace spindrift {
namespace {

constexpr bool is_printable(char c) { return c >= ' ' && c <= '~'; }

}  // namespace

std::string why_header_impossible(std::string_view spacecraft, std::string_view source,
                                  std::int64_t t_tai_ns) {
  if (!is_spacecraft_id(spacecraft)) {
    return fmt::format("spacecraft = \"{}\": must be {}", shown(spacecraft), kSpacecraftIdAllowed);
  }
  if (!std::all_of(source.begin(), source.end(), is_printable)) {
    return fmt::format("source = \"{}\": must be printable ASCII", shown(source));
  }
  if (!is_telemetry_time(tai_from_ns(t_tai_ns))) {
    return fmt::format("t_tai_ns = {}: must lie in the years 1972 to 2099, [{}, {}) ns", t_tai_ns,
                       tai_ns(kEarliestTelemetry), tai_ns(kLatestTelemetry));
  }
  return {};
}

std::string why_no_channel(std::string_view name, std::uint32_t channel) {
  return channel < kPulseChannels
             ? std::string{}
             : fmt::format("{} = {}: must be 0 to {}", name, channel, kPulseChannels - 1);
}

RejectedInput rejected_from_idl(const Origin& origin, std::string reason) {
  return {.source = origin.source,
          .line = static_cast<std::int64_t>(origin.seq),
          .reason = std::move(reason),
          .session = origin.session};
}

}  // namespace spindrift
