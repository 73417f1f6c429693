/// @file
/// Converts telemetry from the bus. Only this file reads the generated types of telemetry.

#pragma once

#include <fmt/format.h>

#include <cmath>
#include <cstdint>
#include <cstring>
#include <optional>
#include <string>
#include <string_view>
#include <type_traits>
#include <utility>

#include "pipelines/core/expected.h"
#include "pipelines/core/shown.h"
#include "services/bus/telemetry_messages.h"
#include "services/telemetry/rejected_input.h"
#include "services/telemetry/telemetry_sample.h"

namespace spindrift {

/// Returns the origin of any message, with the source made printable.
template <class Message>
Origin origin_from_idl(const Message& message) {
  return {.source = shown(message.source), .session = message.session, .seq = message.seq};
}

/// Returns the row that is stored instead of an impossible sample from `origin`.
RejectedInput rejected_from_idl(const Origin& origin, std::string reason);

/// @name Checks of the members that every message has, and of a channel
/// They name member, value and what is allowed; empty when the value is possible.
/// @{
std::string why_header_impossible(std::string_view spacecraft, std::string_view source,
                                  std::int64_t t_tai_ns);
std::string why_no_channel(std::string_view name, std::uint32_t channel);
/// @}

/// @name Copy one member of a message into one of a value
/// @return The reason why it is impossible, or an empty string.
/// @{
inline std::string put(std::string_view /*name*/, double field, double& member) {
  member = field;
  return {};
}
/// Maps NaN, which means "not received", to an empty value.
inline std::string put(std::string_view /*name*/, double field, std::optional<double>& member) {
  member = std::isnan(field) ? std::nullopt : std::optional{field};
  return {};
}
/// Copies bytes, because a newer IDL may have a channel that this enum must not hold.
template <class Field>
std::string put(std::string_view name, const Field& field, PulseChannel& member) {
  std::uint32_t channel = 0;
  static_assert(sizeof channel == sizeof field);
  std::memcpy(&channel, &field, sizeof channel);
  auto reason = why_no_channel(name, channel);
  if (reason.empty()) {
    member = static_cast<PulseChannel>(channel);
  }
  return reason;
}
/// @}

/// Converts a message to a sample. @return InvalidInput naming kind, member, value and what is
/// allowed, when the sample is impossible: an invalid name of spacecraft or source, a time outside
/// telemetry_time.h, or values that its kind does not allow. The kind is named because each topic
/// has its own seq, so samples of two kinds can have the same one.
template <class Value>
Expected<TelemetrySample<Value>> from_idl(const bus::MessageOf<Value>& message) {
  TelemetrySample<Value> sample{
      .spacecraft = message.spacecraft, .origin = origin_from_idl(message), .value = {}};
  sample.value.t = tai_from_ns(message.t_tai_ns);
  auto reason = why_header_impossible(message.spacecraft, message.source, message.t_tai_ns);
  bus::for_each_field(sample.value, message,
                      [&reason](std::string_view name, auto& member, const auto& field) {
                        if (reason.empty()) {
                          reason = put(name, field, member);
                        }
                      });
  if (reason.empty()) {
    reason = Telemetry<Value>::why_impossible(sample.value);
  }
  if (!reason.empty()) {
    return Unexpected{
        {ErrorCode::InvalidInput, fmt::format("{}: {}", Telemetry<Value>::kName, reason)}};
  }
  return sample;
}

}  // namespace spindrift
