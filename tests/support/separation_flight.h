/// @file
/// Separations that the ground model flies, with any attitude and rate at the start: what is
/// reconstructed from, and the truth. No formula of the reconstruction is in them.

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
  double control_on_s = 60.0;       ///< T2, T1 is at 0.
  double acquisition_s = 78.0;      ///< T3
  double first_star_fix_s = 300.0;  ///< T4
  double star_fix_step_s = 0.0;     ///< More fixes behind T4, to the end; 0: none.
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
  Orbit orbit;  ///< Along the terminator: the Earth never hides the Sun.
  /// At T1 to T4.
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
  /// Small rotation about body axes from what was found to the truth.
  Eigen::Vector3d error_rad(std::size_t event, const Eigen::Quaterniond& found) const;
};

/// Bias, start and noise by the seed: a start within a degree per second and any attitude; relay
/// damping from T2; from T3 -Zb turned to the Sun.
SeparationFlight separation_flight(const FlightPlan& plan, std::uint64_t seed);

}  // namespace spindrift::testing
