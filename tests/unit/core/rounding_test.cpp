#include "pipelines/core/rounding.h"

#include <fmt/format.h>
#include <gtest/gtest.h>

#include <random>
#include <string>

namespace spindrift::rounding_test {

using Three = std::array<double, 3>;

/// As a sender writes it that has six digits, or float32.
double written(double value, const char* format) {
  return std::stod(fmt::format(fmt::runtime(format), value));
}

TEST(Rounding, WhatSixDigitsOrFloat32KeepIsTheSame) {
  std::mt19937_64 rng{43};
  std::normal_distribution<double> normal;
  std::uniform_real_distribution<double> decade{-6.0, 6.0};
  for (int i = 0; i < 20'000; ++i) {
    const double scale = std::pow(10.0, decade(rng));
    const Three value{scale * normal(rng), scale * normal(rng), scale * normal(rng)};
    for (const char* format : {"{:.6g}", "{:.9g}", "{:.6f}", "{:.9f}"}) {
      SCOPED_TRACE(fmt::format("{} {} {} as {}", value[0], value[1], value[2], format));
      Three sent{};
      Three sent_as_float{};
      for (std::size_t k = 0; k < value.size(); ++k) {
        sent.at(k) = written(value.at(k), format);
        sent_as_float.at(k) = static_cast<double>(static_cast<float>(value.at(k)));
      }
      ASSERT_TRUE(same_but_for_rounding(value, sent));
      ASSERT_TRUE(same_but_for_rounding(sent, value));
      ASSERT_TRUE(same_but_for_rounding(value, sent_as_float));
      ASSERT_TRUE(same_but_for_rounding(sent, sent_as_float));
    }
  }
}

TEST(Rounding, ADifferenceOfTwoUnitsOfTheSixthDigitIsNone) {
  EXPECT_TRUE(same_but_for_rounding<3>({0.6, 0.8, 0.0}, {0.6, 0.8 + 9e-7, 0.0}));
  EXPECT_FALSE(same_but_for_rounding<3>({0.6, 0.8, 0.0}, {0.6, 0.8 + 2e-6, 0.0}));
  EXPECT_TRUE(same_but_for_rounding<3>({12345.6, 1.0, 0.0}, {12345.6, 1.09, 0.0}));
  EXPECT_FALSE(same_but_for_rounding<3>({12345.6, 1.0, 0.0}, {12345.6, 1.2, 0.0}));
  EXPECT_FALSE(same_but_for_rounding<1>({0.0}, {1.1e-6}));
  EXPECT_FALSE(same_but_for_rounding<1>({1e6}, {0.0}));
}

}  // namespace spindrift::rounding_test
