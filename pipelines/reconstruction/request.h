/// @file
/// What a reverse reconstruction is made of.

#pragma once

#include <cstdint>
#include <optional>
#include <vector>

#include "pipelines/ephemeris/orbit.h"
#include "pipelines/ephemeris/timed_orbit_state.h"
#include "pipelines/three_axis/config.h"
#include "pipelines/three_axis/samples.h"
#include "pipelines/time/tai_time.h"

namespace spindrift {

/// T1 to T4. Those left out are found: T2 at the first gyro sample, T3 at the first sun vector
/// behind T2 that has a star fix behind it, T4 at the first star fix behind T3. Where the first
/// gyro samples were lost, T2 is late and nobody knows: what thrusters did before it is missing in
/// T1.
struct SeparationTimes {
  TaiTime separation;                                    ///< T1
  std::optional<TaiTime> control_on = std::nullopt;      ///< T2, rates are measured from here on.
  std::optional<TaiTime> acquisition = std::nullopt;     ///< T3
  std::optional<TaiTime> first_star_fix = std::nullopt;  ///< T4
};

/// Where nobody says how large it is.
inline constexpr double kDisturbance_rad_s2 = 5e-7;

/// All that counts, as values: it can be solved on any thread, later. Samples in any order; of
/// those of one kind and instant the first counts.
struct ReconstructionRequest {
  ThreeAxisConfig sensors;
  SeparationTimes times;
  std::vector<GyroSample> gyro;
  std::vector<SunDirection> sun_directions;
  std::vector<StarFix> star_fixes;
  /// Empty where it is not known: then nobody knows of the Earth's shadow, and the Sun is that of
  /// the Earth's centre, 10 arcsec off in a low orbit, a minute of arc in a geostationary one.
  std::optional<Orbit> orbit = std::nullopt;
  /// As the spacecraft says them. Where `orbit` is empty they tell it.
  std::vector<TimedOrbitState> orbit_states = {};
  /// One standard deviation per axis of the angular acceleration, even from T1 to T2, by torques
  /// that nobody models. The gravity gradient of a low orbit is up to 1.9e-6 times the difference
  /// of the moments over the moment.
  double disturbance_rad_s2 = kDisturbance_rad_s2;
  /// Of `batch`. Otherwise the history has every sun vector, star fix and event. The events are the
  /// same.
  bool node_at_every_gyro_sample = false;
};

/// That of the request; else the two-body orbit through the first state from T1 on that is on one:
/// at T1 the frame counts most, and nothing is propagated for long. Empty: not known.
std::optional<Orbit> orbit_of(const ReconstructionRequest& request);

/// Gyro samples, sun vectors and star fixes.
std::int64_t sample_count(const ReconstructionRequest& request);

}  // namespace spindrift
