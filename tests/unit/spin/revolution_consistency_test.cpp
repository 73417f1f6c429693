#include "pipelines/spin/disambiguation/revolution_consistency.h"

#include <gtest/gtest.h>

namespace spindrift::revolution_consistency_test {

AxisCandidates found(bool consistent) {
  const AxisCandidate candidate{.axis_icrf = Eigen::Vector3d::UnitX(),
                                .covariance_rad2 = Eigen::Matrix2d::Identity(),
                                .norm = 1.0,
                                .consistent = consistent,
                                .model_shift_icrf = Eigen::Matrix<double, 3, kModelErrors>::Zero()};
  return {.geometry_case = 1, .candidates = {candidate}, .told_apart = true, .near_tangent = false};
}

FoundCandidates none(bool contradictory) {
  return tl::unexpected{
      NoCandidates{.why = {NoFixCode::ConesApart}, .contradictory = contradictory}};
}

TEST(RevolutionConsistency, IsDeservedUntilMostContradictThemselves) {
  RevolutionConsistency trust{100.0};
  EXPECT_TRUE(trust.most_consistent());
  trust.count(found(true));
  trust.count(found(false));
  EXPECT_FALSE(trust.most_consistent());
  trust.count(found(true));
  EXPECT_TRUE(trust.most_consistent());
}

TEST(RevolutionConsistency, CountsWhatNoAxisExplainsAndNotWhatCannotGiveOne) {
  RevolutionConsistency trust{100.0};
  trust.count(found(true));
  for (int i = 0; i < 10; ++i) {
    trust.count(none(false));
  }
  EXPECT_TRUE(trust.most_consistent());
  trust.count(none(true));
  EXPECT_FALSE(trust.most_consistent());
}

TEST(RevolutionConsistency, ForgetsWhatIsLongPast) {
  RevolutionConsistency trust{20.0};
  for (int i = 0; i < 1000; ++i) {
    trust.count(found(true));
  }
  for (int i = 0; i < 20; ++i) {
    trust.count(found(false));
  }
  EXPECT_FALSE(trust.most_consistent());
}

}  // namespace spindrift::revolution_consistency_test
