#include "pipelines/observation/oscillation.h"

#include <cmath>
#include <functional>
#include <numbers>
#include <random>

#include "tests/support/matchers.h"

namespace spindrift::oscillation_test {

/// Returns the noise factor after residuals of `innovation` plus the stated noise.
double noise_after(int revolutions, const std::function<double(int revolution)>& innovation) {
  std::mt19937_64 rng{7};
  std::normal_distribution<double> normal;
  Oscillation oscillation;
  for (int i = 0; i < revolutions; ++i) {
    oscillation.add(innovation(i) + normal(rng));
  }
  return oscillation.noise();
}

double swing(double sigmas, double period, int revolution) {
  return sigmas * std::sin(2.0 * std::numbers::pi * revolution / period);
}

TEST(Oscillation, WhatScattersAsStatedIsSteady) {
  EXPECT_EQ(noise_after(200, [](int) { return 0.0; }), 1.0);
}

TEST(Oscillation, OneThatSwingsIsNotWhateverItsPeriod) {
  for (const double period : {2.3, 5.7, 20.0, 35.0}) {
    // The median magnitude of a sine is 0.71 of its amplitude.
    EXPECT_NEAR(noise_after(200, [&](int i) { return swing(12.0, period, i); }),
                std::pow(1.05 * 12.0, 2), 45.0)
        << period;
  }
}

TEST(Oscillation, NorIsMoreNoiseThanStated) {
  std::mt19937_64 rng{8};
  std::normal_distribution<double> normal{0.0, 4.0};
  EXPECT_NEAR(noise_after(200, [&](int) { return normal(rng); }), 17.0, 8.0);
}

TEST(Oscillation, WhatIsElsewhereOrHasMovedStaysOutsideTheGate) {
  constexpr double kOff = 20.0;
  EXPECT_EQ(noise_after(200, [](int) { return kOff; }), 1.0);
  for (int moved = 100; moved < 200; ++moved) {
    const double noise = noise_after(200, [&](int i) { return i < moved ? 0.0 : kOff; });
    EXPECT_LT(4.1 * std::sqrt(noise), kOff) << moved;
  }
}

TEST(Oscillation, SpuriousEdgesAreNoNoise) {
  EXPECT_EQ(noise_after(200, [](int i) { return i % 4 == 0 ? 1000.0 * (i % 3 - 1) : 0.0; }), 1.0);
}

}  // namespace spindrift::oscillation_test
