#include <memory>
#include <string>
#include <utility>
#include <vector>

#include "services/archive/archive.h"
#include "services/archive/stored_results.h"
#include "tests/integration/archive_fixture.h"
#include "tests/support/matchers.h"
#include "tests/support/of_kind.h"

namespace spindrift::archive_reconstruction_test {

constexpr std::int64_t kSecond_ns = 1'000'000'000;

ReconstructedAttitude attitude_at(std::int64_t t_s) {
  return {.t = tai_from_ns(t_s * kSecond_ns),
          .q_icrf_body = Eigen::Quaterniond{0.5, -0.5, 0.1, 0.7},
          .rate_body_rad_s = {0.25, -0.5, 1.0},
          .covariance_rad2 = 4.0 / 3.0 * kRadPerDeg * kRadPerDeg * Eigen::Matrix3d::Identity(),
          .noise_covariance_rad2 = kRadPerDeg * kRadPerDeg * Eigen::Matrix3d::Identity() / 3.0,
          .rate_covariance_rad2_s2 = Eigen::Matrix3d::Zero()};
}

using Events = std::vector<std::pair<SeparationEvent, std::int64_t>>;

/// @param samples Number of samples used.
/// @param history_s Times of the history, in order.
ReconstructionProduct product(ReconstructionMethod method, std::int64_t samples,
                              const Events& events, const std::vector<std::int64_t>& history_s) {
  ReconstructedSeparation separation{.solution = {.method = method,
                                                  .events = {},
                                                  .history = {},
                                                  .bias = std::nullopt,
                                                  .misalignment = std::nullopt,
                                                  .open_bias = {},
                                                  .gyro = {},
                                                  .sun = {},
                                                  .star = {},
                                                  .assessment = {Quality::Ok},
                                                  .iterations = 1},
                                     .in_orbit_frame = {},
                                     .launcher = std::nullopt,
                                     .samples = samples};
  for (const auto& [event, t_s] : events) {
    separation.solution.events.push_back(
        {.event = event, .found = false, .attitude = attitude_at(t_s)});
  }
  for (const std::int64_t t_s : history_s) {
    separation.solution.history.push_back(attitude_at(t_s));
  }
  return std::make_shared<const ReconstructedSeparation>(std::move(separation));
}

using enum SeparationEvent;
using enum ReconstructionMethod;

ReconstructionProduct early_solution() {
  return product(Batch, 10, {{Separation, 1}, {ControlOn, 2}, {Acquisition, 3}, {FirstStarFix, 5}},
                 {1, 2, 3, 4, 5});
}
ReconstructionProduct later_solution() {
  return product(Batch, 20, {{Separation, 1}, {ControlOn, 2}, {FirstStarFix, 6}}, {1, 2, 6});
}

AttitudeEstimate filtered_at(std::int64_t t_s) {
  return {.t = tai_from_ns(t_s * kSecond_ns),
          .q_icrf_body = Eigen::Quaterniond::Identity(),
          .rate_body_rad_s = std::nullopt,
          .covariance_rad2 = Eigen::Matrix3d::Identity(),
          .assessment = {Quality::Ok}};
}

class ArchiveReconstruction : public testing::ArchiveFixture {};

TEST_F(ArchiveReconstruction, ALaterSolutionTakesThePlaceOfAllOfTheEarlier) {
  store_run({filtered_at(4), early_solution(), product(Sequential, 10, {{Separation, 1}}, {1})});
  store_more({later_solution()});
  EXPECT_THAT(texts("SELECT source || (t_tai_ns / 1000000000) FROM attitude ORDER BY 1"),
              ElementsAre("batch1", "batch2", "batch6", "mekf4", "sequential1"));
  EXPECT_THAT(texts("SELECT method || event FROM reconstruction_event ORDER BY 1"),
              ElementsAre("batchT1", "batchT2", "batchT4", "sequentialT1"));
  EXPECT_THAT(texts("SELECT method || samples FROM reconstruction ORDER BY 1"),
              ElementsAre("batch20", "sequential10"));
}

TEST_F(ArchiveReconstruction, AttitudesOfALiveRunSayWhenTheyWereAnnounced) {
  ArchiveBatch live = testing::start_of("run-1");
  live.start->mode = RunMode::Live;
  store(live);
  store_more({early_solution()});
  EXPECT_EQ(text("SELECT count(announced_utc) FROM attitude"), "5");
}

TEST_F(ArchiveReconstruction, ReconstructedAttitudesDoNotPoseAsThatOfThePass) {
  store_run({filtered_at(4), early_solution()});
  EXPECT_EQ(text("SELECT source || (t_tai_ns / 1000000000) FROM attitude_answer"), "mekf4");
  EXPECT_EQ(text("SELECT estimator FROM pass_verdict"), "mekf");
  EXPECT_EQ(text("SELECT format('%s %s %d %g %.3f %.3f', method, quality, t1_tai_ns / 1000000000, "
                 "qw, sigma_deg, cov_zz_deg2) FROM separation_verdict"),
            "batch OK 1 0.5 2.000 1.333");

  const auto stored = find_stored_results(path(), "run-1").value();
  const auto attitudes = of_kind<AttitudeEstimate>(stored.in_force());
  EXPECT_THAT(attitudes, ElementsAre(::testing::Field(&AttitudeEstimate::t, filtered_at(4).t)));
}

TEST_F(ArchiveReconstruction, TheVerdictOfARunThatOnlyReconstructsIsItsT1) {
  store_run({product(Sequential, 10, {{Separation, 1}}, {1}), early_solution()});
  EXPECT_EQ(text("SELECT format('%s %s %g %.3f %s', estimator, quality, qw, sigma_deg, why) FROM "
                 "pass_verdict"),
            "batch OK 0.5 2.000 OK; 1.7 of 2 deg is alignment");
  EXPECT_THAT(texts("SELECT source FROM attitude_answer"), IsEmpty());
}

TEST_F(ArchiveReconstruction, ComesBackAsItIsAnnouncedAndOneOfMoreSamplesIsNews) {
  store_run({early_solution()});
  const auto stored = find_stored_results(path(), "run-1").value();
  ASSERT_EQ(stored.in_force().size(), 1U);
  const auto back = std::get<ReconstructionProduct>(stored.in_force().front());
  const auto expected = ProductKind<ReconstructionProduct>::announced_as(early_solution());
  const auto announced = ProductKind<ReconstructionProduct>::announced_as(back);
  ASSERT_EQ(announced.size(), 4U);
  for (std::size_t i = 0; i < announced.size(); ++i) {
    EXPECT_EQ(announced[i].t, expected[i].t);
    EXPECT_EQ(announced[i].q_icrf_body.coeffs(), expected[i].q_icrf_body.coeffs());
    EXPECT_EQ(announced[i].rate_body_rad_s, expected[i].rate_body_rad_s);
    EXPECT_NEAR(announced[i].sigma_rad(), expected[i].sigma_rad(), 1e-15);
    EXPECT_NEAR(announced[i].noise_sigma_rad, expected[i].noise_sigma_rad, 1e-15);
    EXPECT_EQ(announced[i].source, AttitudeSource::Batch);
    EXPECT_EQ(announced[i].assessment, expected[i].assessment);
  }
  EXPECT_EQ(announced.back().t, early_solution()->solution.events.front().attitude.t);
  EXPECT_TRUE(stored.hold(early_solution()));
  EXPECT_FALSE(stored.hold(later_solution()));
}

TEST_F(ArchiveReconstruction, StaysWhenProductsOfARunThatGoesOnAreWithdrawn) {
  store_run({filtered_at(2), filtered_at(4), early_solution()});
  store(testing::going_on_from(3 * kSecond_ns));
  EXPECT_THAT(texts("SELECT source || (t_tai_ns / 1000000000) FROM attitude ORDER BY 1"),
              ElementsAre("batch1", "batch2", "batch3", "batch4", "batch5", "mekf2"));
  EXPECT_EQ(count("reconstruction_event"), 4);
  EXPECT_EQ(count("reconstruction"), 1);
}

}  // namespace spindrift::archive_reconstruction_test
