#include "pipelines/three_axis/frozen_gyro.h"

#include <gtest/gtest.h>

#include <algorithm>
#include <cmath>
#include <numbers>
#include <random>

#include "tests/support/turning_body.h"

namespace spindrift::frozen_gyro_test {

using Eigen::Vector3d;
using testing::normal_vector;

constexpr double kNoise_rad_s = 3e-5;

/// Told to the nearest step.
Vector3d in_steps(const Vector3d& rate_rad_s, double step_rad_s) {
  return step_rad_s * (rate_rad_s / step_rad_s).array().round().matrix();
}

/// That has seen these steps of the telemetry.
FrozenGyro with_steps(const Vector3d& steps_rad_s) {
  FrozenGyro gyro{kNoise_rad_s};
  gyro.learn(Vector3d::Zero(), steps_rad_s);
  return gyro;
}

/// The first of equal samples that is said to be one too many, and that it says how many there are;
/// 0: none in so many.
/// @param is_stuck Those axes repeat, the others go on by noise.
int first_frozen(FrozenGyro gyro, const Eigen::Array<bool, 3, 1>& is_stuck, int most = 1000) {
  std::mt19937_64 rng{1};
  for (int i = 1; i <= most; ++i) {
    const Vector3d going = normal_vector(rng, kNoise_rad_s);
    const int repeated = gyro.repeated(is_stuck.select(Vector3d::Constant(0.01), going));
    if (repeated > 0) {
      EXPECT_EQ(repeated, i);
      return i;
    }
  }
  return 0;
}

const Eigen::Array<bool, 3, 1> kAll{true, true, true};
const Eigen::Array<bool, 3, 1> kOne{false, true, false};

TEST(FrozenGyro, WhileNoRateHasChangedTenInARowAreFrozen) {
  EXPECT_EQ(first_frozen(FrozenGyro{kNoise_rad_s}, kAll), FrozenGyro::kFrozenInARow);
  EXPECT_EQ(FrozenGyro{kNoise_rad_s}.step_rad_s(), 0.0);
}

TEST(FrozenGyro, OfFineStepsFiveInARowAreFrozen) {
  EXPECT_EQ(first_frozen(with_steps(Vector3d::Constant(1e-4 * kNoise_rad_s)), kAll), 5);
  EXPECT_EQ(first_frozen(with_steps(Vector3d::Constant(1e-4 * kNoise_rad_s)), kOne), 5);
}

TEST(FrozenGyro, ASampleThatDiffersEndsIt) {
  FrozenGyro gyro = with_steps(Vector3d::Constant(1e-9));
  for (int round = 0; round < 20; ++round) {
    for (int i = 0; i < 4; ++i) {
      EXPECT_EQ(gyro.repeated(Vector3d::Constant(round)), 0);
    }
  }
}

TEST(FrozenGyro, StepsAreTheLeastChangesAndTheCoarsestAxisCounts) {
  FrozenGyro gyro{kNoise_rad_s};
  gyro.learn({0.0, 0.0, 0.0}, {3e-6, -8e-6, 0.0});
  gyro.learn({3e-6, 8e-6, 0.0}, {1e-6, 2e-6, 0.0});
  // The third never changed: it is taken for as fine as the finest.
  EXPECT_NEAR(gyro.step_rad_s(), 6e-6, 1e-18);
  gyro.learn({0.0, 0.0, 0.0}, {0.0, 0.0, 7e-6});
  EXPECT_NEAR(gyro.step_rad_s(), 7e-6, 1e-18);
  gyro.learn({0.0, 0.0, 7e-6}, {0.0, 0.0, 7e-6});
  EXPECT_NEAR(gyro.step_rad_s(), 7e-6, 1e-18);
}

/// That two values of normal noise are told as one, at worst: the mean in the middle of a step.
double chance_of_one_step(double step, double sigma) {
  double chance = 0.0;
  for (int cell = -200; cell <= 200; ++cell) {
    const auto below = [&](double at) {
      return 0.5 * std::erfc(-at * step / (sigma * std::numbers::sqrt2));
    };
    const double share = below(cell + 0.5) - below(cell - 0.5);
    chance += share * share;
  }
  return chance;
}

/// Of a gyro that is three times as quiet as stated.
TEST(FrozenGyro, IsWhatNoiseDoesOnceInAThousandMillionTimes) {
  for (const double step : {0.003, 0.03, 0.1, 0.3}) {
    const double chance = chance_of_one_step(step, 1.0 / 3.0);
    const auto fewest = [](double of) {
      return std::max(5.0, 1.0 + std::log(1e-9) / std::log(of));
    };
    const FrozenGyro gyro = with_steps(Vector3d::Constant(step * kNoise_rad_s));
    EXPECT_NEAR(first_frozen(gyro, kOne), fewest(chance) + 0.5, 1.0) << step;
    EXPECT_NEAR(first_frozen(gyro, kAll), fewest(std::pow(chance, 3)) + 0.5, 1.0) << step;
  }
}

TEST(FrozenGyro, OfStepsThatHideTheNoiseNoneIs) {
  EXPECT_EQ(first_frozen(with_steps(Vector3d::Constant(2.0 * kNoise_rad_s)), kAll), 0);
  // Two axes that hide it leave the third to speak.
  EXPECT_GT(first_frozen(with_steps({2.0 * kNoise_rad_s, 1e-9, 2.0 * kNoise_rad_s}), kAll), 0);
}

TEST(FrozenGyro, NeverIsAGyroWithNoiseOfAThirdOrMore) {
  std::mt19937_64 rng{2};
  for (const double step : {0.01, 0.1, 0.3, 1.0}) {
    for (const double quieter : {1.0, 3.0}) {
      FrozenGyro gyro{kNoise_rad_s};
      Vector3d last = Vector3d::Zero();
      for (int i = 0; i < 10'000; ++i) {
        const Vector3d rate =
            in_steps(normal_vector(rng, kNoise_rad_s / quieter), step * kNoise_rad_s);
        gyro.learn(last, rate);
        last = rate;
        ASSERT_EQ(gyro.repeated(rate), 0) << step << " " << quieter << " " << i;
      }
    }
  }
}

}  // namespace spindrift::frozen_gyro_test
