/// @file
/// The list of all kinds of telemetry, over which the services iterate.

#pragma once

#include "services/telemetry/coded_frame.h"
#include "services/telemetry/gyro.h"
#include "services/telemetry/kind_list.h"
#include "services/telemetry/magnetometer.h"
#include "services/telemetry/orbit_state.h"
#include "services/telemetry/pulse.h"
#include "services/telemetry/star.h"
#include "services/telemetry/sun.h"

namespace spindrift {

using TelemetryKinds =
    KindList<Pulse, CodedFrame, GyroSample, StarFix, SunDirection, MagneticField, TimedOrbitState>;

}  // namespace spindrift
