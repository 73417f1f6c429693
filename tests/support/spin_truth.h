/// @file
/// Builds the simulator's truth for a body whose sensors are mounted as configured.

#pragma once

#include "pipelines/ephemeris/earth_orientation.h"
#include "pipelines/ground_model/sensors/spin_edges.h"
#include "tests/support/observed_spin.h"

namespace spindrift::testing {

/// Returns the truth of a body that spins steadily about the axis of `body`.
inline SpinTruth truth_of(const SpinningBody& body) {
  const auto beam = [](const InfraredSensor& sensor) {
    return TrueInfrared{.mount_angle_rad = sensor.mount_angle_rad,
                        .azimuth_rad = sensor.azimuth_rad};
  };
  return {.start = kTransferStart,
          .motion = {.axis_icrf = body.axis_icrf,
                     .rate_rad_s = body.rate_rad_s,
                     .rate_drift_rad_s2 = 0.0,
                     .first_azimuth_rad = body.first_turn_rad},
          .sun_sensor = body.config.sun_sensor,
          .north = beam(*body.config.north),
          .south = beam(*body.config.south),
          .horizon = infrared_horizon(body.config.horizon, earth_pole_icrf(kTransferStart))};
}

}  // namespace spindrift::testing
