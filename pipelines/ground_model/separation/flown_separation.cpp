#include "pipelines/ground_model/separation/flown_separation.h"

#include <utility>

#include "pipelines/ephemeris/orbit_frame.h"
#include "pipelines/frames/rotation_vector.h"

namespace spindrift {
namespace {

Expected<Euler312> told_by(const Eigen::Vector3d& off_rad, const SeparationTruth& truth,
                           const Orbit& orbit) {
  return orbit.at(truth.separation).and_then(orbit_frame).map([&](const Eigen::Quaterniond& q) {
    return euler312_of(q.conjugate() * truth.at_separation.q_icrf_body * quaternion_by(off_rad))
        .angles;
  });
}

}  // namespace

Expected<FlownSeparation> flown(const SeparationScenario& scenario, const Orbit& orbit) {
  Chance chance{scenario.seed};
  // Drawn where they are given, too: all else is then the same.
  const Eigen::Vector3d drawn_rad_s = chance.normal_vector(scenario.bias_sigma_rad_s);
  const Eigen::Vector3d drawn = chance.normal_vector(1.0);
  std::optional<Euler312> told;
  if (const auto& launcher = scenario.launcher) {
    const auto angles =
        told_by(launcher->off_rad.value_or(launcher->sigma_rad * drawn), scenario.truth, orbit);
    if (!angles) {
      return Unexpected{angles.error()};
    }
    told = *angles;
  }
  ThreeAxisSensors sensors = scenario.sensors;
  sensors.gyro.bias_rad_s = scenario.bias_rad_s.value_or(drawn_rad_s);
  return separation_motion(scenario.truth, orbit).and_then([&](BodyMotion&& motion) {
    return three_axis_telemetry(motion, scenario.truth.separation, sensors, scenario.faults, orbit,
                                chance)
        .map([&](ThreeAxisTelemetry&& telemetry) {
          return FlownSeparation{.motion = std::move(motion),
                                 .bias_rad_s = sensors.gyro.bias_rad_s,
                                 .telemetry = std::move(telemetry),
                                 .told = told};
        });
  });
}

}  // namespace spindrift
