#include "pipelines/spin/batch/pass_edges.h"

#include <cmath>
#include <utility>

#include "tests/support/matchers.h"
#include "tests/support/observed_spin.h"

namespace spindrift::testing::pass_edges_test {

PulseUse use(std::int64_t t_ns, PulseChannel channel, std::optional<std::int64_t> revolution,
             std::optional<Rejection> rejected_by = std::nullopt) {
  return {.pulse = {.t = tai_from_ns(t_ns), .channel = channel},
          .revolution = revolution,
          .rejected_by = rejected_by};
}

SpinEstimate estimate(SpinEstimator estimator, const Eigen::Vector3d& axis_icrf, Quality quality) {
  return {.t = {},
          .estimator = estimator,
          .axis_icrf = axis_icrf,
          .covariance_rad2 = Eigen::Matrix2d::Identity(),
          .spin_rate_rad_s = 1.0,
          .spin_rate_sigma_rad_s = 1.0,
          .assessment = {quality}};
}

SpinFix ambiguous(const Eigen::Vector3d& axis_icrf, const Eigen::Vector3d& alternate_icrf) {
  SpinFix fix = made_fix(axis_icrf, Eigen::Matrix2d::Identity());
  fix.alternates = {{.axis_icrf = alternate_icrf}};
  fix.resolution = Resolution::Ambiguous;
  fix.accepted = false;
  return fix;
}

TEST(PassEdges, AreThoseThatARevolutionHasAPlaceForInOrderAndOnce) {
  PassEdges pass;
  pass.collect(use(30, PulseChannel::NorthIn, 1));
  pass.collect(use(10, PulseChannel::Sun1, 1));
  pass.collect(use(10, PulseChannel::Sun1, 1));  // The same edge is reported again, now decided.
  pass.collect(use(20, PulseChannel::Sun2, 1, Rejection::SunAngle));
  pass.collect(use(25, PulseChannel::Sun2, 1, Rejection::Phase));
  pass.collect(use(40, PulseChannel::SouthIn, std::nullopt, Rejection::Unassociated));
  const auto edges = std::move(pass).edges();
  ASSERT_EQ(edges.size(), 3U);
  EXPECT_EQ(edges[0].pulse.channel, PulseChannel::Sun1);
  // The angle failed its test; the fit finds out which of its two edges is wrong.
  EXPECT_EQ(edges[1].pulse.channel, PulseChannel::Sun2);
  EXPECT_EQ(edges[2].pulse.channel, PulseChannel::NorthIn);
}

TEST(PassEdges, KnowThatNoiseChoseAmongCopies) {
  PassEdges pass;
  SpinEstimate mean = estimate(SpinEstimator::Mean, Eigen::Vector3d::UnitX(), Quality::Ok);
  pass.collect(mean);
  EXPECT_FALSE(pass.noise_chose_among_copies());
  doubt(mean.assessment, {ReasonCode::CopiesInNoise});
  EXPECT_EQ(mean.assessment.quality, Quality::Doubtful);
  pass.collect(mean);
  pass.collect(estimate(SpinEstimator::Sequential, Eigen::Vector3d::UnitX(), Quality::Lost));
  EXPECT_TRUE(pass.noise_chose_among_copies());
}

TEST(PassEdges, OfMoreThanADayAreTheLast) {
  PassEdges pass;
  constexpr auto kMost = static_cast<std::int64_t>(PassEdges::kMost);
  constexpr std::int64_t kEdges = 2 * kMost + 17;
  for (std::int64_t i = 0; i < kEdges; ++i) {
    EXPECT_TRUE(i > kMost || !pass.forgot_some());
    pass.collect(use(i, PulseChannel::Sun1, i));
  }
  EXPECT_TRUE(pass.forgot_some());
  const auto edges = std::move(pass).edges();
  ASSERT_EQ(edges.size(), PassEdges::kMost);
  EXPECT_EQ(edges.front().revolution, kEdges - kMost);
  EXPECT_EQ(edges.back().revolution, kEdges - 1);
}

TEST(PassEdges, KeepTheLastRevolutions) {
  PassEdges pass;
  for (std::int64_t revolution = 0; revolution < 10; ++revolution) {
    pass.collect(use(revolution, PulseChannel::Sun1, revolution));
  }
  pass.keep_last(3);
  const auto edges = std::move(pass).edges();
  ASSERT_EQ(edges.size(), 3U);
  EXPECT_EQ(edges.front().revolution, 7);
}

TEST(PassEdges, BeginAtTheEstimatesAndWhereTheseAreAmbiguousAtAllCandidates) {
  const Eigen::Vector3d x = Eigen::Vector3d::UnitX();
  const Eigen::Vector3d y = Eigen::Vector3d::UnitY();
  const Eigen::Vector3d z = Eigen::Vector3d::UnitZ();
  const SpinPrior prior{.axis_icrf = -z, .sigma_rad = 0.1};
  PassEdges pass;
  EXPECT_TRUE(pass.starts({}).axes_icrf.empty());
  EXPECT_EQ(pass.starts(prior).axes_icrf, std::vector<Eigen::Vector3d>{-z});
  pass.collect(ambiguous(x, y));
  EXPECT_EQ(pass.starts(prior).axes_icrf.size(), 2U);
  pass.collect(estimate(SpinEstimator::Sequential, x, Quality::Ambiguous));
  EXPECT_EQ(pass.starts(prior).axes_icrf.size(), 2U);
  pass.collect(estimate(SpinEstimator::Mean, z, Quality::Ok));
  EXPECT_EQ(pass.starts(prior).axes_icrf.size(), 3U);
  pass.collect(estimate(SpinEstimator::Sequential, x, Quality::Ok));
  const auto starts = pass.starts(prior).axes_icrf;
  EXPECT_THAT(starts, ElementsAre(x, z));
}

TEST(PassEdges, BeginAtEstimatesThatDifferByADegree) {
  // One of the two estimates may lie in a narrow chord that the other misses.
  const Eigen::Vector3d x = Eigen::Vector3d::UnitX();
  PassEdges pass;
  pass.collect(estimate(SpinEstimator::Sequential, x, Quality::Doubtful));
  pass.collect(estimate(SpinEstimator::Mean, {std::cos(0.01), std::sin(0.01), 0.0}, Quality::Ok));
  EXPECT_EQ(pass.starts({}).axes_icrf.size(), 2U);
  pass.collect(estimate(SpinEstimator::Mean, {std::cos(0.001), std::sin(0.001), 0.0}, Quality::Ok));
  EXPECT_EQ(pass.starts({}).axes_icrf.size(), 1U);
}

}  // namespace spindrift::testing::pass_edges_test
