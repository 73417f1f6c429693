/// @file
/// The input of a separation reconstruction, and whether its values can be used.

#pragma once

#include <cstdint>
#include <optional>
#include <vector>

#include "pipelines/core/expected.h"
#include "pipelines/ephemeris/orbit.h"
#include "pipelines/ephemeris/orbit_state.h"
#include "pipelines/three_axis/config.h"
#include "pipelines/three_axis/samples.h"
#include "pipelines/time/tai_time.h"

namespace spindrift {

/// Holds the times T1 to T4. Omitted ones are inferred: T2 from the first gyro sample, T3 from the
/// first sun vector after T2 that precedes a star fix, T4 from the first star fix after T3. If the
/// first gyro samples were lost, the inferred T2 is too late, unnoticed, and T1 lacks the thruster
/// action before it.
struct SeparationTimes {
  TaiTime separation;                                    ///< T1
  std::optional<TaiTime> control_on = std::nullopt;      ///< T2; rates are measured from here on.
  std::optional<TaiTime> acquisition = std::nullopt;     ///< T3
  std::optional<TaiTime> first_star_fix = std::nullopt;  ///< T4
};

/// Default sigma of unmodelled angular acceleration.
inline constexpr double kDisturbance_rad_s2 = 5e-7;

/// Holds all inputs by value, so that it can be solved later on any thread. Samples may be in any
/// order; the first of each kind and instant counts.
struct ReconstructionRequest {
  ThreeAxisConfig sensors;
  SeparationTimes times;
  std::vector<GyroSample> gyro;
  std::vector<SunDirection> sun_directions;
  std::vector<StarFix> star_fixes;
  /// Empty if the orbit is unknown. Eclipses are then unknown too, and the Sun is that of the
  /// Earth's centre, 10 arcsec off in low orbit, one arc minute in geostationary orbit.
  std::optional<Orbit> orbit = std::nullopt;
  /// States reported by the spacecraft, which give the orbit if `orbit` is empty.
  std::vector<TimedOrbitState> orbit_states = {};
  /// Standard deviation per axis of a constant angular acceleration from T1 to T2 by unmodelled
  /// torques. In low orbit the gravity gradient is up to 1.9e-6 rad/s^2 times the difference of the
  /// moments over the moment.
  double disturbance_rad_s2 = kDisturbance_rad_s2;
  /// For `batch`: adds a history node at every gyro sample to those at sun vectors, star fixes and
  /// events. The attitudes at the events do not depend on it.
  bool node_at_every_gyro_sample = false;
};

/// Returns the request's orbit, else the two-body orbit of the first valid state from T1 on: the
/// orbit frame matters most at T1, and propagation stays short. Empty if there is neither.
std::optional<Orbit> orbit_of(const ReconstructionRequest& request);

/// Returns the number of gyro samples, sun vectors and star fixes.
std::int64_t sample_count(const ReconstructionRequest& request);

/// Checks sensors, inertia, sigmas and every single sample, but not the event times.
std::optional<Error> refusal_of(const ReconstructionRequest& request);

}  // namespace spindrift
