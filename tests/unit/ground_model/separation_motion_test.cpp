#include "pipelines/ephemeris/sun.h"
#include "pipelines/frames/angle.h"
#include "pipelines/frames/celestial.h"
#include "pipelines/frames/rotation_vector.h"
#include "pipelines/ground_model/flights/three_axis_flights.h"
#include "pipelines/reconstruction/torque_free_arc.h"
#include "tests/support/low_orbit.h"
#include "tests/support/matchers.h"

namespace spindrift::separation_motion_test {

using Eigen::Vector3d;

constexpr TaiTime kSeparation = tai_from_ns(1'772'337'637'000'000'000);

const Orbit kOrbit = testing::low_orbit(kSeparation);

/// Holds the phases in s after the start, in order.
struct Phases {
  double control_on_s;
  double acquisition_s;
  double end_s;
};

/// Returns the truth of Li 2017, which damps from these rates.
SeparationTruth truth_at(const Phases& phases) {
  const Vector3d rate_deg_s{0.618844, -0.33139, 0.065912};
  return {.body = {.start = kSeparation,
                   .at_start = {.q_icrf_body = quaternion_by({2.0, -1.0, 0.5}),
                                .rate_body_rad_s = kRadPerDeg * rate_deg_s},
                   .inertia_kg_m2 = Vector3d{120.0, 100.0, 140.0}.asDiagonal(),
                   .end_s = phases.end_s},
          .control = {.thrusters = {.torque_nm = 0.07, .shortest_s = 0.01, .longest_s = 1.0},
                      .dead_band_rad_s = 0.03 * kRadPerDeg,
                      .slew_rad_s = 0.5 * kRadPerDeg},
          .control_on_s = phases.control_on_s,
          .acquisition_s = phases.acquisition_s};
}

double fastest_deg_s(const BodyState& state) {
  return degrees(state.rate_body_rad_s.cwiseAbs().maxCoeff());
}

double sun_off_deg(const BodyMotion& motion, double t_s) {
  const TaiTime t = shifted(kSeparation, t_s);
  return degrees(angle_between_rad(motion.at(t_s).q_icrf_body * -Vector3d::UnitZ(),
                                   ApparentSun{}.direction_icrf(t, kOrbit.at(t).value())));
}

TEST(SeparationMotion, DriftsWithoutTorqueUntilControlIsOn) {
  const SeparationTruth truth =
      truth_at({.control_on_s = 60.0, .acquisition_s = 100.0, .end_s = 60.0});
  const BodyMotion motion = separation_motion(truth, kOrbit).value();
  const BodyState expected =
      torque_free_arc(start_of_arc(truth.body.at_start), truth.body.inertia_kg_m2, 60.0).body;
  EXPECT_LT(angle_between_rad(motion.last().q_icrf_body, expected.q_icrf_body), 1e-9);
  EXPECT_LT((motion.last().rate_body_rad_s - expected.rate_body_rad_s).norm(), 1e-11);
}

TEST(SeparationMotion, RelaysDampTheFlightsRatesIn18Seconds) {
  const BodyMotion motion =
      separation_motion(truth_at({.control_on_s = 0.0, .acquisition_s = 40.0, .end_s = 40.0}),
                        kOrbit)
          .value();
  EXPECT_GT(fastest_deg_s(motion.at(17.5)), 0.03);
  EXPECT_LT(fastest_deg_s(motion.at(18.5)), 0.03);
  EXPECT_LT(fastest_deg_s(motion.at(40.0)), 0.03);
}

TEST(SeparationMotion, TurnsToTheSunFromAnywhereAndStays) {
  for (int i = 0; i < 12; ++i) {
    SeparationTruth truth = truth_at({.control_on_s = 0.0, .acquisition_s = 18.0, .end_s = 1200.0});
    truth.body.at_start.q_icrf_body = quaternion_by(0.5 * i * Vector3d{0.8, -0.3, 0.52});
    const BodyMotion motion = separation_motion(truth, kOrbit).value();
    for (double t_s = 600.0; t_s <= 1200.0; ++t_s) {
      EXPECT_LT(sun_off_deg(motion, t_s), 0.2) << i << " at " << t_s;
    }
    EXPECT_LT(fastest_deg_s(motion.at(700.0)), 0.01) << i;
  }
}

TEST(SeparationMotion, TurnsNoFasterThanItMay) {
  const BodyMotion motion =
      separation_motion(truth_at({.control_on_s = 0.0, .acquisition_s = 20.0, .end_s = 300.0}),
                        kOrbit)
          .value();
  for (double t_s = 20.0; t_s < 300.0; ++t_s) {
    EXPECT_LT(degrees(motion.at(t_s).rate_body_rad_s.norm()), 0.52);
  }
}

TEST(SeparationMotion, AcquiresTheSunByPulsesOfAPeriodOfASecond) {
  SeparationTruth truth = truth_at({.control_on_s = 0.0, .acquisition_s = 20.0, .end_s = 700.0});
  truth.control.period_s = 1.0;
  truth.control.thrusters = {.torque_nm = 0.02, .shortest_s = 0.05, .longest_s = 0.8};
  const BodyMotion motion = separation_motion(truth, kOrbit).value();
  EXPECT_LT(motion.step_s(), 0.051);
  EXPECT_LT(sun_off_deg(motion, 600.0), 0.5);
  EXPECT_LT(sun_off_deg(motion, 700.0), 0.5);
}

TEST(SeparationMotion, RefusesWhatCannotBe) {
  const Phases phases{.control_on_s = 10.0, .acquisition_s = 20.0, .end_s = 30.0};
  const auto error_of = [](const SeparationTruth& truth) {
    return separation_motion(truth, kOrbit).error();
  };
  SeparationTruth truth = truth_at(phases);
  truth.body.inertia_kg_m2(0, 0) = 300.0;
  EXPECT_THAT(error_of(truth).message, HasSubstr("not above the sum of the others"));
  truth = truth_at(phases);
  truth.acquisition_s = 5.0;
  EXPECT_EQ(error_of(truth).code, ErrorCode::InvalidConfiguration);
  truth = truth_at(phases);
  truth.control.thrusters.shortest_s = 0.0;
  EXPECT_THAT(error_of(truth).message, HasSubstr("thrusters of 0.07 N m"));
  truth = truth_at(phases);
  truth.body.at_start.rate_body_rad_s = {0.0, 0.0, 3.0};
  EXPECT_THAT(error_of(truth).message, HasSubstr("too coarse for a body that turns by"));
}

}  // namespace spindrift::separation_motion_test
