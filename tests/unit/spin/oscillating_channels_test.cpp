#include "pipelines/spin/sequential/oscillating_channels.h"

#include <gtest/gtest.h>

#include <cmath>
#include <functional>
#include <numbers>
#include <random>

namespace spindrift::oscillating_channels_test {

constexpr std::size_t kSun2 = index_of(PulseChannel::Sun2);

/// Of sun2, whose innovation in a revolution is this, beside noise as stated.
double noise_after(int revolutions, const std::function<double(int revolution)>& innovation) {
  std::mt19937_64 rng{7};
  std::normal_distribution<double> normal;
  OscillatingChannels channels;
  for (int i = 0; i < revolutions; ++i) {
    EdgeStatistics tally;
    tally.innovations.at(kSun2) = innovation(i) + normal(rng);
    channels.note(tally);
  }
  return channels.noise().at(kSun2);
}

double swing(double sigmas, double period, int revolution) {
  return sigmas * std::sin(2.0 * std::numbers::pi * revolution / period);
}

TEST(OscillatingChannels, WhatScattersAsStatedIsSteady) {
  EXPECT_EQ(noise_after(200, [](int) { return 0.0; }), 1.0);
}

TEST(OscillatingChannels, OneThatSwingsIsNotWhateverItsPeriod) {
  for (const double period : {2.3, 5.7, 20.0, 35.0}) {
    // The median size of a sine is 0.71 of its amplitude.
    EXPECT_NEAR(noise_after(200, [&](int i) { return swing(12.0, period, i); }),
                std::pow(1.05 * 12.0, 2), 45.0)
        << period;
  }
}

TEST(OscillatingChannels, NorIsMoreNoiseThanStated) {
  std::mt19937_64 rng{8};
  std::normal_distribution<double> normal{0.0, 4.0};
  EXPECT_NEAR(noise_after(200, [&](int) { return normal(rng); }), 17.0, 8.0);
}

TEST(OscillatingChannels, WhatIsElsewhereOrHasMovedStaysOutsideTheGate) {
  constexpr double kOff = 20.0;
  EXPECT_EQ(noise_after(200, [](int) { return kOff; }), 1.0);
  for (int moved = 100; moved < 200; ++moved) {
    const double noise = noise_after(200, [&](int i) { return i < moved ? 0.0 : kOff; });
    EXPECT_LT(SpinFilter::kGateSigmas * std::sqrt(noise), kOff) << moved;
  }
}

TEST(OscillatingChannels, SpuriousEdgesAreNoNoise) {
  EXPECT_EQ(noise_after(200, [](int i) { return i % 4 == 0 ? 1000.0 * (i % 3 - 1) : 0.0; }), 1.0);
}

}  // namespace spindrift::oscillating_channels_test
