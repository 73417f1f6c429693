#include "pipelines/ground_model/flights/separation_motion.h"

#include <utility>

#include "pipelines/ephemeris/sun.h"
#include "pipelines/ground_model/control/attitude_control.h"

namespace spindrift {
namespace {

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

}  // namespace

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

}  // namespace spindrift
