#include "pipelines/three_axis/gyro_watch.h"

#include <cmath>
#include <numbers>
#include <random>

#include "tests/support/matchers.h"
#include "tests/support/turning_body.h"

namespace spindrift::testing::gyro_watch_test {

using Eigen::Vector3d;

constexpr GyroSensor kGyro{.noise_rad_s = 3e-5, .bias_sigma_rad_s = 2e-4, .range_rad_s = 0.2};

/// Judges a sample and accepts it if it is not rejected.
std::optional<Rejection> judge(GyroWatch& watch, const GyroSample& sample) {
  const auto rejected = watch.judge(sample);
  if (!rejected) {
    watch.accept(sample);
    return std::nullopt;
  }
  EXPECT_GE(rejected->failed.value().value, rejected->failed->limit);
  return rejected->rejected_by;
}

TEST(GyroWatch, ASaturatedSampleIsNoMeasurement) {
  GyroWatch watch{kGyro};
  EXPECT_EQ(judge(watch, {at_s(0.0), {0.1, 0.1, -0.199}}), std::nullopt);
  EXPECT_EQ(judge(watch, {at_s(0.1), {0.1, 0.1, -0.2}}), Rejection::Saturated);
  EXPECT_EQ(watch.out_because(), Rejection::Saturated);
  EXPECT_EQ(watch.last()->t, at_s(0.0));
  EXPECT_EQ(judge(watch, {at_s(0.2), {0.1, 0.1, -0.1}}), std::nullopt);
  EXPECT_EQ(watch.out_because(), std::nullopt);
}

/// Rounding as by the decimals of a file, single precision, or a 16-bit telemetry step.
TEST(GyroWatch, ARateThatIsClippedARoundingBelowItsRangeIsSaturated) {
  const double range_rad_s = *kGyro.range_rad_s;
  for (const double below : {1e-9, 6e-8, 1.0 / 32768.0, 1.0 / 2048.0}) {
    GyroWatch watch{kGyro};
    for (int i = 0; i < 20; ++i) {
      EXPECT_EQ(judge(watch, {at_s(0.1 * i), {0.1, -range_rad_s * (1.0 - below), 0.1}}),
                Rejection::Saturated)
          << below;
    }
  }
}

TEST(GyroWatch, WithoutARangeNothingIsSaturated) {
  GyroWatch watch{{.noise_rad_s = 3e-5, .bias_sigma_rad_s = 2e-4, .range_rad_s = std::nullopt}};
  EXPECT_EQ(judge(watch, {at_s(0.0), {10.0, 0.0, 0.0}}), std::nullopt);
}

TEST(GyroWatch, TenEqualSamplesInARowAreFrozenUntilOneDiffers) {
  GyroWatch watch{kGyro};
  const Vector3d rate_rad_s{0.01, 0.0, 0.0};
  for (int i = 0; i < 9; ++i) {
    EXPECT_EQ(judge(watch, {at_s(0.1 * i), rate_rad_s}), std::nullopt) << i;
  }
  for (int i = 9; i < 15; ++i) {
    EXPECT_EQ(judge(watch, {at_s(0.1 * i), rate_rad_s}), Rejection::Frozen) << i;
  }
  EXPECT_EQ(judge(watch, {at_s(1.5), {0.01 + 1e-5, 1e-5, 1e-5}}), std::nullopt);
}

TEST(GyroWatch, WanderIsWhatTheRateChangesByBeyondTheNoise) {
  std::mt19937_64 rng{71};
  // The first gyro has noise alone.
  GyroWatch still{kGyro};
  for (int i = 0; i < 2000; ++i) {
    judge(still, {at_s(0.1 * i), normal_vector(rng, kGyro.noise_rad_s)});
  }
  // The minimum is a degree in a minute, with its cube over three.
  const double least_rad2_s3 = std::pow(std::numbers::pi / 180.0, 2) * 3.0 / std::pow(60.0, 3);
  EXPECT_NEAR(still.wander_rad2_s3(), least_rad2_s3, 0.02 * least_rad2_s3);
  // The second gyro has a random walk of its rate.
  GyroWatch wandering{kGyro};
  const double walk_rad2_s3 = 1e-6;
  Vector3d rate_rad_s = Vector3d::Zero();
  double mean_rad2_s3 = 0.0;
  for (int i = 0; i < 20000; ++i) {
    rate_rad_s += normal_vector(rng, std::sqrt(0.1 * walk_rad2_s3));
    judge(wandering, {at_s(0.1 * i), rate_rad_s + normal_vector(rng, kGyro.noise_rad_s)});
    mean_rad2_s3 += i >= 200 ? wandering.wander_rad2_s3() / 19800.0 : 0.0;
  }
  EXPECT_NEAR(mean_rad2_s3, walk_rad2_s3, 0.1 * walk_rad2_s3);
}

TEST(GyroWatch, AGapIsLongerThanTheUsualInterval) {
  std::mt19937_64 rng{72};
  for (const double interval_s : {0.1, 1.0}) {
    GyroWatch watch{kGyro};
    // The first interval may differ, as in recorded flights.
    judge(watch, {at_s(0.0), normal_vector(rng, kGyro.noise_rad_s)});
    judge(watch, {at_s(0.3 * interval_s), normal_vector(rng, kGyro.noise_rad_s)});
    for (int i = 1; i < 30; ++i) {
      judge(watch, {at_s(interval_s * i), normal_vector(rng, kGyro.noise_rad_s)});
    }
    EXPECT_FALSE(watch.is_gap(1.1 * interval_s));
    EXPECT_TRUE(watch.is_gap(2.0 * interval_s));
  }
}

/// At rest, the telemetry step is ten times the noise and the true rate is near half a step.
TEST(GyroWatch, ABodyAtRestBelowTheStepOfTheTelemetryIsNotFrozenOnceAStepWasSeen) {
  std::mt19937_64 rng{73};
  GyroWatch watch{kGyro};
  const double step_rad_s = 10.0 * kGyro.noise_rad_s;
  const auto rounded = [&](double rate_rad_s) {
    const Vector3d rate = Vector3d::Constant(rate_rad_s) + normal_vector(rng, kGyro.noise_rad_s);
    return Vector3d{step_rad_s * (rate / step_rad_s).array().round()};
  };
  judge(watch, {at_s(-0.2), rounded(1.2 * step_rad_s)});
  judge(watch, {at_s(-0.1), rounded(0.1 * step_rad_s)});
  for (int i = 0; i < 3000; ++i) {
    ASSERT_EQ(judge(watch, {at_s(0.1 * i), rounded(0.1 * step_rad_s)}), std::nullopt) << i;
  }
}

TEST(GyroWatch, OneDeadAxisIsFrozen) {
  std::mt19937_64 rng{74};
  for (const bool from_the_start : {true, false}) {
    GyroWatch watch{kGyro};
    for (int i = 0; i < 200; ++i) {
      Vector3d rate_rad_s = normal_vector(rng, kGyro.noise_rad_s);
      if (from_the_start || i >= 100) {
        rate_rad_s.y() = 0.01;
      }
      const auto rejection = judge(watch, {at_s(0.1 * i), rate_rad_s});
      if (!from_the_start && i < 100) {
        EXPECT_EQ(rejection, std::nullopt) << i;
      } else if (i > 120 || (from_the_start && i > 30)) {
        EXPECT_EQ(rejection, Rejection::Frozen) << i;
      }
    }
  }
}

}  // namespace spindrift::testing::gyro_watch_test
