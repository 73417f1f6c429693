/// @file
/// Values of ours as they go out on the bus: degrees, rpm, fixed-size text. The only place that
/// fills the generated types.
///
/// Names (spacecraft, source, service) that do not fit are InvalidInput: another name would be
/// another spacecraft. Status text, which is for people, is cut to fit.

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

/// Whose result it is, and who gave it.
struct ResultOrigin {
  std::string_view spacecraft;
  std::string_view run_id;
  std::string_view service;
};

/// @name One member of a telemetry value into one of its message; what was not received is NaN
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

/// `field` is zeroed and keeps its last byte 0.
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

/// The IDL has no optional: an absent alternate is NaN in both its members.
Expected<spindrift_SpinFix> to_idl(const ResultOrigin& origin, const SpinFix& fix);

Expected<spindrift_SpinEstimate> to_idl(const ResultOrigin& origin, const SpinEstimate& estimate);

/// Rates that are not estimated are NaN.
Expected<spindrift_AttitudeEstimate> to_idl(const ResultOrigin& origin,
                                            const AttitudeEstimate& estimate);

/// @param offset Of the host's clock from the time of the telemetry that is due.
Expected<spindrift_RehearsalClock> to_idl(std::string_view spacecraft, const Origin& origin,
                                          std::chrono::nanoseconds offset);

/// Points into `alert`, which outlives what it gives.
Expected<spindrift_Alert> to_idl(const ResultOrigin& origin, const Alert& alert);

/// Points into the Health that it was made of, and into itself: it is moved and not copied.
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

/// `health` outlives what it gives.
Expected<HealthSample> to_idl(std::string_view service, const Health& health);

}  // namespace spindrift
