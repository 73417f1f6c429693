#include "pipelines/reconstruction/star_consensus.h"

#include <gtest/gtest.h>

#include "pipelines/frames/rotation_vector.h"

namespace spindrift::star_consensus_test {

using Eigen::Matrix3d;
using Eigen::Quaterniond;
using Eigen::Vector3d;

constexpr double kStar_rad = 1e-4;

const RateTrack kRates{
    {{0.0, Vector3d{0.0, 0.0, 0.01}}, {100.0, Vector3d{0.0, 0.0, 0.01}}}, 0.0, 100.0, 1e-5};
const ConsensusNoise kNoise{kStar_rad, Vector3d::Zero(), 1e-8 * Matrix3d::Identity()};

std::vector<StarObservation> fixes(int count) {
  std::vector<StarObservation> stars;
  for (int i = 0; i < count; ++i) {
    stars.push_back({static_cast<double>(i), quaternion_by(Vector3d{0.0, 0.0, 0.01 * i})});
  }
  return stars;
}

TEST(StarConsensus, OfOneFixIsThatFix) {
  const StarConsensus found = consensus_of(kRates, fixes(1), kNoise);
  EXPECT_EQ(found.accepted.size(), 1U);
  EXPECT_FALSE(found.contradict);
}

TEST(StarConsensus, LeavesOutTheFixThatIsFarOffWhereverItIs) {
  for (const std::size_t wrong : {0U, 3U, 9U}) {
    std::vector<StarObservation> stars = fixes(10);
    stars[wrong].q_icrf_body = stars[wrong].q_icrf_body * quaternion_by({0.0, 0.05, 0.0});
    const StarConsensus found = consensus_of(kRates, stars, kNoise);
    EXPECT_EQ(found.gated.size(), 1U);
    EXPECT_FALSE(found.contradict);
    for (const StarObservation& star : found.accepted) {
      EXPECT_NE(star.t_s, stars[wrong].t_s);
    }
  }
}

/// False in the same way: the first has most of its neighbours with it, until these are gone.
TEST(StarConsensus, LeavesOutFourFalseOnesBeforeFiveTrueOnes) {
  std::vector<StarObservation> stars = fixes(9);
  for (std::size_t i = 0; i < 4; ++i) {
    stars[i].q_icrf_body = stars[i].q_icrf_body * quaternion_by({0.0, 0.05, 0.0});
  }
  const StarConsensus found = consensus_of(kRates, stars, kNoise);
  EXPECT_EQ(found.gated.size(), 4U);
  EXPECT_EQ(found.accepted.front().t_s, 4.0);
}

TEST(StarConsensus, SaysThatTwoContradictEachOther) {
  std::vector<StarObservation> stars = fixes(2);
  stars[0].q_icrf_body = stars[0].q_icrf_body * quaternion_by({0.0, 0.05, 0.0});
  const StarConsensus found = consensus_of(kRates, stars, kNoise);
  EXPECT_TRUE(found.contradict);
  EXPECT_EQ(found.accepted.size(), 2U);
}

TEST(StarConsensus, TakesAFlippedSignForTheSameAttitude) {
  std::vector<StarObservation> stars = fixes(3);
  stars[1].q_icrf_body.coeffs() *= -1.0;
  EXPECT_EQ(consensus_of(kRates, stars, kNoise).accepted.size(), 3U);
}

}  // namespace spindrift::star_consensus_test
