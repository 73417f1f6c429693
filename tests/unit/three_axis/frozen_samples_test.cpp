#include "pipelines/three_axis/frozen_samples.h"

#include <algorithm>
#include <cmath>
#include <numbers>
#include <random>

#include "tests/support/matchers.h"
#include "tests/support/turning_body.h"

namespace spindrift::testing::frozen_samples_test {

using Eigen::Vector3d;

constexpr double kNoise_rad_s = 3e-5;

/// Rounds to the nearest step.
Vector3d in_steps(const Vector3d& rate_rad_s, double step_rad_s) {
  return step_rad_s * (rate_rad_s / step_rad_s).array().round().matrix();
}

FrozenSamples with_steps(const Vector3d& steps_rad_s) {
  FrozenSamples gyro = FrozenSamples::of_gyro();
  gyro.learn(Vector3d::Zero(), steps_rad_s);
  return gyro;
}

/// Returns the number of the first equal sample that is reported as frozen, which must equal the
/// reported count; 0 if none is within `most`.
/// @param is_stuck Axes that repeat; the others have noise.
int first_frozen(FrozenSamples gyro, const Eigen::Array<bool, 3, 1>& is_stuck, int most = 1000) {
  std::mt19937_64 rng{1};
  for (int i = 1; i <= most; ++i) {
    const Vector3d going = normal_vector(rng, kNoise_rad_s);
    const int repeated =
        gyro.repeated(Vector3d{is_stuck.select(Vector3d::Constant(0.01), going)}, kNoise_rad_s);
    if (repeated > 0) {
      EXPECT_EQ(repeated, i);
      return i;
    }
  }
  return 0;
}

const Eigen::Array<bool, 3, 1> kAll{true, true, true};
const Eigen::Array<bool, 3, 1> kOne{false, true, false};

TEST(FrozenSamples, WhileNoRateHasChangedTenInARowAreFrozen) {
  EXPECT_EQ(first_frozen(FrozenSamples::of_gyro(), kAll), FrozenSamples::kGyroInARow);
  EXPECT_EQ(FrozenSamples::of_gyro().step(), 0.0);
}

TEST(FrozenSamples, OfFineStepsFiveInARowAreFrozen) {
  EXPECT_EQ(first_frozen(with_steps(Vector3d::Constant(1e-4 * kNoise_rad_s)), kAll), 5);
  EXPECT_EQ(first_frozen(with_steps(Vector3d::Constant(1e-4 * kNoise_rad_s)), kOne), 5);
}

TEST(FrozenSamples, ASampleThatDiffersEndsIt) {
  FrozenSamples gyro = with_steps(Vector3d::Constant(1e-9));
  for (int round = 0; round < 20; ++round) {
    for (int i = 0; i < 4; ++i) {
      EXPECT_EQ(gyro.repeated(Vector3d::Constant(round), kNoise_rad_s), 0);
    }
  }
}

TEST(FrozenSamples, StepsAreTheLeastChangesAndTheCoarsestAxisCounts) {
  FrozenSamples gyro = FrozenSamples::of_gyro();
  gyro.learn(Vector3d{0.0, 0.0, 0.0}, Vector3d{3e-6, -8e-6, 0.0});
  gyro.learn(Vector3d{3e-6, 8e-6, 0.0}, Vector3d{1e-6, 2e-6, 0.0});
  // The third component never changed and is assumed to be as fine as the finest.
  EXPECT_NEAR(gyro.step(), 6e-6, 1e-18);
  gyro.learn(Vector3d{0.0, 0.0, 0.0}, Vector3d{0.0, 0.0, 7e-6});
  EXPECT_NEAR(gyro.step(), 7e-6, 1e-18);
  gyro.learn(Vector3d{0.0, 0.0, 7e-6}, Vector3d{0.0, 0.0, 7e-6});
  EXPECT_NEAR(gyro.step(), 7e-6, 1e-18);
}

/// Returns the worst-case probability that two values of normal noise are rounded alike: their mean
/// is in the middle of a step.
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

/// The gyro has a third of its stated noise.
TEST(FrozenSamples, IsWhatNoiseDoesOnceInAThousandMillionTimes) {
  for (const double step : {0.003, 0.03, 0.1, 0.3}) {
    const double chance = chance_of_one_step(step, 1.0 / 3.0);
    const auto fewest = [](double of) {
      return std::max(5.0, 1.0 + std::log(1e-9) / std::log(of));
    };
    const FrozenSamples gyro = with_steps(Vector3d::Constant(step * kNoise_rad_s));
    EXPECT_NEAR(first_frozen(gyro, kOne), fewest(chance) + 0.5, 1.0) << step;
    EXPECT_NEAR(first_frozen(gyro, kAll), fewest(std::pow(chance, 3)) + 0.5, 1.0) << step;
  }
}

TEST(FrozenSamples, OfStepsThatHideTheNoiseNoneIs) {
  EXPECT_EQ(first_frozen(with_steps(Vector3d::Constant(2.0 * kNoise_rad_s)), kAll), 0);
  // The third axis is not hidden by its step.
  EXPECT_GT(first_frozen(with_steps({2.0 * kNoise_rad_s, 1e-9, 2.0 * kNoise_rad_s}), kAll), 0);
}

TEST(FrozenSamples, NeverIsAGyroWithNoiseOfAThirdOrMore) {
  std::mt19937_64 rng{2};
  for (const double step : {0.01, 0.1, 0.3, 1.0}) {
    for (const double quieter : {1.0, 3.0}) {
      FrozenSamples gyro = FrozenSamples::of_gyro();
      for (int i = 0; i < 10'000; ++i) {
        const Vector3d rate =
            in_steps(normal_vector(rng, kNoise_rad_s / quieter), step * kNoise_rad_s);
        ASSERT_EQ(gyro.learn_and_test(rate, kNoise_rad_s), 0) << step << " " << quieter << " " << i;
      }
    }
  }
}

/// Half the noise of the star tracker, as for components of a quaternion.
constexpr double kStar = 0.5 * 20.0 / 3600.0 * std::numbers::pi / 180.0;

Eigen::Vector4d star(std::mt19937_64& rng, double noise, double step) {
  Eigen::Vector4d q{0.5, -0.1, 0.7, 0.5};
  for (double& value : q) {
    value = step * std::round((value + std::normal_distribution<double>{0.0, noise}(rng)) / step);
  }
  return q;
}

TEST(FrozenSamples, OfReferencesTheSecondIs) {
  std::mt19937_64 rng{3};
  for (const int before : {0, 20}) {
    FrozenSamples samples = FrozenSamples::of_references();
    for (int i = 0; i < before; ++i) {
      ASSERT_EQ(samples.learn_and_test(star(rng, kStar, 1e-12), kStar), 0);
    }
    const Eigen::Vector4d stuck = star(rng, kStar, 1e-12);
    EXPECT_EQ(samples.learn_and_test(stuck, kStar), 0);
    for (int row = 2; row < 10; ++row) {
      EXPECT_EQ(samples.learn_and_test(stuck, kStar), row);
      EXPECT_EQ(samples.repeats(), row);
    }
    EXPECT_EQ(samples.learn_and_test(star(rng, kStar, 1e-12), kStar), 0);
    EXPECT_EQ(samples.repeats(), 0);
  }
}

/// The last component may be exactly 1 whatever the noise.
TEST(FrozenSamples, OneValueOfAReferenceMayStandStill) {
  std::mt19937_64 rng{4};
  FrozenSamples samples = FrozenSamples::of_references();
  for (int i = 0; i < 100; ++i) {
    Eigen::Vector4d q = star(rng, kStar, 1e-9);
    q[3] = 1.0;
    ASSERT_EQ(samples.learn_and_test(q, kStar), 0);
  }
}

/// The sensor is at rest, and a step has been seen.
TEST(FrozenSamples, AReferenceWithItsNoiseBelowTheStepIsNot) {
  std::mt19937_64 rng{5};
  for (const double step : {1.5, 5.0}) {
    FrozenSamples samples = FrozenSamples::of_references();
    samples.learn(Eigen::Vector4d::Zero(), Eigen::Vector4d::Constant(step * kStar));
    for (int i = 0; i < 1000; ++i) {
      ASSERT_EQ(samples.learn_and_test(star(rng, kStar / 3.0, step * kStar), kStar), 0)
          << step << " " << i;
    }
  }
}

}  // namespace spindrift::testing::frozen_samples_test
