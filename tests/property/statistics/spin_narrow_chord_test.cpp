/// Beams near the Earth's limb have chords of a few degrees, which vanish for an axis 0.2 deg away,
/// while single fixes are degrees off. `sequential` and `batch` must find the axis, and no row of
/// `sequential` may be OK and wrong. The same holds near the longest chord, where axes on either
/// side of the middle see the same.

#include <gtest/gtest.h>

#include <algorithm>
#include <cstdint>
#include <numbers>
#include <random>
#include <string>
#include <utility>
#include <vector>

#include "pipelines/ephemeris/kepler_orbit.h"
#include "pipelines/frames/angle.h"
#include "pipelines/frames/celestial.h"
#include "pipelines/spin/pass/spin_pass.h"
#include "services/base/assessment_words.h"
#include "tests/support/observed_spin.h"
#include "tests/support/product_text.h"
#include "tests/support/solved_pass.h"

namespace spindrift::testing::spin_narrow_chord_test {

constexpr double kPi = std::numbers::pi;
constexpr double kSigmas = 5.0;

/// Returns an orbit near apogee, 42,000 km from the Earth's centre, where the Earth's half-angle is
/// 8.8 deg.
Orbit high_orbit() {
  return Orbit{KeplerOrbit::make({.epoch = kTransferStart,
                                  .semi_major_axis_km = 24400.0,
                                  .eccentricity = 0.73,
                                  .inclination_rad = 28.5 * kRadPerDeg,
                                  .raan_rad = 281.0 * kRadPerDeg,
                                  .argument_of_perigee_rad = kPi,
                                  .mean_anomaly_rad = 164.698 * kRadPerDeg})
                   .value()};
}

struct NarrowPass {
  const char* name;
  std::vector<PulseChannel> dead;
  double rate_rpm;
  double turns;
  bool exchanged = false;  ///< Whether the beams are exchanged, so that north's is at 95 deg.
};

/// Returns a body whose beam at 85 deg has a chord of 3.7 deg and whose beam at 95 deg one of 17
/// deg.
SpinningBody body_of(const NarrowPass& pass) {
  SpinningBody body{.axis_icrf = direction_icrf(
                        {.ra_rad = 196.6782 * kRadPerDeg, .dec_rad = 55.206 * kRadPerDeg}),
                    .rate_rad_s = pass.rate_rpm * 2.0 * kPi / 60.0,
                    .first_turn_rad = 0.4,
                    .config = usual_config()};
  if (pass.exchanged) {
    std::swap(body.config.north, body.config.south);
  }
  return body;
}

std::vector<Edge> edges_of(const NarrowPass& pass, const SpinningBody& body, const Orbit& orbit) {
  auto edges = edges_between(body, seen_from(orbit), 0.0, body.seconds_of(pass.turns));
  std::erase_if(edges, [&](const Edge& edge) {
    return std::find(pass.dead.begin(), pass.dead.end(), edge.channel) != pass.dead.end();
  });
  return edges;
}

void expect_no_wrong_row_is_ok(const SpinOutput& output, const Eigen::Vector3d& true_icrf) {
  for (const SpinEstimate& estimate : estimates_of(output, SpinEstimator::Sequential)) {
    if (is_unopposed(estimate.assessment.quality)) {
      EXPECT_LT(error_sigmas(estimate, true_icrf), kSigmas) << sentence_of(estimate.assessment);
    }
  }
}

class SpinNarrowChord : public ::testing::TestWithParam<NarrowPass> {};

TEST_P(SpinNarrowChord, EveryPassIsSolved) {
  constexpr std::uint64_t kSeeds = 12;
  const NarrowPass& pass = GetParam();
  const Orbit orbit = high_orbit();
  const SpinningBody body = body_of(pass);
  const auto edges = edges_of(pass, body, orbit);
  for (std::uint64_t seed = 1; seed <= kSeeds; ++seed) {
    SCOPED_TRACE(seed);
    std::mt19937_64 rng{seed};
    const SpinOutput output = run(SpinPass{body.config, orbit}, noisy_pulses(body, edges, rng));
    expect_no_wrong_row_is_ok(output, body.axis_icrf);
    const auto batch = testing::solved(body.config, orbit, output);
    ASSERT_TRUE(batch) << batch.error().message;
    for (const SpinEstimate& last :
         {last_estimate(output, SpinEstimator::Sequential), batch->estimate}) {
      EXPECT_TRUE(is_unopposed(last.assessment.quality)) << sentence_of(last.assessment);
      EXPECT_LT(error_sigmas(last, body.axis_icrf), kSigmas);
    }
  }
}

INSTANTIATE_TEST_SUITE_P(
    Passes, SpinNarrowChord,
    ::testing::Values(
        NarrowPass{"north_alone", {PulseChannel::SouthIn, PulseChannel::SouthOut}, 151.104, 150.0},
        NarrowPass{
            "south_alone", {PulseChannel::NorthIn, PulseChannel::NorthOut}, 151.104, 150.0, true},
        NarrowPass{"slower", {PulseChannel::SouthIn, PulseChannel::SouthOut}, 60.0, 150.0},
        NarrowPass{"both", {}, 151.104, 150.0}),
    [](const auto& pass) { return std::string{pass.param.name}; });

TEST(SpinLongestChord, NoWrongRowIsOkAndMostPassesAreSolved) {
  constexpr std::uint64_t kFirstSeed = 15;
  constexpr std::uint64_t kSeeds = 20;
  const NarrowPass pass{
      "south_alone", {PulseChannel::NorthIn, PulseChannel::NorthOut}, 151.104, 150.0};
  const Orbit orbit = high_orbit();
  const SpinningBody body = body_of(pass);
  const auto edges = edges_of(pass, body, orbit);
  int solved = 0;
  for (std::uint64_t seed = kFirstSeed; seed < kFirstSeed + kSeeds; ++seed) {
    SCOPED_TRACE(seed);
    std::mt19937_64 rng{seed};
    const SpinOutput output = run(SpinPass{body.config, orbit}, noisy_pulses(body, edges, rng));
    expect_no_wrong_row_is_ok(output, body.axis_icrf);
    solved += is_unopposed(last_estimate(output, SpinEstimator::Sequential).assessment.quality);
  }
  EXPECT_GT(solved, 15);
}

}  // namespace spindrift::testing::spin_narrow_chord_test
