#include "pipelines/core/rounding.h"

#include <fmt/format.h>

#include <random>
#include <string>

#include "tests/support/matchers.h"

namespace spindrift::rounding_test {

using One = Eigen::Vector<double, 1>;

/// Returns the value as rounded by a sender with six digits or float32.
double written(double value, const char* format) {
  return std::stod(fmt::format(fmt::runtime(format), value));
}

TEST(Rounding, WhatSixDigitsOrFloat32KeepIsTheSame) {
  std::mt19937_64 rng{43};
  std::normal_distribution<double> normal;
  std::uniform_real_distribution<double> decade{-6.0, 6.0};
  for (int i = 0; i < 20'000; ++i) {
    const double scale = std::pow(10.0, decade(rng));
    const Eigen::Vector3d value{scale * normal(rng), scale * normal(rng), scale * normal(rng)};
    for (const char* format : {"{:.6g}", "{:.9g}", "{:.6f}", "{:.9f}"}) {
      SCOPED_TRACE(fmt::format("{} {} {} as {}", value[0], value[1], value[2], format));
      Eigen::Vector3d sent;
      Eigen::Vector3d sent_as_float;
      for (Eigen::Index k = 0; k < value.size(); ++k) {
        sent[k] = written(value[k], format);
        sent_as_float[k] = static_cast<double>(static_cast<float>(value[k]));
      }
      ASSERT_TRUE(same_but_for_rounding(value, sent));
      ASSERT_TRUE(same_but_for_rounding(sent, value));
      ASSERT_TRUE(same_but_for_rounding(value, sent_as_float));
      ASSERT_TRUE(same_but_for_rounding(sent, sent_as_float));
    }
  }
}

TEST(Rounding, WhatIsRoundedToFourDigitsIsTheSame) {
  EXPECT_TRUE(
      same_but_for_rounding<3>({11454.7023, -13003.3937, 10.3712}, {11455.0, -13003.0, 10.0}));
  EXPECT_TRUE(same_but_for_rounding<3>({0.8372, -0.3058, 0.4535}, {0.837182, -0.305838, 0.453475}));
  EXPECT_TRUE(same_but_for_rounding<3>(
      {0.837182, -0.305838, 0.453475},
      {static_cast<double>(0.8372F), static_cast<double>(-0.3058F), static_cast<double>(0.4535F)}));
  // The differences exceed half a unit (with three digits, of a different unit for each component).
  EXPECT_FALSE(
      same_but_for_rounding<3>({11454.7023, -13003.3937, 10.3712}, {11454.0, -13003.0, 10.0}));
  EXPECT_FALSE(
      same_but_for_rounding<3>({11454.7023, -13003.3937, 10.3712}, {11455.0, -13003.2, 10.0}));
  EXPECT_FALSE(same_but_for_rounding<3>({0.837182, -0.305838, 0.453475}, {0.837, -0.306, 0.453}));
  // Both are on the grid but differ.
  EXPECT_FALSE(same_but_for_rounding<3>({11454.0, -13003.0, 10.0}, {11455.0, -13003.0, 10.0}));
}

TEST(Rounding, ADifferenceOfTwoUnitsOfTheSixthDigitIsNone) {
  EXPECT_TRUE(same_but_for_rounding<3>({0.6, 0.7999991, 0.0}, {0.6, 0.8, 0.0}));
  EXPECT_FALSE(same_but_for_rounding<3>({0.601234, 0.7999993, 0.0}, {0.601234, 0.8000013, 0.0}));
  EXPECT_TRUE(same_but_for_rounding<3>({12345.63, 1.0, 0.0}, {12345.63, 1.09, 0.0}));
  EXPECT_FALSE(same_but_for_rounding<3>({12345.63, 1.0, 0.0}, {12345.63, 1.2, 0.0}));
  EXPECT_FALSE(same_but_for_rounding(One{0.0}, One{1.1e-6}));
  EXPECT_FALSE(same_but_for_rounding(One{1e6}, One{0.0}));
}

}  // namespace spindrift::rounding_test
