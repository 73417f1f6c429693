/// Beams near the Earth's limb have chords of a few degrees, which vanish for an axis 0.2 deg away,
/// while single fixes are degrees off. `sequential` and `batch` must find the axis, and no row of
/// `sequential` may be OK and wrong. The same holds near the longest chord, where axes on either
/// side of the middle see the same.

#include <gtest/gtest.h>

#include <Eigen/Geometry>
#include <algorithm>
#include <cmath>
#include <cstdint>
#include <numbers>
#include <random>
#include <string>
#include <utility>
#include <vector>

#include "pipelines/ephemeris/kepler_orbit.h"
#include "pipelines/frames/angle.h"
#include "pipelines/frames/celestial.h"
#include "pipelines/spin/batch/batch_estimator.h"
#include "pipelines/spin/batch/pass_edges.h"
#include "pipelines/spin/pass/spin_pass.h"
#include "services/base/assessment_words.h"
#include "tests/support/observed_spin.h"
#include "tests/support/product_text.h"

namespace spindrift::spin_narrow_chord_test {

constexpr double kPi = std::numbers::pi;
constexpr double kSigmas = 5.0;

/// Returns an orbit near apogee, 42,000 km from the Earth's centre, where the Earth's half-angle is
/// 8.8 deg.
Orbit high_orbit() {
  return Orbit{KeplerOrbit::make({.epoch = testing::kTransferStart,
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
testing::SpinningBody body_of(const NarrowPass& pass) {
  testing::SpinningBody body{.axis_icrf = direction_icrf(
                                 {.ra_rad = 196.6782 * kRadPerDeg, .dec_rad = 55.206 * kRadPerDeg}),
                             .rate_rad_s = pass.rate_rpm * 2.0 * kPi / 60.0,
                             .first_turn_rad = 0.4,
                             .config = testing::usual_config()};
  if (pass.exchanged) {
    std::swap(body.config.north, body.config.south);
  }
  return body;
}

struct Solved {
  SpinOutput output;
  Expected<BatchSolution> batch;
};

Solved solved(const testing::SpinningBody& body, const Orbit& orbit,
              const std::vector<Pulse>& pulses) {
  SpinOutput output = testing::run(SpinPass{body.config, orbit}, pulses);
  PassEdges pass;
  for (const SpinProduct& product : output.products) {
    pass.note(product);
  }
  const auto starts = pass.starts(body.config.prior);
  auto batch = solve_batch(body.config, orbit, std::move(pass).edges(), starts);
  return {.output = std::move(output), .batch = std::move(batch)};
}

double error_sigmas(const SpinEstimate& estimate, const Eigen::Vector3d& true_icrf) {
  return angle_between_rad(estimate.axis_icrf, true_icrf) / testing::sigma_rad(estimate);
}

std::vector<testing::Edge> edges_of(const NarrowPass& pass, const testing::SpinningBody& body,
                                    const Orbit& orbit) {
  auto edges =
      testing::edges_between(body, testing::seen_from(orbit, testing::spherical_horizon_km(40.0)),
                             0.0, pass.turns * 2.0 * kPi / body.rate_rad_s);
  std::erase_if(edges, [&](const testing::Edge& edge) {
    return std::find(pass.dead.begin(), pass.dead.end(), edge.channel) != pass.dead.end();
  });
  return edges;
}

void expect_no_wrong_row_is_ok(const SpinOutput& output, const Eigen::Vector3d& true_icrf) {
  for (const SpinEstimate& estimate : testing::all_of<SpinEstimate>(output)) {
    if (estimate.estimator == SpinEstimator::Sequential &&
        is_unopposed(estimate.assessment.quality)) {
      EXPECT_LT(error_sigmas(estimate, true_icrf), kSigmas) << sentence_of(estimate.assessment);
    }
  }
}

class SpinNarrowChord : public ::testing::TestWithParam<NarrowPass> {};

TEST_P(SpinNarrowChord, EveryPassIsSolved) {
  constexpr std::uint64_t kSeeds = 12;
  const NarrowPass& pass = GetParam();
  const Orbit orbit = high_orbit();
  const testing::SpinningBody body = body_of(pass);
  const auto edges = edges_of(pass, body, orbit);
  for (std::uint64_t seed = 1; seed <= kSeeds; ++seed) {
    SCOPED_TRACE(seed);
    std::mt19937_64 rng{seed};
    const Solved found = solved(
        body, orbit, testing::pulses_from(edges, testing::kTransferStart, body.config.noise, rng));
    expect_no_wrong_row_is_ok(found.output, body.axis_icrf);
    const SpinEstimate last = testing::last_estimate(found.output, SpinEstimator::Sequential);
    EXPECT_TRUE(is_unopposed(last.assessment.quality)) << sentence_of(last.assessment);
    EXPECT_LT(error_sigmas(last, body.axis_icrf), kSigmas);
    ASSERT_TRUE(found.batch) << found.batch.error().message;
    EXPECT_TRUE(is_unopposed(found.batch->estimate.assessment.quality))
        << sentence_of(found.batch->estimate.assessment);
    EXPECT_LT(error_sigmas(found.batch->estimate, body.axis_icrf), kSigmas);
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
  const testing::SpinningBody body = body_of(pass);
  const auto edges = edges_of(pass, body, orbit);
  int solved = 0;
  for (std::uint64_t seed = kFirstSeed; seed < kFirstSeed + kSeeds; ++seed) {
    SCOPED_TRACE(seed);
    std::mt19937_64 rng{seed};
    const SpinOutput output =
        testing::run(SpinPass{body.config, orbit},
                     testing::pulses_from(edges, testing::kTransferStart, body.config.noise, rng));
    expect_no_wrong_row_is_ok(output, body.axis_icrf);
    solved +=
        is_unopposed(testing::last_estimate(output, SpinEstimator::Sequential).assessment.quality);
  }
  EXPECT_GT(solved, 15);
}

}  // namespace spindrift::spin_narrow_chord_test
