#include "pipelines/observation/observation_record.h"

#include <cmath>
#include <numbers>
#include <random>
#include <vector>

#include "pipelines/observation/innovation_gate.h"
#include "tests/support/matchers.h"

namespace spindrift::observation_record_test {

// Two-sided probability of five standard deviations.
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

/// The rules of three-axis samples.
constexpr RecordRules kRules{
    .recent = 20.0, .fewest_freedoms = 30.0, .most_freedoms = 900.0, .noise_from_share = 1.0};
/// The rules of edges.
constexpr RecordRules kOfEdges{
    .recent = 60.0, .fewest_freedoms = 15.0, .most_freedoms = 300.0, .noise_from_share = 0.2};
constexpr double kGate = 4.1 * 4.1;

Observation used(double square, int freedom) {
  return {.source = SampleSource::Star,
          .residual = {.freedom = freedom},
          .nis = square,
          .limit = innovation_gate(freedom)};
}

Observation left_out(double limit, int freedom) {
  return {.source = SampleSource::Star,
          .residual = {.freedom = freedom},
          .nis = 1e6,
          .limit = limit,
          .rejected_by = Rejection::Innovation};
}

void add(ObservationRecord& record, const Observation& observation) {
  record.add({&observation, 1});
}

void reject(ObservationRecord& record, int samples) {
  for (int i = 0; i < samples; ++i) {
    add(record, left_out(innovation_gate(3), 3));
  }
}

void accept(ObservationRecord& record, int samples, double square = 3.0, int freedom = 3) {
  for (int i = 0; i < samples; ++i) {
    add(record, used(square, freedom));
  }
}

bool many_left_out(const ObservationRecord& record) { return record.share_left_out() > 0.4; }

/// Adds turns of six edges of which `gated` are left out.
void add_turns(ObservationRecord& record, int turns, double square, std::size_t gated = 0) {
  std::vector<Observation> turn(gated, left_out(kGate, 1));
  turn.resize(6, used(square, 1));
  for (int i = 0; i < turns; ++i) {
    record.add(turn);
  }
}

TEST(ObservationRecord, OfNothingSaysNothing) {
  const ObservationRecord record{kRules};
  EXPECT_FALSE(many_left_out(record));
  EXPECT_EQ(record.excess_noise(), 1.0);
}

TEST(ObservationRecord, OfWhichNoneFitsIsRejectedAltogether) {
  ObservationRecord record{kRules};
  reject(record, 1);
  EXPECT_EQ(record.share_left_out(), 1.0);
  reject(record, 50);
  EXPECT_EQ(record.share_left_out(), 1.0);
  accept(record, 1);
  reject(record, 100);
  EXPECT_LT(record.share_left_out(), 1.0);
}

/// The first twenty samples have equal weights.
TEST(ObservationRecord, TwoFifthsOfTheFirstSamplesAreNotYetMany) {
  for (const int rejected : {8, 9}) {
    ObservationRecord record{kRules};
    reject(record, rejected);
    accept(record, 20 - rejected);
    EXPECT_EQ(many_left_out(record), rejected > 8);
  }
}

TEST(ObservationRecord, ASensorThatIsRejectedAltogetherIsSoAtTheTenthSample) {
  ObservationRecord record{kRules};
  accept(record, 1000);
  reject(record, 9);
  EXPECT_FALSE(many_left_out(record));
  reject(record, 1);
  EXPECT_TRUE(many_left_out(record));
  accept(record, 1);
  EXPECT_FALSE(many_left_out(record));
}

TEST(ObservationRecord, ASensorOfWhichEveryTenthSampleIsBadIsNot) {
  std::mt19937_64 rng{1};
  std::bernoulli_distribution is_bad{0.1};
  ObservationRecord record{kRules};
  accept(record, 5);
  for (int i = 0; i < 20'000; ++i) {
    if (is_bad(rng)) {
      reject(record, 1);
    } else {
      accept(record, 1);
    }
    ASSERT_FALSE(many_left_out(record)) << i;
  }
}

double excess_of(double square_per_freedom, int freedom, int samples) {
  ObservationRecord record{kRules};
  accept(record, samples, square_per_freedom * freedom, freedom);
  return record.excess_noise();
}

/// The mean of n squares of unit variance has the standard deviation sqrt(2 / n).
TEST(ObservationRecord, ExcessIsWhatLiesFiveSigmasOut) {
  for (const int freedom : {1, 2, 3}) {
    const double limit = 1.0 + 5.0 * std::sqrt(2.0 / (60.0 * freedom));
    EXPECT_EQ(excess_of(0.99 * limit, freedom, 60), 1.0);
    EXPECT_NEAR(excess_of(1.01 * limit, freedom, 60), 1.01 * limit, 1e-9);
  }
}

TEST(ObservationRecord, ThirtyDegreesOfFreedomAreTheFewestThatSpeakOfNoise) {
  EXPECT_EQ(excess_of(100.0, 3, 9), 1.0);
  EXPECT_NEAR(excess_of(100.0, 3, 10), 100.0, 1e-9);
  EXPECT_EQ(excess_of(100.0, 1, 29), 1.0);
  EXPECT_NEAR(excess_of(100.0, 1, 30), 100.0, 1e-9);
}

TEST(ObservationRecord, MeasuresHowManyTimesTheVarianceIsWhatItShouldBe) {
  std::mt19937_64 rng{2};
  for (const double times : {1.0, 2.0, 9.0}) {
    double mean = 0.0;
    for (int run = 0; run < 50; ++run) {
      ObservationRecord record{kRules};
      for (int i = 0; i < 150; ++i) {
        const int freedom = 1 + i % 3;
        accept(record, 1, times * std::chi_squared_distribution{static_cast<double>(freedom)}(rng),
               freedom);
      }
      mean += record.excess_noise() / 50.0;
    }
    EXPECT_NEAR(mean, times, times > 1.0 ? 0.05 * times : 1e-12);
  }
}

TEST(ObservationRecord, RejectedSamplesSayNothingOfTheNoise) {
  ObservationRecord record{kRules};
  accept(record, 100, 2.0 * 3.0);
  reject(record, 100);
  EXPECT_NEAR(record.excess_noise(), 2.0, 1e-9);
}

TEST(ObservationRecord, ForgetsNoiseThatIsOver) {
  ObservationRecord record{kRules};
  accept(record, 1000, 4.0 * 3.0);
  accept(record, 300, 3.0);
  // After another nine hundred degrees of freedom the excess has decayed by 1/e.
  EXPECT_NEAR(record.excess_noise(), 1.0 + 3.0 / std::numbers::e, 0.01);
  accept(record, 1000, 3.0);
  EXPECT_EQ(record.excess_noise(), 1.0);
}

TEST(ObservationRecord, AFewOfTheEdgesLeftOutAreSpuriousAndManyAreNoise) {
  const auto excess_with = [](std::size_t gated, double square) {
    ObservationRecord record{kOfEdges};
    add_turns(record, 300, square, gated);
    return record.excess_noise();
  };
  EXPECT_EQ(excess_with(1, 1.0), 1.0);
  const double mean_square = (4.0 * 4.0 + 2.0 * kGate) / 6.0;
  EXPECT_NEAR(excess_with(2, 4.0), mean_square, 0.01 * mean_square);
  EXPECT_GT(excess_with(4, 1.0), excess_with(2, 1.0));
}

TEST(ObservationRecord, BegunAnewThePastSpeaksLikeTheFewest) {
  ObservationRecord record{kOfEdges};
  add_turns(record, 100, 2.0, 1);
  record.restart();
  EXPECT_EQ(record.left_out(), 0);
  EXPECT_EQ(record.share_left_out(), 0.0);
  EXPECT_EQ(record.excess_noise(), 1.0);
  add_turns(record, 5, 2.0);
  EXPECT_EQ(record.excess_noise(), 1.0);
  add_turns(record, 10, 4.0);
  // The record has 45 edges with a square of 2 and 60 with a square of 4.
  EXPECT_NEAR(record.excess_noise(), (45.0 * 2.0 + 60.0 * 4.0) / 105.0, 1e-9);
}

TEST(ObservationRecord, OfATransientLittleIsLeftThatGoodEdgesSoonOverrule) {
  ObservationRecord record{kOfEdges};
  add_turns(record, 100, 50.0);
  record.discard_transient(4.0);
  EXPECT_NEAR(record.excess_noise(), 4.0, 1e-9);
  add_turns(record, 5, 1.0);
  EXPECT_EQ(record.excess_noise(), 1.0);
  ObservationRecord less{kOfEdges};
  add_turns(less, 100, 3.0);
  less.discard_transient(4.0);
  EXPECT_NEAR(less.excess_noise(), 3.0, 1e-9);
}

}  // namespace spindrift::observation_record_test
