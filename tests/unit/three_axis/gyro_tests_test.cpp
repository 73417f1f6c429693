#include "pipelines/three_axis/gyro_tests.h"

#include <array>
#include <cmath>
#include <numbers>
#include <random>
#include <span>
#include <vector>

#include "tests/support/matchers.h"
#include "tests/support/turning_body.h"

namespace spindrift::testing::gyro_tests_test {

using Eigen::Vector3d;

constexpr double kNoise_rad_s = 3e-5;
const Vector3d kNone = Vector3d::Zero();

Vector3d any_vector(std::mt19937_64& rng) { return normal_vector(rng, 0.01); }

/// Holds five samples a second apart; the rate changes by `change` on either side of the middle.
struct Around {
  Vector3d before;
  Vector3d behind;
  Vector3d change;

  GyroDeviation deviation_of(const Vector3d& at, double noise_rad_s) const {
    return deviation(std::array<GyroSample, 5>{{{at_s(0.0), before - change},
                                                {at_s(1.0), before},
                                                {at_s(2.0), at},
                                                {at_s(3.0), behind},
                                                {at_s(4.0), behind + change}}},
                     2, noise_rad_s);
  }
  bool stands_out(const Vector3d& at, double noise_rad_s = 0.0) const {
    return deviation_of(at, noise_rad_s).stands_out();
  }
};

/// The change is the slope there times the interval; the intervals are 2, 0.5, 0.5 and 0.1 s.
TEST(StandsOut, BeyondTheLesserOfTheChangesOnBothSides) {
  const Vector3d rate{0.01, 0.02, 0.03};
  const Vector3d up{0.0, 0.004, 0.0};
  const std::vector<GyroSample> samples{{at_s(0.0), rate - up},
                                        {at_s(2.0), rate},
                                        {at_s(2.5), rate + Vector3d{0.0, 0.01, 0.0}},
                                        {at_s(3.0), rate},
                                        {at_s(3.1), rate - 0.05 * up}};
  const auto off_rad_s = [](std::span<const GyroSample> some, std::size_t i) {
    return deviation(some, i, 0.0).off_rad_s;
  };
  EXPECT_NEAR(off_rad_s(samples, 2), 0.01 - 0.001, 1e-12);
  EXPECT_NEAR(off_rad_s(std::span{samples}.first(4), 2), 0.01 - 0.001, 1e-12);
  std::vector<GyroSample> steep = samples;
  steep[0].rate_body_rad_s = rate - 2.0 * up;
  EXPECT_NEAR(off_rad_s(steep, 2), 0.01 - 0.001, 1e-12);
  EXPECT_NEAR(off_rad_s(std::span{steep}.first(4), 2), 0.01 - 0.002, 1e-12);
  EXPECT_NEAR(off_rad_s(std::span{steep}.subspan(1), 1), 0.01 - 0.001, 1e-12);
}

TEST(StandsOut, NothingBetweenItsNeighboursDoes) {
  std::mt19937_64 rng{1};
  for (int i = 0; i < 1000; ++i) {
    const Vector3d before = any_vector(rng);
    const Vector3d behind = any_vector(rng);
    const double share = std::uniform_real_distribution{0.0, 1.0}(rng);
    EXPECT_FALSE((Around{before, behind, kNone}.stands_out(before + share * (behind - before))));
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
      EXPECT_FALSE((Around{before, behind, change}.stands_out(at)));
      at[axis] = farther + sign * 1.001 * change[axis];
      EXPECT_TRUE((Around{before, behind, change}.stands_out(at)));
      // Reversing time and rates must not change the result.
      EXPECT_TRUE((Around{behind, before, change}.stands_out(at)));
      EXPECT_TRUE((Around{-before, -behind, change}.stands_out(-at)));
    }
  }
}

/// The difference of two samples has sqrt(2) times the noise of one.
TEST(StandsOut, NoiseOfTwoSamplesIsNotEnough) {
  const double limit = 5.0 * std::numbers::sqrt2 * kNoise_rad_s;
  const Around still{kNone, kNone, kNone};
  EXPECT_FALSE(still.stands_out(0.999 * limit * Vector3d::UnitY(), kNoise_rad_s));
  EXPECT_TRUE(still.stands_out(1.001 * limit * Vector3d::UnitY(), kNoise_rad_s));
  std::mt19937_64 rng{2};
  for (int i = 0; i < 20'000; ++i) {
    const Vector3d before = normal_vector(rng, kNoise_rad_s);
    const Vector3d at = normal_vector(rng, kNoise_rad_s);
    const Vector3d behind = normal_vector(rng, kNoise_rad_s);
    ASSERT_FALSE((Around{before, behind, kNone}.stands_out(at, kNoise_rad_s)));
  }
}

/// Holds samples on a line, the first at 0 s.
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
  // A change against the trend of the next samples is a spike.
  EXPECT_TRUE(
      deviation_at_end({at_s(0.0), rate + Vector3d{0.001, 0.0, 0.0}}, next, next_but_one, 1e-12)
          .stands_out());
}

/// The noise is that of the deviation of three independent samples from a line.
TEST(EndStandsOut, NoiseIsThatOfAllThree) {
  std::mt19937_64 rng{4};
  for (const double next_but_one_s : {0.2, 0.3, 1.1}) {
    const double next_s = 0.1;
    // The deviation is at - (1 + k) next + k next_but_one, where k removes a line.
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

}  // namespace spindrift::testing::gyro_tests_test
