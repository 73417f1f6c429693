#include <gtest/gtest.h>

#include "pipelines/frames/angle.h"
#include "tests/support/nutation_trials.h"

namespace spindrift::testing::spin_nutation_test {

TEST(SpinNutation, OfTwoTenthsOfADegreeIsFoundInThreeHundredTurns) {
  NutationTrials trials{1};
  for (int i = 0; i < 20; ++i) {
    const Nutation nutation = trials.random_nutation(0.2);
    SCOPED_TRACE(text_of(nutation));
    const FoundNutation found = trials.found(nutation);
    const Deviations off = deviations(found, nutation);
    EXPECT_LT(off.period_share, 0.01);
    EXPECT_LT(off.half_angle_sigmas, 3.0);
    EXPECT_TRUE(found.other_periods_s.empty());
  }
}

TEST(SpinNutation, OfSlenderAndFlatBodiesIsToldApart) {
  NutationTrials trials{2};
  for (const double inertia_ratio : {0.08, 0.2, 0.5, 0.9, 1.1, 1.5, 1.9}) {
    SCOPED_TRACE(inertia_ratio);
    const Nutation nutation = {.half_angle_rad = 0.2 * kRadPerDeg,
                               .inertia_ratio = inertia_ratio,
                               .first_azimuth_rad = 1.0};
    EXPECT_LT(deviations(trials.found(nutation), nutation).period_share, 1e-3);
  }
}

TEST(SpinNutation, OfDegreesIsFoundButForItsSecondOrder) {
  NutationTrials trials{7};
  const Nutation nutation = trials.random_nutation(3.0);
  SCOPED_TRACE(text_of(nutation));
  const FoundNutation found = trials.found(nutation);
  EXPECT_LT(deviations(found, nutation).period_share, 1e-3);
  EXPECT_NEAR(found.half_angle_rad.value / nutation.half_angle_rad, 1.0, 0.03);
}

TEST(SpinNutation, IsNotFoundWhereThereIsNone) {
  NutationTrials trials{3};
  for (int i = 0; i < 30; ++i) {
    EXPECT_FALSE(trials.searched({}).found);
  }
}

TEST(SpinNutation, IsNotMadeUpOutOfMisplacedSensorsAndAnOblateEarth) {
  for (const double duration_s : {300.0, 3600.0}) {
    NutationTrials trials{4, duration_s};
    trials.truth.horizon =
        infrared_horizon({.model = HorizonModel::Ellipsoid, .co2_altitude_km = 40.0},
                         trials.truth.horizon.pole_icrf);
    trials.truth.north->mount_angle_rad += 0.1 * kRadPerDeg;
    trials.truth.south->chord_excess_rad = 0.1 * kRadPerDeg;
    trials.truth.motion.rate_drift_rad_s2 = 1e-6;
    trials.truth.motion.coning = {.tilt_rad = 0.1 * kRadPerDeg};
    EXPECT_FALSE(trials.searched({}).found) << duration_s;
  }
}

TEST(SpinNutation, BelowWhatCouldBeDetectedIsSaidToBe) {
  NutationTrials trials{5};
  for (int i = 0; i < 10; ++i) {
    const Nutation nutation = trials.random_nutation(0.004);
    const auto search = trials.searched(nutation);
    EXPECT_FALSE(search.found);
    EXPECT_GT(search.detectable_rad, 3.0 * nutation.half_angle_rad);
    EXPECT_LT(search.detectable_rad, 0.03 * kRadPerDeg);
  }
}

TEST(SpinNutation, IsFoundWhereTheRateDrifts) {
  NutationTrials trials{6};
  trials.truth.motion.rate_drift_rad_s2 = -2e-4;  // 1 rpm in ten minutes.
  const Nutation nutation = trials.random_nutation(0.2);
  EXPECT_NEAR(trials.found(nutation).per_turn, nutation.per_turn(), 1e-3);
}

}  // namespace spindrift::testing::spin_nutation_test
