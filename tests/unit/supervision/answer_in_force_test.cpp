#include "pipelines/supervision/answer_in_force.h"

#include <optional>
#include <random>
#include <vector>

#include "pipelines/frames/angle.h"
#include "pipelines/frames/celestial.h"
#include "pipelines/statistics/significance.h"
#include "tests/support/matchers.h"

namespace spindrift::answer_in_force_test {

using enum Quality;
using enum SpinEstimator;

TaiTime at(double t_s) { return shifted(tai_from_ns(1'795'143'637'000'000'000), t_s); }

SpinEstimate estimate(SpinEstimator estimator, double t_s, Quality quality, double sigma_deg,
                      double off_deg = 0.0) {
  const double sigma_rad = sigma_deg * kRadPerDeg;
  return {.t = at(t_s),
          .estimator = estimator,
          .axis_icrf = Eigen::AngleAxisd{off_deg * kRadPerDeg, Eigen::Vector3d::UnitX()} *
                       Eigen::Vector3d::UnitZ(),
          .covariance_rad2 = 0.5 * sigma_rad * sigma_rad * Eigen::Matrix2d::Identity(),
          .spin_rate_rad_s = 6.0,
          .spin_rate_sigma_rad_s = 1e-5,
          .assessment = {.quality = quality}};
}

/// Returns the answer in force after the estimates have come in this order.
std::optional<SpinAnswer> after(const std::vector<SpinEstimate>& estimates,
                                std::optional<double> manoeuvre_s = {}) {
  SpinAnswers answers{kContradictionSigmas};
  if (manoeuvre_s) {
    answers.note_manoeuvre(at(*manoeuvre_s));
  }
  for (const SpinEstimate& one : estimates) {
    answers.take(one);
  }
  return answers.in_force();
}

void expect(const std::optional<SpinAnswer>& answer, SpinEstimator estimator, Quality quality) {
  ASSERT_TRUE(answer);
  EXPECT_EQ(name_of(answer->estimate.estimator), name_of(estimator));
  EXPECT_EQ(name_of(answer->quality), name_of(quality));
}

TEST(AnswerInForce, IsNoneBeforeTheFirstEstimate) { EXPECT_FALSE(after({})); }

TEST(AnswerInForce, IsTheOkOneWithTheSmallestSigma) {
  expect(after({estimate(Mean, 600.0, Ok, 0.05), estimate(Sequential, 600.0, Ok, 0.02),
                estimate(Batch, 600.0, Ok, 0.03)}),
         Sequential, Ok);
  expect(after({estimate(Mean, 600.0, Ok, 0.05), estimate(Sequential, 600.0, Ok, 0.02),
                estimate(Batch, 600.0, Ok, 0.01)}),
         Batch, Ok);
}

TEST(AnswerInForce, IsTheOneThatIsOkWhereOthersAreNot) {
  // Of a nutating body `sequential` is DOUBTFUL, while `batch` knows the nutation.
  expect(after({estimate(Sequential, 600.0, Doubtful, 0.01), estimate(Batch, 599.0, Ok, 0.02)}),
         Batch, Ok);
  // A batch of few edges after a manoeuvre.
  for (const Quality quality : {Converging, Ambiguous, Doubtful}) {
    expect(
        after({estimate(Sequential, 600.0, Ok, 0.1), estimate(Batch, 600.5, quality, 0.02, 3.0)}),
        Sequential, Ok);
  }
}

TEST(AnswerInForce, IsDoubtfulWhereOkOnesContradictEachOther) {
  const auto apart = [](double sigmas) {
    return after({estimate(Mean, 600.0, Ok, 0.1, 0.1 * sigmas),
                  estimate(Sequential, 600.0, Doubtful, 0.01, 9.0),
                  estimate(Batch, 600.0, Ok, 0.05)});
  };
  expect(apart(4.9), Batch, Ok);
  expect(apart(5.1), Batch, Doubtful);
  ASSERT_EQ(apart(5.1)->contradictions.size(), 1U);
  const AxesApart pair = apart(5.1)->contradictions.front();
  EXPECT_EQ(pair.one, Mean);
  EXPECT_EQ(pair.other, Batch);
  EXPECT_NEAR(pair.sigmas, 5.1, 1e-6);
  EXPECT_NEAR(pair.apart_rad, 0.51 * kRadPerDeg, 1e-9);
}

TEST(AnswerInForce, IsNoOlderOneThatANewerOneContradicts) {
  // The body was turned after the solution by batch.
  expect(after({estimate(Batch, 560.0, Ok, 0.01, 3.0), estimate(Sequential, 600.0, Ok, 0.1)}),
         Sequential, Doubtful);
  expect(after({estimate(Batch, 560.0, Ok, 0.01), estimate(Sequential, 600.0, Ok, 0.1)}), Batch,
         Ok);
}

TEST(AnswerInForce, IsNoneOfLongAgo) {
  const SpinEstimate mean = estimate(Mean, 479.0, Ok, 0.01, 3.0);
  expect(after({mean, estimate(Sequential, 598.0, Ambiguous, 0.1)}), Mean, Ok);
  const auto answer = after({mean, estimate(Sequential, 600.0, Ambiguous, 0.1)});
  expect(answer, Sequential, Ambiguous);
  EXPECT_EQ(answer->t, at(600.0));
  expect(after({mean, estimate(Sequential, 600.0, Ok, 0.1)}), Sequential, Ok);
}

TEST(AnswerInForce, IsOfTheMostEdgesWhereNoneIsOk) {
  expect(
      after({estimate(Mean, 600.0, Converging, 0.01), estimate(Sequential, 600.0, Doubtful, 0.1)}),
      Sequential, Doubtful);
  expect(after({estimate(Sequential, 600.0, Converging, 0.01), estimate(Batch, 590.0, Lost, 0.1)}),
         Batch, Lost);
}

TEST(AnswerInForce, IsNoneOfBeforeAManoeuvreOnceAnotherCameAfterIt) {
  const SpinEstimate before = estimate(Batch, 560.0, Ok, 0.01, 3.0);
  expect(after({before}, 580.0), Batch, Ok);
  expect(after({before, estimate(Sequential, 579.0, Converging, 0.1)}, 580.0), Batch, Ok);
  expect(after({before, estimate(Sequential, 600.0, Converging, 0.1)}, 580.0), Sequential,
         Converging);
  expect(after({before, estimate(Sequential, 600.0, Converging, 0.1), before}, 580.0), Sequential,
         Converging);
}

TEST(AnswerInForce, IsNoneOfBeforeAnEstimatorWasLost) {
  const SpinEstimate mean = estimate(Mean, 599.0, Ok, 0.1);
  const SpinEstimate lost = estimate(Sequential, 614.0, Lost, 90.0);
  expect(after({mean, lost}), Sequential, Lost);
  const SpinEstimate again = estimate(Sequential, 658.0, Doubtful, 2.0, 9.0);
  expect(after({mean, lost, again}), Sequential, Doubtful);
  expect(after({mean, lost, again, estimate(Batch, 590.0, Ok, 0.1)}), Sequential, Doubtful);
  expect(after({mean, lost, again, estimate(Batch, 659.0, Ok, 0.1, 9.0)}), Batch, Ok);
}

TEST(AnswerInForce, IsAtBestDoubtfulOnceComputingFailed) {
  SpinAnswers answers{kContradictionSigmas};
  answers.take(estimate(Sequential, 600.0, Ok, 0.1));
  answers.note_fault();
  expect(answers.in_force(), Sequential, Doubtful);
  answers.take(estimate(Sequential, 601.0, Lost, 0.1));
  expect(answers.in_force(), Sequential, Lost);
}

/// Returns a random last estimate of each of some estimators.
LastEstimates random_estimates(std::mt19937_64& rng) {
  std::uniform_real_distribution<double> uniform{0.0, 1.0};
  LastEstimates last;
  for (const SpinEstimator estimator : {Mean, Sequential, Batch}) {
    if (uniform(rng) < 0.8) {
      const auto quality = static_cast<Quality>(static_cast<int>(uniform(rng) * kQualities));
      last.emplace(estimator,
                   estimate(estimator, 200.0 * uniform(rng), uniform(rng) < 0.6 ? Ok : quality,
                            0.1 + uniform(rng), uniform(rng) < 0.5 ? 0.0 : 10.0 * uniform(rng)));
    }
  }
  return last;
}

/// The rules as sentences, over random estimates.
TEST(AnswerInForce, KeepsItsRulesOverRandomEstimates) {
  std::mt19937_64 rng{4701};
  for (int trial = 0; trial < 20'000; ++trial) {
    const LastEstimates last = random_estimates(rng);
    const auto answer = answer_in_force(last, kContradictionSigmas);
    ASSERT_EQ(answer.has_value(), !last.empty());
    if (!answer) {
      continue;
    }
    const SpinEstimate& chosen = answer->estimate;
    EXPECT_GE(answer->quality, chosen.assessment.quality);
    EXPECT_LE(seconds_between(chosen.t, answer->t), 120.0);
    for (const auto& [estimator, other] : last) {
      const double apart_rad = angle_between_rad(chosen.axis_icrf, other.axis_icrf);
      const bool is_of_now = seconds_between(other.t, answer->t) <= 120.0;
      if (!is_of_now || other.assessment.quality != Ok || estimator == chosen.estimator) {
        continue;
      }
      EXPECT_EQ(chosen.assessment.quality, Ok) << "one that is OK is there";
      if (apart_rad >= kContradictionSigmas * difference_sigma_rad(chosen, other)) {
        EXPECT_GE(chosen.t, other.t) << "a newer one is displaced";
        EXPECT_EQ(answer->quality, Doubtful);
      }
    }
  }
}

}  // namespace spindrift::answer_in_force_test
