#include "pipelines/three_axis/innovation_record.h"

#include <gtest/gtest.h>

#include <cmath>
#include <numbers>
#include <random>

namespace spindrift::innovation_record_test {

// Of a normal variable beyond five standard deviations, either way.
const double kChance = std::erfc(5.0 / std::numbers::sqrt2);

/// Tails of chi-square in closed form.
TEST(InnovationGate, IsWhatNoiseReachesAsRarelyAsFiveSigmas) {
  const auto tail_of_one = [](double square) { return std::erfc(std::sqrt(0.5 * square)); };
  const auto tail_of_two = [](double square) { return std::exp(-0.5 * square); };
  const auto tail_of_three = [&](double square) {
    return tail_of_one(square) +
           std::sqrt(2.0 * square / std::numbers::pi) * std::exp(-0.5 * square);
  };
  EXPECT_NEAR(innovation_gate(1), 25.0, 1e-3);
  EXPECT_NEAR(tail_of_one(innovation_gate(1)) / kChance, 1.0, 1e-3);
  EXPECT_NEAR(tail_of_two(innovation_gate(2)) / kChance, 1.0, 1e-3);
  EXPECT_NEAR(tail_of_three(innovation_gate(3)) / kChance, 1.0, 1e-3);
}

void reject(InnovationRecord& record, int samples) {
  for (int i = 0; i < samples; ++i) {
    record.rejected();
  }
}

void accept(InnovationRecord& record, int samples, double square = 3.0, int freedom = 3) {
  for (int i = 0; i < samples; ++i) {
    record.accepted(square, freedom);
  }
}

TEST(InnovationRecord, OfNothingSaysNothing) {
  const InnovationRecord record;
  EXPECT_FALSE(record.many_rejected());
  EXPECT_EQ(record.excess_noise(), 1.0);
}

TEST(InnovationRecord, FourSamplesAreNotMany) {
  InnovationRecord record;
  reject(record, 4);
  EXPECT_FALSE(record.many_rejected());
  reject(record, 1);
  EXPECT_TRUE(record.many_rejected());
}

TEST(InnovationRecord, OfWhichNoneFitsIsRejectedAltogether) {
  InnovationRecord record;
  EXPECT_FALSE(record.all_rejected());
  reject(record, 1);
  EXPECT_TRUE(record.all_rejected());
  accept(record, 1);
  reject(record, 100);
  EXPECT_FALSE(record.all_rejected());
}

/// Of the first twenty the plain share.
TEST(InnovationRecord, TwoFifthsOfTheFirstSamplesAreNotYetMany) {
  for (const int rejected : {8, 9}) {
    InnovationRecord record;
    reject(record, rejected);
    accept(record, 20 - rejected);
    EXPECT_EQ(record.many_rejected(), rejected > 8);
  }
}

TEST(InnovationRecord, ASensorThatIsRejectedAltogetherIsSoAtTheTenthSample) {
  InnovationRecord record;
  accept(record, 1000);
  reject(record, 9);
  EXPECT_FALSE(record.many_rejected());
  reject(record, 1);
  EXPECT_TRUE(record.many_rejected());
  accept(record, 1);
  EXPECT_FALSE(record.many_rejected());
}

TEST(InnovationRecord, ASensorOfWhichEveryTenthSampleIsBadIsNot) {
  std::mt19937_64 rng{1};
  std::bernoulli_distribution is_bad{0.1};
  InnovationRecord record;
  accept(record, 5);
  for (int i = 0; i < 20'000; ++i) {
    if (is_bad(rng)) {
      record.rejected();
    } else {
      record.accepted(3.0, 3);
    }
    ASSERT_FALSE(record.many_rejected()) << i;
  }
}

double excess_of(double square_per_freedom, int freedom, int samples) {
  InnovationRecord record;
  accept(record, samples, square_per_freedom * freedom, freedom);
  return record.excess_noise();
}

/// The mean of n squares of unit variance has the standard deviation sqrt(2 / n).
TEST(InnovationRecord, ExcessIsWhatLiesFiveSigmasOut) {
  for (const int freedom : {1, 2, 3}) {
    const double limit = 1.0 + 5.0 * std::sqrt(2.0 / (60.0 * freedom));
    EXPECT_EQ(excess_of(0.99 * limit, freedom, 60), 1.0);
    EXPECT_NEAR(excess_of(1.01 * limit, freedom, 60), 1.01 * limit, 1e-9);
  }
}

TEST(InnovationRecord, ThirtyDegreesOfFreedomAreTheFewestThatSpeakOfNoise) {
  EXPECT_EQ(excess_of(100.0, 3, 9), 1.0);
  EXPECT_NEAR(excess_of(100.0, 3, 10), 100.0, 1e-9);
  EXPECT_EQ(excess_of(100.0, 1, 29), 1.0);
  EXPECT_NEAR(excess_of(100.0, 1, 30), 100.0, 1e-9);
}

TEST(InnovationRecord, MeasuresHowManyTimesTheVarianceIsWhatItShouldBe) {
  std::mt19937_64 rng{2};
  for (const double times : {1.0, 2.0, 9.0}) {
    double mean = 0.0;
    for (int run = 0; run < 50; ++run) {
      InnovationRecord record;
      for (int i = 0; i < 150; ++i) {
        const int freedom = 1 + i % 3;
        record.accepted(times * std::chi_squared_distribution{static_cast<double>(freedom)}(rng),
                        freedom);
      }
      mean += record.excess_noise() / 50.0;
    }
    EXPECT_NEAR(mean, times, times > 1.0 ? 0.05 * times : 1e-12);
  }
}

TEST(InnovationRecord, RejectedSamplesSayNothingOfTheNoise) {
  InnovationRecord record;
  accept(record, 100, 2.0 * 3.0);
  reject(record, 100);
  EXPECT_NEAR(record.excess_noise(), 2.0, 1e-9);
}

TEST(InnovationRecord, ForgetsNoiseThatIsOver) {
  InnovationRecord record;
  accept(record, 1000, 4.0 * 3.0);
  accept(record, 300, 3.0);
  // Nine hundred degrees of freedom on, an e-th of it.
  EXPECT_NEAR(record.excess_noise(), 1.0 + 3.0 / std::numbers::e, 0.01);
  accept(record, 1000, 3.0);
  EXPECT_EQ(record.excess_noise(), 1.0);
}

}  // namespace spindrift::innovation_record_test
