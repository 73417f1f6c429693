/// A pass in which nearly all fixes are near tangent and the others lack the true axis: no row of
/// `sequential` is OK and wrong.

#include <gtest/gtest.h>

#include <cstdint>
#include <numbers>
#include <random>
#include <string>
#include <vector>

#include "pipelines/frames/angle.h"
#include "pipelines/frames/celestial.h"
#include "pipelines/spin/pass/spin_pass.h"
#include "services/base/assessment_words.h"
#include "tests/support/observed_spin.h"
#include "tests/support/product_text.h"

namespace spindrift::spin_near_tangent_test {

constexpr double kPi = std::numbers::pi;
constexpr double kSigmas = 5.0;

/// Returns a body whose sun slit 2 does not see the Sun (case 6).
testing::SpinningBody body_of_the_pass() {
  testing::SpinningBody body{
      .axis_icrf = direction_icrf({.ra_rad = 217.26 * kRadPerDeg, .dec_rad = 15.1292 * kRadPerDeg}),
      .rate_rad_s = 5.0 * kPi,
      .first_turn_rad = 0.4,
      .config = testing::usual_config()};
  body.config.south->azimuth_rad = 120.0 * kRadPerDeg;
  return body;
}

TEST(SpinNearTangent, NoRowIsOkThatIsNotNearTheAxis) {
  constexpr std::uint64_t kSeeds = 6;
  constexpr double kTurns = 1000.0;
  constexpr double kLost = 0.03;
  const Orbit orbit = testing::transfer_with_node(187.32712908047432);
  const testing::SpinningBody body = body_of_the_pass();
  auto edges =
      testing::edges_between(body, testing::seen_from(orbit, testing::spherical_horizon_km(40.0)),
                             0.0, kTurns * 2.0 * kPi / body.rate_rad_s);
  std::erase_if(edges, [](const testing::Edge& edge) {
    return edge.channel == PulseChannel::NorthIn || edge.channel == PulseChannel::NorthOut;
  });
  for (std::uint64_t seed = 1; seed <= kSeeds; ++seed) {
    SCOPED_TRACE(seed);
    std::mt19937_64 rng{seed};
    auto pulses = testing::pulses_from(edges, testing::kTransferStart, body.config.noise, rng);
    std::erase_if(pulses, [&](const Pulse&) { return std::bernoulli_distribution{kLost}(rng); });
    const SpinOutput output = testing::run(SpinPass{body.config, orbit}, pulses);
    int wrong = 0;
    std::string first;
    for (const SpinEstimate& estimate : testing::all_of<SpinEstimate>(output)) {
      if (estimate.estimator == SpinEstimator::Sequential &&
          is_unopposed(estimate.assessment.quality) &&
          angle_between_rad(estimate.axis_icrf, body.axis_icrf) >
              kSigmas * testing::sigma_rad(estimate)) {
        first = wrong == 0 ? sentence_of(estimate.assessment) : first;
        ++wrong;
      }
    }
    EXPECT_EQ(wrong, 0) << first;
  }
}

}  // namespace spindrift::spin_near_tangent_test
