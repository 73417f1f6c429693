/// @file
/// Values of ours as they go out on the bus: degrees, rpm, fixed-size text. The only place that
/// fills the generated types.
///
/// Names (spacecraft, source, service) that do not fit are InvalidInput: another name would be
/// another spacecraft. Status text, which is for people, is cut to fit.

#pragma once

#include <spindrift.h>

#include <string_view>
#include <vector>

#include "pipelines/core/expected.h"
#include "pipelines/spin/types/products.h"
#include "services/ingest/sample.h"
#include "services/publisher/health.h"

namespace spindrift {

/// Whose result it is, and who gave it.
struct ResultOrigin {
  std::string_view spacecraft;
  std::string_view run_id;
  std::string_view service;
};

Expected<spindrift_Pulse> to_idl(const PulseSample& sample);

/// What was not received is NaN.
Expected<spindrift_CodedFrame> to_idl(const CodedSample& sample);

/// The IDL has no optional: an absent alternate is NaN in both its members.
Expected<spindrift_SpinFix> to_idl(const ResultOrigin& origin, const SpinFix& fix);

Expected<spindrift_SpinEstimate> to_idl(const ResultOrigin& origin, const SpinEstimate& estimate);

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
