#include "pipelines/ground_model/separation/separation_motion.h"

#include <cmath>
#include <utility>

#include "pipelines/ephemeris/sun.h"
#include "pipelines/ground_model/control/attitude_control.h"
#include "pipelines/ground_model/control/closed_loop.h"
#include "pipelines/ground_model/dynamics/coarse_step.h"

namespace spindrift {
namespace {

struct Flight {
  ClosedLoop<BodyMotion> loop;
  AttitudeControl control;
};

/// Without torque a body turns at most this much faster than it does now.
double fastest_rad_s(const SeparationTruth& truth) {
  const Eigen::Vector3d moments = truth.inertia_kg_m2.selfadjointView<Eigen::Lower>().eigenvalues();
  return truth.at_separation.rate_body_rad_s.norm() * std::sqrt(moments[2] / moments[0]);
}

Expected<Flight> flight_of(const SeparationTruth& truth) {
  constexpr double kLongestStep_s = 0.05;
  const SeparationControl& control = truth.control;
  const int steps = static_cast<int>(std::ceil(control.period_s / kLongestStep_s));
  const double step_s = control.period_s / steps;
  const auto body = RigidBody::make(truth.inertia_kg_m2);
  if (!body) {
    return Unexpected{body.error()};
  }
  if (const auto fine = check_step(step_s, fastest_rad_s(truth)); !fine) {
    return Unexpected{fine.error()};
  }
  const auto thrusters = Thrusters::make(control.thrusters);
  if (!thrusters) {
    return Unexpected{thrusters.error()};
  }
  return AttitudeControl::make({.control_on_s = truth.phases.control_on_s,
                                .damped_rad_s = 0.0,
                                .pointing_at_s = truth.phases.acquisition_s},
                               RelayDamping{.torque_nm = control.thrusters.torque_nm,
                                            .dead_band_rad_s = control.dead_band_rad_s},
                               SunAcquisition{.inertia_kg_m2 = truth.inertia_kg_m2,
                                              .torque_nm_most = control.thrusters.torque_nm,
                                              .slew_rad_s = control.slew_rad_s,
                                              .period_s = control.period_s})
      .map([&](AttitudeControl&& laws) {
        return Flight{
            .loop = {BodyMotion{*body, truth.at_separation, step_s}, *thrusters, {}, steps},
            .control = std::move(laws)};
      });
}

}  // namespace

Expected<BodyMotion> separation_motion(const SeparationTruth& truth, const Orbit& orbit) {
  auto flight = flight_of(truth);
  if (!flight) {
    return Unexpected{flight.error()};
  }
  auto& [loop, control] = *flight;
  ApparentSun sun;
  while (loop.t_s() < truth.phases.end_s) {
    const TaiTime t = shifted(truth.separation, loop.t_s());
    const auto spacecraft = orbit.at(t);
    if (!spacecraft) {
      return Unexpected{spacecraft.error()};
    }
    const Measured measured = loop.measured(sun.direction_icrf(t, *spacecraft));
    loop.fly(control.torque_body_nm(loop.t_s(), measured), {.spacecraft = *spacecraft});
  }
  return std::move(loop).body();
}

}  // namespace spindrift
