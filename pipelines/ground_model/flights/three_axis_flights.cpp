#include "pipelines/ground_model/flights/three_axis_flights.h"

#include <algorithm>
#include <cmath>
#include <utility>

#include "pipelines/ephemeris/flight_frames.h"
#include "pipelines/ephemeris/sun.h"
#include "pipelines/frames/angle.h"
#include "pipelines/frames/rotation_vector.h"
#include "pipelines/ground_model/control/attitude_control.h"
#include "pipelines/ground_model/dynamics/rigid_body.h"

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

Expected<AttitudeControl> laws_of(const SeparationTruth& truth) {
  const SeparationControl& control = truth.control;
  return AttitudeControl::make({.control_on_s = truth.control_on_s,
                                .damped_rad_s = 0.0,
                                .pointing_at_s = truth.acquisition_s},
                               RelayDamping{.torque_nm = control.thrusters.torque_nm,
                                            .dead_band_rad_s = control.dead_band_rad_s},
                               SunAcquisition{.inertia_kg_m2 = truth.body.inertia_kg_m2,
                                              .torque_nm_most = control.thrusters.torque_nm,
                                              .slew_rad_s = control.slew_rad_s,
                                              .period_s = control.period_s});
}

/// Returns a step of which the flight is a whole multiple.
double step_s(double end_s, double fastest_rad_s) {
  const double wanted_s = std::min(1.0, 0.01 / std::max(fastest_rad_s, 1e-6));
  return end_s / std::ceil(end_s / wanted_s);
}

}  // namespace

Expected<BodyMotion> tumbling_motion(const TumblingTruth& truth, const Orbit& orbit) {
  const auto body = RigidBody::make(truth.body.inertia_kg_m2);
  if (!body) {
    return Unexpected{body.error()};
  }
  const double fastest = fastest_rad_s(truth.body.inertia_kg_m2,
                                       truth.body.at_start.rate_body_rad_s, truth.wheels_body_nms);
  if (const auto fine = check_step(kLongestStep_s, fastest); !fine) {
    return Unexpected{fine.error()};
  }
  ClosedLoop<BodyMotion> loop{
      BodyMotion{*body, truth.body.at_start, step_s(truth.body.end_s, fastest)},
      HeldMomentum{truth.wheels_body_nms}, truth.body.disturbances, 1};
  return fly(loop, truth.body, orbit,
             [](TaiTime, const OrbitState&) { return Eigen::Vector3d::Zero().eval(); })
      .map([&] { return std::move(loop).body(); });
}

Expected<BodyMotion> separation_motion(const SeparationTruth& truth, const Orbit& orbit) {
  const auto thrusters = Thrusters::make(truth.control.thrusters);
  if (!thrusters) {
    return Unexpected{thrusters.error()};
  }
  auto loop = loop_of(truth.body, *thrusters, truth.control.period_s);
  if (!loop) {
    return Unexpected{std::move(loop.error())};
  }
  auto laws = laws_of(truth);
  if (!laws) {
    return Unexpected{std::move(laws.error())};
  }
  ApparentSun sun;
  return fly(*loop, truth.body, orbit,
             [&](TaiTime t, const OrbitState& spacecraft) {
               return laws->torque_body_nm(loop->t_s(),
                                           loop->measured(sun.direction_icrf(t, spacecraft)));
             })
      .map([&] { return std::move(*loop).body(); });
}

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

Expected<FlownRescue> flown(const RescueScenario& scenario, const Orbit& orbit) {
  Chance chance{scenario.view.seed};
  const ThreeAxisSensors sensors = sensors_of(scenario.view, chance);
  // The seed differs from that of the view, as for an orientation.
  Chance on_board{~scenario.view.seed};
  return rescue_motion(scenario.truth, orbit, on_board).and_then([&](Rescue&& rescue) {
    const RescueOutcome outcome = outcome_of(rescue);
    return seen(std::move(rescue.motion), scenario.truth.body.start, sensors, scenario.view.faults,
                orbit, chance)
        .map([&](FlownBody&& body) {
          return FlownRescue{.body = std::move(body), .outcome = outcome};
        });
  });
}

}  // namespace spindrift
