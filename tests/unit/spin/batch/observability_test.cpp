#include "pipelines/spin/batch/observability.h"

#include <cmath>

#include "tests/support/matchers.h"

namespace spindrift::observability_test {

/// Returns the information of edges that know the motion well and know the sum and the difference
/// of the north chord's and north mounting angle's biases this well, in units of the priors.
PassInformation of_north(double sum, double difference) {
  PassInformation pass;
  pass.information.diagonal().head<kMotionUnknowns>().setConstant(1e8);
  const double chord = range_sigmas()[NorthChordBias];
  const double mount = range_sigmas()[NorthMountAngleBias];
  const int c = kMotionUnknowns + NorthChordBias;
  const int m = kMotionUnknowns + NorthMountAngleBias;
  pass.information(c, c) = 0.5 * (sum + difference) / (chord * chord);
  pass.information(m, m) = 0.5 * (sum + difference) / (mount * mount);
  pass.information(c, m) = pass.information(m, c) = 0.5 * (sum - difference) / (chord * mount);
  return pass;
}

const BiasSet kNorth = BiasSet{}.set(NorthChordBias).set(NorthMountAngleBias);

TEST(Observability, WhatTheEdgesDetermineIsObservable) {
  const Observability observed{of_north(1e4, 1e4), kNorth};
  SensorBiases biases = SensorBiases::Zero();
  biases[NorthChordBias] = 0.01;
  const auto estimates = observed.biases(biases);
  ASSERT_EQ(estimates.size(), 2U);
  EXPECT_EQ(estimates[0].bias, NorthChordBias);
  EXPECT_TRUE(estimates[0].observable);
  EXPECT_EQ(estimates[0].value, 0.01);
  // The expected sigma is a hundredth of the prior's.
  EXPECT_NEAR(estimates[0].sigma / range_sigmas()[NorthChordBias], 0.01, 1e-6);
  EXPECT_THAT(observed.undetermined(), IsEmpty());
}

TEST(Observability, ADirectionThatIsLeftOpenIsNamedAndHeldAtItsPrior) {
  const Observability observed{of_north(1e4, 0.01), kNorth};
  EXPECT_THAT(observed.undetermined(), ElementsAre(kNorth));
  SensorBiases biases = SensorBiases::Zero();
  biases[NorthChordBias] = 0.01;
  for (const BiasEstimate& estimate : observed.biases(biases)) {
    EXPECT_FALSE(estimate.observable);
    EXPECT_EQ(estimate.value, 0.0);
    EXPECT_EQ(estimate.sigma, range_sigmas()[estimate.bias]);
  }
}

TEST(Observability, ABiasThatNoEdgeDependsOnIsNotDetermined) {
  const PassInformation pass = of_north(1e4, 1e4);
  EXPECT_EQ(seen_biases(pass), kNorth);
  const Observability observed{pass, BiasSet{}.set(Co2HeightBias)};
  EXPECT_THAT(observed.undetermined(), ElementsAre(BiasSet{}.set(Co2HeightBias)));
}

TEST(Observability, ConingIsOneBiasInEveryDirectionOfIt) {
  const BiasSet coning = unknowns_of(ConingX);
  const Observability observed{of_north(1e4, 1e4), coning};
  EXPECT_THAT(observed.undetermined(), ElementsAre(coning));
}

TEST(Observability, SingularValuesAreOfTheUnknownsOnlyLargestFirst) {
  const auto values = Observability{of_north(1e4, 4.0), kNorth}.singular_values();
  ASSERT_EQ(values.size(), 7U);
  EXPECT_NEAR(values[0], 1e4, 1e-6);
  EXPECT_NEAR(values[5], 100.0, 1e-9);
  EXPECT_NEAR(values[6], 2.0, 1e-9);
}

TEST(Observability, AMotionThatIsLeftOpenHasALargeSigma) {
  PassInformation nothing;
  const Observability observed{nothing, {}};
  EXPECT_NEAR(observed.axis_covariance_rad2().trace(), 2.0, 1e-12);
  EXPECT_THAT(observed.undetermined(), IsEmpty());
}

TEST(Observability, AConsideredParameterMovesTheUnknownsByTheirGain) {
  // A chord bias is mixed with the first tilt; an azimuth pulls the tilt.
  PassInformation pass;
  pass.information.diagonal().head<kMotionUnknowns>().setConstant(1e8);
  const double prior = range_sigmas()[NorthChordBias];
  const int c = kMotionUnknowns + NorthChordBias;
  pass.information(c, c) = 1e8;
  pass.information(0, c) = pass.information(c, 0) = 0.9e8;
  constexpr int kAzimuth = kChannelOffsets + NorthAzimuthError;
  pass.considered.shared(0, kAzimuth) = 2e8;
  const double tilt = 1e8 + 1.0;
  const double chord = 1e8 + 1.0 / (prior * prior);
  const double determinant = tilt * chord - 0.81e16;
  ConsideredPrior known = ConsideredPrior::Zero();
  known(kAzimuth, kAzimuth) = 1e-6;
  const Observability observed{pass, BiasSet{}.set(NorthChordBias)};
  const Observability::Matrix added = observed.considered(pass, known);
  EXPECT_NEAR(std::sqrt(added(0, 0)), 1e-3 * 2e8 * chord / determinant, 1e-12);
  EXPECT_NEAR(std::sqrt(added(c, c)), 1e-3 * 2e8 * 0.9e8 / determinant, 1e-12);
  EXPECT_EQ(added(1, 1), 0.0);
  // A bias that is known does not move, and takes up nothing.
  const Observability alone{pass, {}};
  const Observability::Matrix of_axis = alone.considered(pass, known);
  EXPECT_NEAR(std::sqrt(of_axis(0, 0)), 1e-3 * 2e8 / tilt, 1e-12);
  EXPECT_EQ(of_axis(c, c), 0.0);
}

}  // namespace spindrift::observability_test
