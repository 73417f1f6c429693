#include <cmath>
#include <utility>

#include "pipelines/frames/angle.h"
#include "pipelines/spin/mean/model_check.h"
#include "tests/support/matchers.h"

namespace spindrift::model_evidence_test {

// Noise alone exceeds this once in ten thousand times for a single number.
constexpr double kSeenFrom_sigmas = 3.8906;
constexpr double kOff_rad = 1.5 * kRadPerDeg;

/// Returns the evidence of 600 edges that together put the azimuth of the north beam off by
/// `kOff_rad`, at this many standard deviations.
ModelEvidence of_errors(double sigmas) {
  ErrorInformation errors;
  errors.information(NorthAzimuth, NorthAzimuth) = sigmas * sigmas / (kOff_rad * kOff_rad);
  errors.score[NorthAzimuth] = kOff_rad * errors.information(NorthAzimuth, NorthAzimuth);
  ModelEvidence evidence;
  evidence.add(errors, 600.0);
  return evidence;
}

ModelTest test(const ModelEvidence& evidence, double excess_noise = 1.0) {
  return evidence.test(excess_noise, ConsideredPrior::Zero());
}

TEST(ModelEvidence, OfNothingSaysNothing) {
  EXPECT_EQ(test({}).error_rad, 0.0);
  EXPECT_FALSE(test({}).beyond_allowance);
}

TEST(ModelEvidence, SeesAnErrorOfTheModelFromWhereNoiseDoesNotReach) {
  EXPECT_EQ(test(of_errors(0.99 * kSeenFrom_sigmas)).error_rad, 0.0);
  EXPECT_GT(test(of_errors(1.01 * kSeenFrom_sigmas)).error_rad, 0.0);
  const ModelTest beyond_doubt = test(of_errors(40.0));
  EXPECT_NEAR(std::sqrt(beyond_doubt.errors_rad2(NorthAzimuth, NorthAzimuth)), kOff_rad,
              0.05 * kOff_rad);
  EXPECT_TRUE(beyond_doubt.beyond_allowance);
}

TEST(ModelEvidence, WhereTheNoiseIsMoreAnErrorMustBeMore) {
  EXPECT_GT(test(of_errors(1.2 * kSeenFrom_sigmas)).error_rad, 0.0);
  EXPECT_EQ(test(of_errors(1.2 * kSeenFrom_sigmas), 2.0).error_rad, 0.0);
}

TEST(ModelEvidence, AfterFadingErrorsAreWhatAHundredEdgesSay) {
  // A sixth of 600 edges has 1 / sqrt(6) of the significance.
  for (const auto& [sigmas, seen] : {std::pair{2.4, false}, std::pair{2.5, true}}) {
    ModelEvidence evidence = of_errors(sigmas * kSeenFrom_sigmas);
    EXPECT_GT(test(evidence).error_rad, 0.0);
    evidence.fade();
    EXPECT_EQ(test(evidence).error_rad > 0.0, seen);
    evidence.fade();  // All of the remaining hundred are kept.
    EXPECT_EQ(test(evidence).error_rad > 0.0, seen);
  }
}

}  // namespace spindrift::model_evidence_test
