/// Attitude from the magnetometer alone: a few of the starts of long/gukf_many_test.cpp, and the
/// real field that Swarm measured.

#include <gtest/gtest.h>

#include <Eigen/Dense>
#include <cmath>
#include <optional>
#include <random>
#include <string>

#include "pipelines/ephemeris/earth_orientation.h"
#include "pipelines/frames/angle.h"
#include "pipelines/ground_model/dynamics/rigid_body.h"
#include "pipelines/three_axis/unscented/gukf_bank.h"
#include "pipelines/time/utc.h"
#include "tests/support/bank_flight.h"
#include "tests/support/swarm_table.h"
#include "tests/support/tumbling_body.h"

namespace spindrift::testing::gukf_test {

using Eigen::Vector3d;

TEST(Gukf, FindsAttitudeAndRateOfATumblingBodyThatIsOffTheMissionFile) {
  constexpr int kRuns = 20;
  constexpr TumblingPrior kReal{
      .moments = 0.05, .mounting_rad = 0.3 * kRadPerDeg, .bias_nt = 100.0};
  double nees = 0.0;
  for (std::uint64_t run = 0; run < kRuns; ++run) {
    std::mt19937_64 rng{4001 + run};
    TumblingBody body{rng, 2.0 * kRadPerDeg, drawn(kReal, rng)};
    const BankOutcome outcome = bank_outcome(tumbling_model(kReal), body, 10.0, kTwoOrbits_s / 2.0);
    EXPECT_LT(outcome.off_deg, 2.0) << run;
    EXPECT_LT(outcome.rate_off_deg_s, 0.02) << run;
    EXPECT_TRUE(outcome.is_safe()) << run;
    nees += outcome.nees;
  }
  RecordProperty("nees", std::to_string(nees / kRuns));
  EXPECT_NEAR(nees, 6.0 * kRuns, 3.0 * std::sqrt(12.0 * kRuns));
}

/// Swarm's star trackers turned what it measured into north, east and down. A tumbling body sees
/// that field, which on this pass is 0.37 deg (rms) off the model.
TEST(Gukf, FindsTheAttitudeInTheFieldThatSwarmMeasured) {
  const SwarmTable table = swarm_table("swarmA_20160101_192rows.csv");
  const MainFieldModel& model = igrf14();
  const RigidBody body = RigidBody::make(kTumblingMoments_kg_m2.asDiagonal()).value();
  constexpr int kRuns = 10;
  double squares_deg2 = 0.0;
  for (std::uint64_t run = 0; run < kRuns; ++run) {
    std::mt19937_64 rng{4101 + run};
    BodyState truth{any_attitude(rng), normal_vector(rng, 0.5 * kRadPerDeg)};
    const auto seen = [&](std::size_t row) {
      const TaiTime t = parse_utc(table.at(row, "Timestamp")).value();
      const LocalFrame frame = table.frame(row);
      const Eigen::Quaterniond q_icrf_ned = earth_orientation(t) * frame.q_itrf_ned;
      const Vector3d model_ned_nt = model.at(decimal_year(t)).value().ned_at(frame).value();
      return SeenField{
          .body_nt = truth.q_icrf_body.conjugate() * (q_icrf_ned * table.vector(row, "B_NEC")),
          .ref_icrf_nt = q_icrf_ned * model_ned_nt,
          .noise_nt = 200.0};
    };
    const SeenField first = seen(0);
    std::optional<GukfBank> bank;
    for (std::size_t row = 1; row < table.rows.size(); ++row) {
      for (int step = 0; step < 10; ++step) {
        truth = body.after(truth, {}, 1.0);
      }
      if (bank) {
        bank->propagate(10.0);
        bank->update(seen(row));
      } else {
        bank.emplace(tumbling_model({}), first, seen(row), 10.0);
      }
    }
    squares_deg2 += std::pow(degrees(motion_error(bank->best(), truth).head<3>().norm()), 2);
  }
  RecordProperty("rms_deg", std::to_string(std::sqrt(squares_deg2 / kRuns)));
  EXPECT_LT(std::sqrt(squares_deg2 / kRuns), 2.0 * 0.37);
}

}  // namespace spindrift::testing::gukf_test
