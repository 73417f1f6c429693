/// @file
/// Converts values of the domain to messages for the bus: degrees, rpm, fixed-size text. Only this
/// file fills the generated types.
/// Names (spacecraft, source, service) that do not fit give InvalidInput, because a shortened name
/// could be that of another spacecraft. Status text, which is for people, is cut to fit.

#pragma once

#include <spindrift.h>

#include <chrono>
#include <limits>
#include <optional>
#include <span>
#include <string_view>
#include <vector>

#include "pipelines/core/expected.h"
#include "pipelines/spin/types/products.h"
#include "pipelines/supervision/alert.h"
#include "pipelines/three_axis/products.h"
#include "services/bus/telemetry_messages.h"
#include "services/publisher/health.h"
#include "services/telemetry/telemetry_sample.h"

namespace spindrift {

/// Identifies the spacecraft and run of a result, and the service that gave it.
struct ResultOrigin {
  std::string_view spacecraft;
  std::string_view run_id;
  std::string_view service;
};

/// @name Copy a member of a telemetry value to its message; a value that was not received is NaN
/// @{
inline void put(double member, double& field) { field = member; }
inline void put(const std::optional<double>& member, double& field) {
  field = member.value_or(std::numeric_limits<double>::quiet_NaN());
}
template <class Field>
void put(PulseChannel member, Field& field) {
  field = static_cast<Field>(member);
}
/// @}

/// Copies `name` into `field`, which must be zeroed; its last byte stays 0.
Expected<void> put_name(std::span<char> field, std::string_view name, std::string_view what);

template <class Value>
Expected<bus::MessageOf<Value>> to_idl(const TelemetrySample<Value>& sample) {
  bus::MessageOf<Value> out{};
  out.session = sample.origin.session;
  out.seq = sample.origin.seq;
  out.t_tai_ns = tai_ns(sample.value.t);
  bus::for_each_field(
      sample.value, out,
      [](std::string_view /*name*/, const auto& member, auto& field) { put(member, field); });
  return put_name(out.spacecraft, sample.spacecraft, "spacecraft")
      .and_then([&] { return put_name(out.source, sample.origin.source, "source"); })
      .map([&out] { return out; });
}

/// Converts a fix. An absent alternate is NaN in both members: the IDL has no optional.
Expected<spindrift_SpinFix> to_idl(const ResultOrigin& origin, const SpinFix& fix);

Expected<spindrift_SpinEstimate> to_idl(const ResultOrigin& origin, const SpinEstimate& estimate);

/// Converts an estimate. Rates that are not estimated are NaN.
Expected<spindrift_AttitudeEstimate> to_idl(const ResultOrigin& origin,
                                            const AttitudeEstimate& estimate);

/// @param offset How far the host's clock is ahead of the telemetry that is due.
Expected<spindrift_RehearsalClock> to_idl(std::string_view spacecraft, const Origin& origin,
                                          std::chrono::nanoseconds offset);

/// The message points into `alert`, which must outlive it.
Expected<spindrift_Alert> to_idl(const ResultOrigin& origin, const Alert& alert);

/// Movable only: the message points into this object and the Health it was made from.
struct HealthSample {
  HealthSample() = default;
  HealthSample(const HealthSample&) = delete;
  HealthSample& operator=(const HealthSample&) = delete;
  HealthSample(HealthSample&&) = default;
  HealthSample& operator=(HealthSample&&) = default;
  ~HealthSample() = default;

  spindrift_Health sample{};
  std::vector<spindrift_SpacecraftHealth> spacecraft;
};

/// `health` must outlive the returned message.
Expected<HealthSample> to_idl(std::string_view service, const Health& health);

}  // namespace spindrift
