#include "pipelines/three_axis/gyro_outlier.h"

#include <gtest/gtest.h>

#include <cmath>
#include <numbers>
#include <random>

#include "tests/support/turning_body.h"

namespace spindrift::gyro_outlier_test {

using Eigen::Vector3d;
using testing::at_s;
using testing::normal_vector;

constexpr double kNoise_rad_s = 3e-5;
const Vector3d kNone = Vector3d::Zero();

Vector3d any_vector(std::mt19937_64& rng) { return normal_vector(rng, 0.01); }

TEST(ChangeOfRate, IsTheSlopeBesideTimesTheTime) {
  const GyroSample a{at_s(1.0), {0.1, 0.2, 0.3}};
  const GyroSample b{at_s(3.0), {0.2, 0.2, -0.1}};
  const Vector3d change = change_rad_s(a, b, at_s(3.0), at_s(3.5));
  EXPECT_LT((change - Vector3d{0.025, 0.0, 0.1}).norm(), 1e-12);
  // Whatever the order, and the direction of time.
  EXPECT_LT((change_rad_s(b, a, at_s(3.0), at_s(3.5)) - change).norm(), 1e-12);
  EXPECT_LT((change_rad_s(a, b, at_s(1.0), at_s(0.5)) - change).norm(), 1e-12);
}

TEST(StandsOut, NothingBetweenItsNeighboursDoes) {
  std::mt19937_64 rng{1};
  for (int i = 0; i < 1000; ++i) {
    const Vector3d before = any_vector(rng);
    const Vector3d behind = any_vector(rng);
    const double share = std::uniform_real_distribution{0.0, 1.0}(rng);
    EXPECT_FALSE(
        deviation(before, before + share * (behind - before), behind, kNone, 0.0).stands_out());
  }
}

TEST(StandsOut, WhatIsBeyondBothByMoreThanTheRateChangesDoesOnAnyAxis) {
  const Vector3d before{0.01, 0.02, 0.03};
  const Vector3d behind{0.02, 0.01, 0.03};
  const Vector3d change{1e-3, 2e-3, 3e-3};
  for (int axis = 0; axis < 3; ++axis) {
    for (const double sign : {-1.0, 1.0}) {
      const double farther =
          sign > 0.0 ? std::max(before[axis], behind[axis]) : std::min(before[axis], behind[axis]);
      Vector3d at = 0.5 * (before + behind);
      at[axis] = farther + sign * 0.999 * change[axis];
      EXPECT_FALSE(deviation(before, at, behind, change, 0.0).stands_out());
      at[axis] = farther + sign * 1.001 * change[axis];
      EXPECT_TRUE(deviation(before, at, behind, change, 0.0).stands_out());
      // Time and rates turned round: the same.
      EXPECT_TRUE(deviation(behind, at, before, change, 0.0).stands_out());
      EXPECT_TRUE(deviation(-before, -at, -behind, change, 0.0).stands_out());
    }
  }
}

/// The difference of two samples has the root of two times the noise of one.
TEST(StandsOut, NoiseOfTwoSamplesIsNotEnough) {
  const double limit = 5.0 * std::numbers::sqrt2 * kNoise_rad_s;
  EXPECT_FALSE(
      deviation(kNone, 0.999 * limit * Vector3d::UnitY(), kNone, kNone, kNoise_rad_s).stands_out());
  EXPECT_TRUE(
      deviation(kNone, 1.001 * limit * Vector3d::UnitY(), kNone, kNone, kNoise_rad_s).stands_out());
  std::mt19937_64 rng{2};
  for (int i = 0; i < 20'000; ++i) {
    const Vector3d before = normal_vector(rng, kNoise_rad_s);
    const Vector3d at = normal_vector(rng, kNoise_rad_s);
    ASSERT_FALSE(
        deviation(before, at, normal_vector(rng, kNoise_rad_s), kNone, kNoise_rad_s).stands_out());
  }
}

/// Samples of a line, the first of them at 0 s.
struct Ends {
  GyroSample at;
  GyroSample next;
  GyroSample next_but_one;

  Ends(double next_s, double next_but_one_s, const Vector3d& first, const Vector3d& slope)
      : at{at_s(0.0), first},
        next{at_s(next_s), first + next_s * slope},
        next_but_one{at_s(next_but_one_s), first + next_but_one_s * slope} {}
  bool stands_out_by(const Vector3d& off, double noise_rad_s) const {
    GyroSample moved = at;
    moved.rate_body_rad_s += off;
    return deviation_at_end(moved, next, next_but_one, noise_rad_s).stands_out();
  }
};

TEST(EndStandsOut, ASampleOnTheLineDoesNot) {
  std::mt19937_64 rng{3};
  for (const double next_s : {-0.3, -0.1, 0.1, 0.3}) {
    const Ends ends{next_s, 2.5 * next_s, any_vector(rng), any_vector(rng)};
    EXPECT_FALSE(ends.stands_out_by(kNone, 1e-12));
  }
}

TEST(EndStandsOut, NorDoesOneBeforeThrustersBegin) {
  const Vector3d rate{0.01, 0.02, 0.03};
  const GyroSample at{at_s(0.0), rate};
  const GyroSample next{at_s(0.1), rate};
  const GyroSample next_but_one{at_s(0.2), rate + Vector3d{0.01, -0.02, 0.0}};
  EXPECT_FALSE(deviation_at_end(at, next, next_but_one, 1e-12).stands_out());
  // It went the other way than they do: a spike.
  EXPECT_TRUE(
      deviation_at_end({at_s(0.0), rate + Vector3d{0.001, 0.0, 0.0}}, next, next_but_one, 1e-12)
          .stands_out());
}

/// Of what three samples with independent noise leave of a line.
TEST(EndStandsOut, NoiseIsThatOfAllThree) {
  std::mt19937_64 rng{4};
  for (const double next_but_one_s : {0.2, 0.3, 1.1}) {
    const double next_s = 0.1;
    // at - (1 + k) next + k next_but_one, with k what takes a line out of it.
    const double k = next_s / (next_but_one_s - next_s);
    double squares = 0.0;
    constexpr int kDraws = 20'000;
    for (int i = 0; i < kDraws; ++i) {
      const Vector3d draw = normal_vector(rng, kNoise_rad_s);
      squares += std::pow(draw.x() - (1.0 + k) * draw.y() + k * draw.z(), 2) / kDraws;
    }
    const double limit = 5.0 * std::sqrt(squares);
    const Ends ends{next_s, next_but_one_s, {0.01, 0.02, 0.03}, kNone};
    for (const double sign : {-1.0, 1.0}) {
      EXPECT_FALSE(ends.stands_out_by(sign * 0.97 * limit * Vector3d::UnitZ(), kNoise_rad_s));
      EXPECT_TRUE(ends.stands_out_by(sign * 1.03 * limit * Vector3d::UnitZ(), kNoise_rad_s));
    }
  }
}

TEST(EndStandsOut, TheLastIsLikeTheFirst) {
  const Vector3d slope{0.01, -0.02, 0.0};
  const Vector3d off{0.002, 0.0, 0.0};
  const Ends first{0.1, 0.2, {0.01, 0.02, 0.03}, slope};
  const Ends last{-0.1, -0.2, {0.01, 0.02, 0.03}, -slope};
  EXPECT_TRUE(first.stands_out_by(off, kNoise_rad_s));
  EXPECT_TRUE(last.stands_out_by(off, kNoise_rad_s));
}

}  // namespace spindrift::gyro_outlier_test
