/// A pass in which nearly all fixes are near tangent and the others lack the true axis: no row of
/// `sequential` is OK and wrong.

#include <gtest/gtest.h>

#include <cstdint>
#include <numbers>
#include <random>
#include <string>

#include "pipelines/frames/angle.h"
#include "pipelines/frames/celestial.h"
#include "pipelines/spin/pass/spin_pass.h"
#include "services/base/assessment_words.h"
#include "tests/support/observed_spin.h"
#include "tests/support/product_text.h"

namespace spindrift::testing::spin_near_tangent_test {

constexpr double kPi = std::numbers::pi;
constexpr double kSigmas = 5.0;

/// Returns a body whose sun slit 2 does not see the Sun (case 6).
SpinningBody body_of_the_pass() {
  SpinningBody body{
      .axis_icrf = direction_icrf({.ra_rad = 217.26 * kRadPerDeg, .dec_rad = 15.1292 * kRadPerDeg}),
      .rate_rad_s = 5.0 * kPi,
      .first_turn_rad = 0.4,
      .config = usual_config()};
  body.config.south->azimuth_rad = 120.0 * kRadPerDeg;
  return body;
}

TEST(SpinNearTangent, NoRowIsOkThatIsNotNearTheAxis) {
  constexpr std::uint64_t kSeeds = 6;
  constexpr double kTurns = 1000.0;
  constexpr double kLost = 0.03;
  const Orbit orbit = transfer_with_node(187.32712908047432);
  const SpinningBody body = body_of_the_pass();
  auto edges = edges_between(body, seen_from(orbit), 0.0, body.seconds_of(kTurns));
  std::erase_if(edges, [](const Edge& edge) {
    return edge.channel == PulseChannel::NorthIn || edge.channel == PulseChannel::NorthOut;
  });
  for (std::uint64_t seed = 1; seed <= kSeeds; ++seed) {
    SCOPED_TRACE(seed);
    std::mt19937_64 rng{seed};
    auto pulses = noisy_pulses(body, edges, rng);
    std::erase_if(pulses, [&](const Pulse&) { return std::bernoulli_distribution{kLost}(rng); });
    const SpinOutput output = run(SpinPass{body.config, orbit}, pulses);
    int wrong = 0;
    std::string first;
    for (const SpinEstimate& estimate : estimates_of(output, SpinEstimator::Sequential)) {
      if (is_unopposed(estimate.assessment.quality) &&
          error_sigmas(estimate, body.axis_icrf) > kSigmas) {
        first = wrong == 0 ? sentence_of(estimate.assessment) : first;
        ++wrong;
      }
    }
    EXPECT_EQ(wrong, 0) << first;
  }
}

}  // namespace spindrift::testing::spin_near_tangent_test
