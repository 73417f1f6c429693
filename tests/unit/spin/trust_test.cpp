#include "pipelines/spin/disambiguation/trust.h"

#include <gtest/gtest.h>

namespace spindrift {
namespace {

AxisCandidates found(bool consistent) {
  const AxisCandidate candidate{.axis_icrf = Eigen::Vector3d::UnitX(),
                                .covariance_rad2 = Eigen::Matrix2d::Identity(),
                                .norm = 1.0,
                                .consistent = consistent,
                                .model_shift_icrf = Eigen::Matrix<double, 3, kModelErrors>::Zero()};
  return {.geometry_case = 1, .candidates = {candidate}, .told_apart = true, .grazing = false};
}

Expected<AxisCandidates> none(ErrorCode code) { return Unexpected{{code, "none"}}; }

TEST(Trust, IsDeservedUntilMostContradictThemselves) {
  Trust trust{100.0};
  EXPECT_TRUE(trust.deserved());
  trust.count(found(true));
  trust.count(found(false));
  EXPECT_FALSE(trust.deserved());
  trust.count(found(true));
  EXPECT_TRUE(trust.deserved());
}

TEST(Trust, CountsWhatNoAxisExplainsAndNotWhatCannotGiveOne) {
  Trust trust{100.0};
  trust.count(found(true));
  for (int i = 0; i < 10; ++i) {
    trust.count(none(ErrorCode::Unobservable));
  }
  EXPECT_TRUE(trust.deserved());
  trust.count(none(ErrorCode::InvalidInput));
  EXPECT_FALSE(trust.deserved());
}

TEST(Trust, ForgetsWhatIsLongPast) {
  Trust trust{20.0};
  for (int i = 0; i < 1000; ++i) {
    trust.count(found(true));
  }
  for (int i = 0; i < 20; ++i) {
    trust.count(found(false));
  }
  EXPECT_FALSE(trust.deserved());
}

}  // namespace
}  // namespace spindrift
