#include "pipelines/three_axis/gyro_screening.h"

#include <algorithm>
#include <random>

#include "tests/support/matchers.h"

namespace spindrift::gyro_screening_test {

using Eigen::Vector3d;

constexpr GyroSensor kGyro{.noise_rad_s = 3.5e-5, .bias_sigma_rad_s = 1e-4, .range_rad_s = 0.1};

std::vector<GyroSample> noisy(int count, double grid_rad_s = 0.0) {
  std::mt19937_64 generator{3};
  std::normal_distribution<double> normal;
  std::vector<GyroSample> samples;
  for (int i = 0; i < count; ++i) {
    Vector3d rate{0.01, -0.02, 0.001 * i / count};
    for (double& axis : rate) {
      axis += kGyro.noise_rad_s * normal(generator);
      axis = grid_rad_s > 0.0 ? grid_rad_s * std::round(axis / grid_rad_s) : axis;
    }
    samples.push_back({shifted(tai_from_ns(0), 0.25 * i), rate});
  }
  return samples;
}

/// Counts the samples rejected by `test` and expects each to exceed its limit.
std::int64_t count(const ScreenedGyro& found, Rejection test) {
  std::int64_t count = 0;
  for (const RejectedSample& sample : found.left_out) {
    EXPECT_GE(sample.failed.value().value, sample.failed->limit);
    count += sample.rejected_by == test ? 1 : 0;
  }
  return count;
}

TEST(GyroScreening, KeepsWhatIsGoodAndSeesItsNoise) {
  const ScreenedGyro screened_gyro = screened(noisy(2000), kGyro);
  EXPECT_EQ(screened_gyro.usable.size(), 2000U);
  EXPECT_TRUE(screened_gyro.left_out.empty());
  EXPECT_NEAR(screened_gyro.noise.value(), 1.0, 0.06);
}

TEST(GyroScreening, LeavesOutWhatRepeatsButForItsFirst) {
  std::vector<GyroSample> samples = noisy(400);
  for (std::size_t i = 101; i < 120; ++i) {
    samples[i].rate_body_rad_s = samples[100].rate_body_rad_s;
  }
  const ScreenedGyro screened_gyro = screened(samples, kGyro);
  EXPECT_EQ(count(screened_gyro, Rejection::Frozen), 19);
  EXPECT_EQ(screened_gyro.usable.size(), 381U);
  for (const RejectedSample& sample : screened_gyro.left_out) {
    EXPECT_EQ(sample.failed.value().value, 20.0);
  }
}

TEST(GyroScreening, LeavesOutWhatRepeatsAboutOneAxis) {
  std::vector<GyroSample> samples = noisy(400, 0.1 * kGyro.noise_rad_s);
  for (std::size_t i = 101; i < 120; ++i) {
    samples[i].rate_body_rad_s.y() = samples[100].rate_body_rad_s.y();
  }
  EXPECT_EQ(count(screened(samples, kGyro), Rejection::Frozen), 19);
}

/// On a grid of three times the noise most samples repeat by chance.
TEST(GyroScreening, KeepsWhatRepeatsOnACoarseGrid) {
  EXPECT_TRUE(screened(noisy(2000, 3.0 * kGyro.noise_rad_s), kGyro).left_out.empty());
}

TEST(GyroScreening, LeavesOutWhatIsAtTheEndOfTheRange) {
  std::vector<GyroSample> samples = noisy(100);
  samples[40].rate_body_rad_s.y() = -0.1;
  samples[41].rate_body_rad_s.z() = 0.13;
  const ScreenedGyro screened_gyro = screened(samples, kGyro);
  EXPECT_EQ(count(screened_gyro, Rejection::Saturated), 2);
  EXPECT_EQ(screened_gyro.usable.size(), 98U);
}

TEST(GyroScreening, LeavesOutASpikeWhereverItIs) {
  for (const std::size_t spike : {0U, 1U, 57U, 98U, 99U}) {
    for (const double size_rad_s : {-0.002, 0.002, 0.08}) {
      std::vector<GyroSample> samples = noisy(100);
      samples[spike].rate_body_rad_s.x() += size_rad_s;
      const ScreenedGyro found = screened(samples, kGyro);
      EXPECT_EQ(count(found, Rejection::Outlier), 1) << spike << " " << size_rad_s;
      EXPECT_EQ(found.left_out.at(0).t, samples[spike].t);
      EXPECT_EQ(found.usable.size(), 99U);
      EXPECT_EQ(found.first_is_outlier, spike == 0);
      EXPECT_TRUE(std::ranges::none_of(
          found.usable, [&](const auto& sample) { return sample.t == samples[spike].t; }));
    }
  }
}

TEST(GyroScreening, SaysWhatItLeavesOutInOrderOfTime) {
  std::vector<GyroSample> samples = noisy(400);
  samples[0].rate_body_rad_s.setZero();
  samples[20].rate_body_rad_s.x() = 0.2;
  samples[40].rate_body_rad_s.y() += 0.002;
  for (std::size_t i = 61; i < 80; ++i) {
    samples[i].rate_body_rad_s = samples[60].rate_body_rad_s;
  }
  samples[399].rate_body_rad_s.z() += 0.002;
  const ScreenedGyro found = screened(samples, kGyro);
  EXPECT_EQ(count(found, Rejection::Outlier), 3);
  EXPECT_EQ(count(found, Rejection::Saturated), 1);
  EXPECT_EQ(count(found, Rejection::Frozen), 19);
  EXPECT_TRUE(std::ranges::is_sorted(found.left_out,
                                     [](const auto& a, const auto& b) { return a.t < b.t; }));
}

/// A gyro that was just switched on sends zeros.
TEST(GyroScreening, LeavesOutZerosAtTheStart) {
  for (const std::size_t zeros : {1U, 2U, 3U, 4U, 7U}) {
    std::vector<GyroSample> samples = noisy(400, 0.1 * kGyro.noise_rad_s);
    for (std::size_t i = 0; i < zeros; ++i) {
      samples[i].rate_body_rad_s.setZero();
    }
    const ScreenedGyro found = screened(samples, kGyro);
    EXPECT_TRUE(found.first_is_outlier);
    EXPECT_GE(found.usable.front().t, samples[zeros].t) << zeros;
  }
}

/// The rate changes by 1 deg/s within one, two or four samples at any time, and back later.
TEST(GyroScreening, KeepsWhatThrustersDo) {
  for (const int samples_on : {1, 2, 4}) {
    for (const int begin : {0, 1, 2, 50}) {
      if (begin == 0 && samples_on == 1) {
        continue;  // A spike looks the same.
      }
      std::vector<GyroSample> samples = noisy(100);
      for (int i = 0; i < 100; ++i) {
        const double up = std::clamp(static_cast<double>(i - begin) / samples_on, 0.0, 1.0);
        const double down = std::clamp((i - 80.0) / samples_on, 0.0, 1.0);
        samples[static_cast<std::size_t>(i)].rate_body_rad_s.y() += 0.0174 * (up - down);
      }
      EXPECT_EQ(count(screened(samples, kGyro), Rejection::Outlier), 0)
          << samples_on << " " << begin;
    }
  }
}

}  // namespace spindrift::gyro_screening_test
