#include "pipelines/reconstruction/star_consensus.h"

#include <cmath>

#include "pipelines/frames/rotation_vector.h"
#include "pipelines/observation/innovation_gate.h"
#include "tests/support/matchers.h"

namespace spindrift::star_consensus_test {

using Eigen::Matrix3d;
using Eigen::Quaterniond;
using Eigen::Vector3d;

constexpr double kStar_rad = 1e-4;

const Observations kAll{
    .origin = tai_from_ns(7'000'000'000),
    .events = {},
    .rates = {
        {{0.0, Vector3d{0.0, 0.0, 0.01}}, {100.0, Vector3d{0.0, 0.0, 0.01}}}, 0.0, 100.0, 1e-5}};
const ConsensusNoise kNoise{kStar_rad, Vector3d::Zero(), prior_of(1e-4, AttitudeAlignment::Zero())};

std::vector<StarObservation> fixes(int count) {
  std::vector<StarObservation> stars;
  for (int i = 0; i < count; ++i) {
    stars.push_back({static_cast<double>(i), quaternion_by(Vector3d{0.0, 0.0, 0.01 * i})});
  }
  return stars;
}

TEST(StarConsensus, OfOneFixIsThatFix) {
  const StarConsensus found = consensus_of(kAll, fixes(1), kNoise);
  EXPECT_EQ(found.accepted.size(), 1U);
  EXPECT_FALSE(found.contradict);
  ASSERT_EQ(found.said.size(), 1U);
  EXPECT_EQ(found.said[0].t, kAll.origin);
  EXPECT_EQ(found.said[0].residual.freedom, 0);
  EXPECT_FALSE(found.said[0].rejected_by);
}

TEST(StarConsensus, LeavesOutTheFixThatIsFarOffWhereverItIs) {
  for (const std::size_t wrong : {0U, 3U, 9U}) {
    std::vector<StarObservation> stars = fixes(10);
    stars[wrong].q_icrf_body = stars[wrong].q_icrf_body * quaternion_by({0.0, 0.05, 0.0});
    const StarConsensus found = consensus_of(kAll, stars, kNoise);
    EXPECT_EQ(found.gated().size(), 1U);
    EXPECT_FALSE(found.contradict);
    for (const StarObservation& star : found.accepted) {
      EXPECT_NE(star.t_s, stars[wrong].t_s);
    }
  }
}

/// The middle of the neighbours is compared for fixes at the start, inside and at the end.
TEST(StarConsensus, EachSaysHowFarItIsOffTheMiddleOfItsNeighboursAboutItsAxes) {
  for (const std::size_t wrong : {0U, 3U, 9U}) {
    std::vector<StarObservation> stars = fixes(10);
    const Vector3d off_rad{0.0, 0.05, -0.02};
    stars[wrong].q_icrf_body = stars[wrong].q_icrf_body * quaternion_by(off_rad);
    const StarConsensus found = consensus_of(kAll, stars, kNoise);
    ASSERT_EQ(found.said.size(), 10U);
    for (std::size_t i = 0; i < found.said.size(); ++i) {
      const Observation& said = found.said[i];
      EXPECT_EQ(said.t, shifted(kAll.origin, static_cast<double>(i)));
      EXPECT_EQ(said.source, SampleSource::Star);
      EXPECT_EQ(said.residual.freedom, 3);
      EXPECT_EQ(said.limit, innovation_gate(3));
      EXPECT_EQ(said.rejected_by.has_value(), i == wrong);
      EXPECT_EQ(said.nis > said.limit, i == wrong);
      EXPECT_LT((said.residual.value - (i == wrong ? off_rad : Vector3d::Zero())).norm(), 1e-12);
      // The residual combines two fixes, the gyro and its bias, so all axes are alike for small
      // angles.
      const double squares =
          (said.residual.value.array() / said.residual.sigma.array()).square().sum();
      EXPECT_NEAR(squares, said.nis, 1e-3 * said.nis + 1e-12);
      EXPECT_GT(said.residual.sigma.minCoeff(), std::sqrt(2.0) * kStar_rad);
    }
  }
}

/// The false fixes agree with each other: the first has most of its neighbours with it until these
/// are gone.
TEST(StarConsensus, LeavesOutFourFalseOnesBeforeFiveTrueOnes) {
  std::vector<StarObservation> stars = fixes(9);
  for (std::size_t i = 0; i < 4; ++i) {
    stars[i].q_icrf_body = stars[i].q_icrf_body * quaternion_by({0.0, 0.05, 0.0});
  }
  const StarConsensus found = consensus_of(kAll, stars, kNoise);
  EXPECT_EQ(found.gated().size(), 4U);
  EXPECT_EQ(found.accepted.front().t_s, 4.0);
}

TEST(StarConsensus, SaysThatTwoContradictEachOther) {
  std::vector<StarObservation> stars = fixes(2);
  stars[0].q_icrf_body = stars[0].q_icrf_body * quaternion_by({0.0, 0.05, 0.0});
  const StarConsensus found = consensus_of(kAll, stars, kNoise);
  EXPECT_TRUE(found.contradict);
  EXPECT_EQ(found.accepted.size(), 2U);
  EXPECT_EQ(found.said.size(), 2U);
  for (const Observation& said : found.said) {
    EXPECT_EQ(said.residual.freedom, 3);
    EXPECT_GT(said.nis, said.limit);
    EXPECT_FALSE(said.rejected_by);
  }
}

/// The body turns by 4 rad between the first fix and the last, ever faster.
TEST(StarConsensus, AllowsForErrorsOfTheMissionFile) {
  const auto angle_rad = [](double t_s) { return 0.01 * t_s + 5e-5 * t_s * t_s; };
  const Observations all{
      .origin = kAll.origin,
      .events = {},
      .rates = {
          {{0.0, Vector3d{0.0, 0.0, 0.01}}, {200.0, Vector3d{0.0, 0.0, 0.03}}}, 0.0, 200.0, 1e-7}};
  const auto check = [&](int error, double size, const auto& q_at) {
    std::vector<StarObservation> stars;
    for (const double t_s : {0.0, 100.0, 200.0}) {
      stars.push_back({t_s, q_at(t_s)});
    }
    const auto agree = [&](double sigma) {
      ConsensusNoise noise{kStar_rad, Vector3d::Zero(), prior_of(1e-7, AttitudeAlignment::Zero())};
      noise.shared(error, error) = sigma * sigma;
      const StarConsensus found = consensus_of(all, stars, noise);
      return found.gated().empty() && !found.contradict;
    };
    EXPECT_TRUE(agree(size)) << error;
    EXPECT_FALSE(agree(0.01 * size)) << error;
  };
  const auto about_z = [](double turned_rad) {
    return quaternion_by(Vector3d{0.0, 0.0, turned_rad});
  };
  check(SharedStarTracker, 0.02, [&](double t_s) {
    return Quaterniond{about_z(angle_rad(t_s)) * quaternion_by({0.02, 0.0, 0.0})};
  });
  check(SharedGyro + 2, 0.02, [&](double t_s) { return about_z(angle_rad(t_s) / 1.02); });
  check(SharedStarTime, 2.0, [&](double t_s) { return about_z(angle_rad(t_s - 2.0)); });
}

TEST(StarConsensus, TakesAFlippedSignForTheSameAttitude) {
  std::vector<StarObservation> stars = fixes(3);
  stars[1].q_icrf_body.coeffs() *= -1.0;
  EXPECT_EQ(consensus_of(kAll, stars, kNoise).accepted.size(), 3U);
}

}  // namespace spindrift::star_consensus_test
