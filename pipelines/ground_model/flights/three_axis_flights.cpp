#include "pipelines/ground_model/flights/three_axis_flights.h"

#include <utility>

#include "pipelines/ephemeris/orbit_frame.h"
#include "pipelines/frames/rotation_vector.h"

namespace spindrift {
namespace {

using Eigen::Vector3d;

Expected<Euler312> told_by(const Vector3d& off_rad, const BodyTruth& truth, const Orbit& orbit) {
  return orbit.at(truth.start).and_then(orbit_frame).map([&](const Eigen::Quaterniond& q) {
    return euler312_of(q.conjugate() * truth.at_start.q_icrf_body * quaternion_by(off_rad)).angles;
  });
}

/// Returns the true sensors. A given bias is drawn, too, so that all other draws are the same.
ThreeAxisSensors sensors_of(const ThreeAxisView& view, Chance& chance) {
  const Vector3d drawn_rad_s = chance.normal_vector(view.bias_sigma_rad_s);
  ThreeAxisSensors sensors = view.sensors;
  if (sensors.gyro) {
    sensors.gyro->bias_rad_s = view.bias_rad_s.value_or(drawn_rad_s);
  }
  return sensors;
}

Expected<FlownBody> seen(BodyMotion motion, TaiTime start, const ThreeAxisSensors& sensors,
                         const ThreeAxisFaults& faults, const Orbit& orbit, Chance& chance) {
  return three_axis_telemetry(motion, start, sensors, faults, orbit, chance)
      .map([&](ThreeAxisTelemetry&& telemetry) {
        return FlownBody{.motion = std::move(motion),
                         .bias_rad_s = sensors.gyro ? sensors.gyro->bias_rad_s : Vector3d::Zero(),
                         .telemetry = std::move(telemetry)};
      });
}

}  // namespace

Expected<FlownSeparation> flown(const SeparationScenario& scenario, const Orbit& orbit) {
  const BodyTruth& body = scenario.truth.body;
  Chance chance{scenario.view.seed};
  const ThreeAxisSensors sensors = sensors_of(scenario.view, chance);
  // Drawn even where the error is given, so that all other draws are the same.
  const Vector3d drawn = chance.normal_vector(1.0);
  std::optional<Euler312> told;
  if (const auto& launcher = scenario.launcher) {
    const auto angles =
        told_by(launcher->off_rad.value_or(launcher->sigma_rad * drawn), body, orbit);
    if (!angles) {
      return Unexpected{angles.error()};
    }
    told = *angles;
  }
  return separation_motion(scenario.truth, orbit)
      .and_then([&](BodyMotion&& motion) {
        return seen(std::move(motion), body.start, sensors, scenario.view.faults, orbit, chance);
      })
      .map([&](FlownBody&& flown_body) {
        return FlownSeparation{.body = std::move(flown_body), .told = told};
      });
}

Expected<FlownBody> flown(const TumblingScenario& scenario, const Orbit& orbit) {
  Chance chance{scenario.view.seed};
  const ThreeAxisSensors sensors = sensors_of(scenario.view, chance);
  return tumbling_motion(scenario.truth, orbit).and_then([&](BodyMotion&& motion) {
    return seen(std::move(motion), scenario.truth.body.start, sensors, scenario.view.faults, orbit,
                chance);
  });
}

Expected<FlownOrientation> flown(const OrientationScenario& scenario, const Orbit& orbit) {
  Chance chance{scenario.view.seed};
  const ThreeAxisSensors sensors = sensors_of(scenario.view, chance);
  // A separate stream of draws keeps the telemetry's draws the same whatever the computer does.
  Chance on_board{~scenario.view.seed};
  return orientation_motion(scenario.truth, sensors.gyro, orbit, on_board)
      .and_then([&](Orientation&& orientation) {
        const OrientationOutcome outcome = outcome_of(orientation, scenario.truth);
        return seen(std::move(orientation.motion), scenario.truth.body.start, sensors,
                    scenario.view.faults, orbit, chance)
            .map([&](FlownBody&& body) {
              return FlownOrientation{.body = std::move(body),
                                      .record = std::move(orientation.record),
                                      .outcome = outcome};
            });
      });
}

}  // namespace spindrift
