/// Attitude and rate of tumbling bodies from the magnetometer alone, over many random starts: how
/// often and how soon they are found, whether sigma is right, and what is seen of errors that the
/// filter does not know.

#include <gtest/gtest.h>

#include <Eigen/Dense>
#include <cmath>
#include <limits>
#include <random>
#include <string>

#include "pipelines/frames/angle.h"
#include "pipelines/three_axis/unscented/gukf.h"
#include "tests/support/bank_flight.h"
#include "tests/support/tumbling_body.h"

namespace spindrift::testing::gukf_many_test {

using Eigen::Vector3d;

constexpr double kMost_rad_s = 2.0 * kRadPerDeg;

struct Tally {
  int runs = 0;
  int right = 0;
  int soon = 0;  ///< Within 5 deg by 900 s.
  int safe = 0;
  int safe_but_wrong = 0;  ///< By more than 15 deg.
  int beyond = 0;          ///< Safe, and off by more than chance explains once in 30,000 times.
  double nees = 0.0;       ///< Sum over the safe.

  void add(const BankOutcome& outcome) {
    ++runs;
    right += outcome.is_right() ? 1 : 0;
    soon += outcome.off_at_900_s_deg < 5.0 ? 1 : 0;
    if (outcome.is_safe()) {
      ++safe;
      safe_but_wrong += outcome.off_deg > 15.0 ? 1 : 0;
      beyond += outcome.nees > 30.0 ? 1 : 0;
      nees += outcome.nees;
    }
  }
  void record(const std::string& what) const {
    ::testing::Test::RecordProperty(
        what, std::to_string(right) + " right, " + std::to_string(soon) + " by 900 s, " +
                  std::to_string(safe) + " safe, of " + std::to_string(runs) + ", NEES " +
                  std::to_string(nees / safe) + ", beyond " + std::to_string(beyond));
  }
  void expect_found(int most_lost, double share_soon = 0.9) const {
    EXPECT_GE(right, runs - most_lost);
    EXPECT_GE(soon, share_soon * runs);
    EXPECT_GE(safe, 0.98 * runs);
    EXPECT_EQ(safe_but_wrong, 0);
  }
  void expect_sigma_right() const {
    const double freedom = 6.0 * safe;
    EXPECT_NEAR(nees, freedom, 1.96 * std::sqrt(2.0 * freedom));
    EXPECT_EQ(beyond, 0);
  }
};

Tally tally_of(const TumblingPrior& prior, int runs, double period_s, std::uint64_t seed) {
  Tally tally;
  for (int run = 0; run < runs; ++run) {
    std::mt19937_64 rng{seed + static_cast<std::uint64_t>(run)};
    TumblingBody body{rng, kMost_rad_s, drawn(prior, rng)};
    tally.add(bank_outcome(tumbling_model(prior), body, period_s, kTwoOrbits_s));
  }
  return tally;
}

/// The moment of one axis is off by 20 %.
Tally tally_with_wrong_inertia(const TumblingPrior& prior, int runs, double period_s,
                               std::uint64_t seed) {
  Tally tally;
  for (int run = 0; run < runs; ++run) {
    std::mt19937_64 rng{seed + static_cast<std::uint64_t>(run)};
    TumblingErrors errors = drawn(prior, rng);
    errors.moments.setZero();
    errors.moments[run % 3] = run / 3 % 2 == 0 ? 0.2 : -0.2;
    TumblingBody body{rng, kMost_rad_s, errors};
    tally.add(bank_outcome(tumbling_model(prior), body, period_s, kTwoOrbits_s));
  }
  return tally;
}

/// As real hardware differs from a mission file.
constexpr TumblingPrior kReal{.moments = 0.05, .mounting_rad = 0.3 * kRadPerDeg, .bias_nt = 100.0};

TEST(GukfMany, FindTheAttitudeWithAnExactMissionFile) {
  const Tally slow = tally_of({}, 200, 10.0, 5'010'000);
  slow.record("at_0.1_hz");
  slow.expect_found(2);
  slow.expect_sigma_right();
  const Tally fast = tally_of({}, 40, 1.0, 5'020'000);
  fast.record("at_1_hz");
  fast.expect_found(1);
  fast.expect_sigma_right();
}

TEST(GukfMany, FindTheAttitudeWithRealHardware) {
  const Tally slow = tally_of(kReal, 200, 10.0, 5'030'000);
  slow.record("at_0.1_hz");
  slow.expect_found(2);
  slow.expect_sigma_right();
  const Tally fast = tally_of(kReal, 40, 1.0, 5'040'000);
  fast.record("at_1_hz");
  fast.expect_found(1);
  fast.expect_sigma_right();
}

TEST(GukfMany, FindTheAttitudeWithAWrongInertia) {
  const Tally exact = tally_with_wrong_inertia({.moments = 0.2}, 200, 10.0, 5'050'000);
  exact.record("at_0.1_hz");
  exact.expect_found(2);
  TumblingPrior prior = kReal;
  prior.moments = 0.2;
  const Tally real = tally_with_wrong_inertia(prior, 200, 10.0, 5'060'000);
  real.record("real_at_0.1_hz");
  real.expect_found(2, 0.85);
  const Tally fast = tally_with_wrong_inertia(prior, 40, 1.0, 5'070'000);
  fast.record("real_at_1_hz");
  fast.expect_found(1);
}

TEST(GukfMany, OneFilterAloneIsOftenLost) {
  int right = 0;
  for (std::uint64_t run = 0; run < 200; ++run) {
    std::mt19937_64 rng{5'080'000 + run};
    TumblingBody body{rng, kMost_rad_s, {}};
    UncertainMotion start{.motion = {any_attitude(rng), Vector3d::Zero()},
                          .covariance = Eigen::Matrix<double, 6, 6>::Identity()};
    start.covariance.topLeftCorner<3, 3>() *= std::pow(40.0 * kRadPerDeg, 2);
    start.covariance.bottomRightCorner<3, 3>() *= std::pow(kMost_rad_s, 2);
    Gukf filter{tumbling_model({}), start};
    while (body.t_s() < kTwoOrbits_s) {
      filter.update(body.field());
      body.advance(10.0);
      filter.propagate(10.0, {}, body.position_icrf_km(body.t_s() - 5.0));
    }
    const Eigen::Matrix<double, 6, 1> error = motion_error(filter, body.state());
    right += degrees(error.head<3>().norm()) < 1.0 ? 1 : 0;
  }
  RecordProperty("right_of_200", right);
  EXPECT_LT(right, 190);
}

/// What a magnetometer does that the filter cannot know; 40 runs each.
class GukfBadInput : public ::testing::Test {
 protected:
  template <class Seen>
  Tally tally_of_bad(const TumblingPrior& prior, const TumblingErrors& errors, const Seen& seen) {
    Tally tally;
    for (std::uint64_t run = 0; run < 40; ++run) {
      std::mt19937_64 rng{5'100'000 + run};
      TumblingErrors off = drawn(kReal, rng);
      off.moments += errors.moments;
      off.bias_nt += errors.bias_nt;
      off.torque_nm = errors.torque_nm;
      off.late_s = errors.late_s;
      TumblingBody body{rng, kMost_rad_s, off};
      tally.add(bank_outcome(tumbling_model(prior), body, 10.0, kTwoOrbits_s, seen));
    }
    return tally;
  }
  static SeenField as_it_is(const SeenField& field) { return field; }
};

TEST_F(GukfBadInput, AConstantReadingIsNeverSafe) {
  const Tally tally = tally_of_bad(kReal, {}, [](SeenField field) {
    field.body_nt = {12'000.0, -20'000.0, 15'000.0};
    return field;
  });
  tally.record("constant");
  EXPECT_EQ(tally.safe, 0);
}

TEST_F(GukfBadInput, ASaturatedMagnetometerIsNeverSafeAndWrong) {
  const Tally tally = tally_of_bad(kReal, {}, [](SeenField field) {
    field.body_nt = field.body_nt.cwiseMax(-15'000.0).cwiseMin(15'000.0);
    return field;
  });
  tally.record("saturated");
  EXPECT_EQ(tally.safe_but_wrong, 0);
  EXPECT_EQ(tally.beyond, 0);
}

TEST_F(GukfBadInput, ALateTimeTagIsNeverSafe) {
  const Tally tally = tally_of_bad(kReal, {.late_s = 300.0}, as_it_is);
  tally.record("late");
  EXPECT_EQ(tally.safe, 0);
}

TEST_F(GukfBadInput, ALargeBiasIsNeverSafeAndWrong) {
  for (const double bias_nt : {300.0, 2000.0}) {
    const Tally tally =
        tally_of_bad(kReal, {.bias_nt = bias_nt * Vector3d{0.6, -0.64, 0.48}}, as_it_is);
    tally.record("bias_" + std::to_string(static_cast<int>(bias_nt)));
    EXPECT_EQ(tally.safe_but_wrong, 0);
  }
}

TEST_F(GukfBadInput, ATorqueIsEstimatedWhereItHasAState) {
  const TumblingErrors torque{.torque_nm = 2e-6 * Vector3d{0.6, -0.64, 0.48}};
  TumblingPrior prior = kReal;
  prior.torque_nm = 2e-6;
  const Tally known = tally_of_bad(prior, torque, as_it_is);
  known.record("with_state");
  EXPECT_GE(known.right, 38);
  EXPECT_GE(known.safe, 38);
  EXPECT_EQ(known.safe_but_wrong, 0);
  const Tally unknown = tally_of_bad(kReal, torque, as_it_is);
  unknown.record("without_state");
  EXPECT_EQ(unknown.safe_but_wrong, 0);
}

TEST_F(GukfBadInput, AnInertiaBeyondItsPriorIsNeverSafeAndWrong) {
  const Tally tally = tally_of_bad(kReal, {.moments = {0.0, 0.2, 0.0}}, as_it_is);
  tally.record("inertia");
  EXPECT_EQ(tally.safe_but_wrong, 0);
}

}  // namespace spindrift::testing::gukf_many_test
