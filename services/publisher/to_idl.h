/// @file
/// Values of ours as they go out on the bus: degrees, rpm, fixed-size text. The only place that
/// fills the generated types.
///
/// Names (spacecraft, source, service) that do not fit are InvalidInput: another name would be
/// another spacecraft. Status text, which is for people, is cut to fit.

#pragma once

#include <spindrift.h>

#include <string_view>

#include "pipelines/core/expected.h"
#include "pipelines/spin/types/products.h"
#include "services/ingest/sample.h"
#include "services/publisher/health.h"

namespace spindrift {

Expected<spindrift_Pulse> to_idl(const PulseSample& sample);

/// What was not received is NaN.
Expected<spindrift_CodedFrame> to_idl(const CodedSample& sample);

/// The IDL has no optional: an absent alternate is NaN in both its members.
Expected<spindrift_SpinFix> to_idl(std::string_view spacecraft, const SpinFix& fix);

Expected<spindrift_SpinEstimate> to_idl(std::string_view spacecraft, const SpinEstimate& estimate);

Expected<spindrift_Health> to_idl(const Health& health);

}  // namespace spindrift
