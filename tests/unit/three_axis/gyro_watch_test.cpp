#include "pipelines/three_axis/gyro_watch.h"

#include <gtest/gtest.h>

#include <cmath>
#include <random>

#include "tests/support/turning_body.h"

namespace spindrift::gyro_watch_test {

using Eigen::Vector3d;
using testing::at_s;
using testing::normal_vector;

constexpr GyroSensor kGyro{.noise_rad_s = 3e-5, .bias_sigma_rad_s = 2e-4, .range_rad_s = 0.2};

TEST(GyroWatch, ASaturatedSampleIsNoMeasurement) {
  GyroWatch watch{kGyro};
  EXPECT_EQ(watch.judge({at_s(0.0), {0.1, 0.1, -0.199}}), std::nullopt);
  EXPECT_EQ(watch.judge({at_s(0.1), {0.1, 0.1, -0.2}}), SampleRejection::Saturated);
  EXPECT_EQ(watch.out_because(), SampleRejection::Saturated);
  EXPECT_EQ(watch.last()->t, at_s(0.0));
  EXPECT_EQ(watch.judge({at_s(0.2), {0.1, 0.1, -0.1}}), std::nullopt);
  EXPECT_EQ(watch.out_because(), std::nullopt);
}

TEST(GyroWatch, WithoutARangeNothingIsSaturated) {
  GyroWatch watch{{.noise_rad_s = 3e-5, .bias_sigma_rad_s = 2e-4, .range_rad_s = std::nullopt}};
  EXPECT_EQ(watch.judge({at_s(0.0), {10.0, 0.0, 0.0}}), std::nullopt);
}

TEST(GyroWatch, TenEqualSamplesInARowAreFrozenUntilOneDiffers) {
  GyroWatch watch{kGyro};
  const Vector3d rate_rad_s{0.01, 0.0, 0.0};
  for (int i = 0; i < 9; ++i) {
    EXPECT_EQ(watch.judge({at_s(0.1 * i), rate_rad_s}), std::nullopt) << i;
  }
  for (int i = 9; i < 15; ++i) {
    EXPECT_EQ(watch.judge({at_s(0.1 * i), rate_rad_s}), SampleRejection::Frozen) << i;
  }
  EXPECT_EQ(watch.judge({at_s(1.5), {0.01, 1e-9, 0.0}}), std::nullopt);
}

TEST(GyroWatch, WanderIsWhatTheRateChangesByBeyondTheNoise) {
  std::mt19937_64 rng{71};
  // Noise alone.
  GyroWatch still{kGyro};
  for (int i = 0; i < 2000; ++i) {
    still.judge({at_s(0.1 * i), normal_vector(rng, kGyro.noise_rad_s)});
  }
  const double of_noise = 2.0 * kGyro.noise_rad_s * kGyro.noise_rad_s;
  EXPECT_LT(still.wander_rad2_s3(), of_noise);
  // A random walk of the rate.
  GyroWatch wandering{kGyro};
  const double walk_rad2_s3 = 1e-6;
  Vector3d rate_rad_s = Vector3d::Zero();
  double mean_rad2_s3 = 0.0;
  for (int i = 0; i < 20000; ++i) {
    rate_rad_s += normal_vector(rng, std::sqrt(0.1 * walk_rad2_s3));
    wandering.judge({at_s(0.1 * i), rate_rad_s + normal_vector(rng, kGyro.noise_rad_s)});
    mean_rad2_s3 += i >= 200 ? wandering.wander_rad2_s3() / 19800.0 : 0.0;
  }
  EXPECT_NEAR(mean_rad2_s3, walk_rad2_s3, 0.1 * walk_rad2_s3);
}

TEST(GyroWatch, AGapIsLongerThanTheUsualInterval) {
  std::mt19937_64 rng{72};
  for (const double interval_s : {0.1, 1.0}) {
    GyroWatch watch{kGyro};
    // The first interval may be any, as that of recorded flights is.
    watch.judge({at_s(0.0), normal_vector(rng, kGyro.noise_rad_s)});
    watch.judge({at_s(0.3 * interval_s), normal_vector(rng, kGyro.noise_rad_s)});
    for (int i = 1; i < 30; ++i) {
      watch.judge({at_s(interval_s * i), normal_vector(rng, kGyro.noise_rad_s)});
    }
    EXPECT_FALSE(watch.is_gap(1.1 * interval_s));
    EXPECT_TRUE(watch.is_gap(2.0 * interval_s));
  }
}

}  // namespace spindrift::gyro_watch_test
