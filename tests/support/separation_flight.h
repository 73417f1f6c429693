/// @file
/// Separations simulated by the ground model with any initial attitude and rate, with the telemetry
/// and the truth. They share no formula with the reconstruction.

#pragma once

#include <Eigen/Core>
#include <Eigen/Geometry>
#include <cstdint>
#include <vector>

#include "pipelines/ephemeris/orbit.h"
#include "pipelines/reconstruction/request.h"
#include "pipelines/three_axis/config.h"
#include "pipelines/three_axis/samples.h"

namespace spindrift::testing {

struct FlightPlan {
  double control_on_s = 60.0;       ///< T2, s after T1.
  double acquisition_s = 78.0;      ///< T3, s after T1.
  double first_star_fix_s = 300.0;  ///< T4, s after T1.
  double star_fix_step_s = 0.0;  ///< Interval of further star fixes from T4 to the end; 0 for none.
  double end_s = 300.0;
  double gyro_step_s = 0.25;
  double sun_step_s = 1.0;
  double gyro_noise_deg_s = 0.002;
  double bias_sigma_deg_s = 0.01;
  double sun_noise_deg = 0.5;
  double star_noise_arcsec = 20.0;
};

struct SeparationFlight {
  ThreeAxisConfig sensors;
  SeparationTimes times;
  std::vector<GyroSample> gyro;
  std::vector<SunDirection> sun;
  std::vector<StarFix> stars;
  Eigen::Vector3d bias_rad_s;
  Orbit orbit;  ///< Orbit along the terminator: the Earth never hides the Sun.
  /// Attitudes at T1 to T4.
  std::vector<Eigen::Matrix3d> R_icrf_body;

  ReconstructionRequest request() const {
    return {.sensors = sensors,
            .times = times,
            .gyro = gyro,
            .sun_directions = sun,
            .star_fixes = stars,
            .orbit = orbit,
            .disturbance_rad_s2 = 0.0};
  }
  /// Returns the small rotation about body axes from the found to the true attitude.
  Eigen::Vector3d error_rad(std::size_t event, const Eigen::Quaterniond& found) const;
};

/// Simulates a flight with bias, initial state and noise drawn from the seed: any initial attitude
/// at up to a degree per second, rate damping by relay control from T2 on, and from T3 on a turn of
/// -Zb to the Sun.
SeparationFlight separation_flight(const FlightPlan& plan, std::uint64_t seed);

}  // namespace spindrift::testing
