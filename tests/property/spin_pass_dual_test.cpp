/// Passes that have two axes or four to choose from, because a slit or a beam is dead: over random
/// orbits and axes no estimate is confidently wrong.

#include <gtest/gtest.h>

#include <algorithm>
#include <array>
#include <cmath>
#include <iterator>
#include <map>
#include <numbers>
#include <random>
#include <set>
#include <string>
#include <vector>

#include "pipelines/ephemeris/kepler_orbit.h"
#include "pipelines/frames/celestial.h"
#include "pipelines/spin/spin_pass.h"
#include "tests/support/observed_spin.h"
#include "tests/support/product_text.h"
#include "tests/support/spinning_body.h"

namespace spindrift {
namespace {

using enum PulseChannel;
using testing::all_of;

constexpr double kPi = std::numbers::pi;
constexpr double kDegree_rad = kPi / 180.0;
constexpr int kPasses = 40;
constexpr double kRevolutions = 250.0;
constexpr double kSigmas = 5.0;

struct DeadSensors {
  std::string name;
  std::set<PulseChannel> channels;
};

const std::array<DeadSensors, 5> kDead = {{{"case 4", {Sun2}},
                                           {"case 5", {Sun2, SouthIn, SouthOut}},
                                           {"case 6", {Sun2, NorthIn, NorthOut}},
                                           {"case 7", {Sun1}},
                                           {"case 5 with sun2", {Sun1, SouthIn, SouthOut}}}};

/// Rises or sinks through two to six Earth radii.
Orbit random_orbit(std::mt19937_64& rng) {
  std::uniform_real_distribution<double> uniform;
  const double inclination_rad = 60.0 * uniform(rng) * kDegree_rad;
  const double raan_rad = 2.0 * kPi * uniform(rng);
  const double argument_rad = 2.0 * kPi * uniform(rng);
  const double anomaly_rad = 0.2 + 0.5 * uniform(rng);
  return Orbit{
      KeplerOrbit::make({.epoch = testing::kTransferStart,
                         .semi_major_axis_km = 24400.0,
                         .eccentricity = 0.73,
                         .inclination_rad = inclination_rad,
                         .raan_rad = raan_rad,
                         .argument_of_perigee_rad = argument_rad,
                         .mean_anomaly_rad = uniform(rng) < 0.5 ? anomaly_rad : -anomaly_rad})
          .value()};
}

struct Outcome {
  bool fix_accepted = false;
  bool sure = false;  ///< `sequential` ends with OK.
};

Outcome judged(const SpinOutput& output, const Eigen::Vector3d& true_icrf) {
  Outcome outcome;
  std::map<std::int64_t, SpinFix> last;
  for (const SpinFix& fix : all_of<SpinFix>(output)) {
    last.insert_or_assign(fix.revolution, fix);
  }
  for (const auto& [number, fix] : last) {
    if (fix.accepted) {
      outcome.fix_accepted = true;
      EXPECT_LT(angle_between_rad(fix.axis_icrf, true_icrf),
                kSigmas * std::sqrt(fix.covariance_rad2.trace()))
          << "fix of revolution " << number << ", " << name_of(fix.resolution);
    }
  }
  for (const SpinEstimate& estimate : all_of<SpinEstimate>(output)) {
    if (estimate.estimator == SpinEstimator::Sequential) {
      outcome.sure = estimate.status.starts_with("OK");
      if (outcome.sure) {
        EXPECT_LT(angle_between_rad(estimate.axis_icrf, true_icrf),
                  kSigmas * testing::sigma_rad(estimate))
            << estimate.status;
      }
    }
  }
  return outcome;
}

std::vector<Pulse> without(const std::vector<Pulse>& pulses, const std::set<PulseChannel>& dead) {
  std::vector<Pulse> left;
  std::copy_if(pulses.begin(), pulses.end(), std::back_inserter(left),
               [&](const Pulse& pulse) { return !dead.contains(pulse.channel); });
  return left;
}

TEST(SpinPassDual, NeverConfidentlyWrongWithADeadSensor) {
  std::mt19937_64 rng{77};
  std::map<std::string, int> sure;
  std::map<std::string, int> with_fix;
  for (int trial = 0; trial < kPasses; ++trial) {
    const Orbit orbit = random_orbit(rng);
    const auto around = testing::seen_from(orbit, testing::spherical_horizon_km(40.0));
    const testing::SpinningBody body = testing::random_body(around, 8.0 * kDegree_rad, rng);
    const auto edges =
        testing::edges_between(body, around, 0.0, kRevolutions * 2.0 * kPi / body.rate_rad_s);
    const auto pulses =
        testing::pulses_from(edges, testing::kTransferStart, body.config.noise, rng);
    for (const DeadSensors& dead : kDead) {
      SCOPED_TRACE(dead.name + ", pass " + std::to_string(trial));
      const Outcome outcome =
          judged(testing::run(SpinPass{body.config, orbit}, without(pulses, dead.channels)),
                 body.axis_icrf);
      sure[dead.name] += outcome.sure ? 1 : 0;
      with_fix[dead.name] += outcome.fix_accepted ? 1 : 0;
    }
  }
  for (const DeadSensors& dead : kDead) {
    RecordProperty(dead.name, std::to_string(sure[dead.name]) + " sure, " +
                                  std::to_string(with_fix[dead.name]) + " with a fix");
    EXPECT_GT(sure[dead.name], kPasses / 4) << dead.name;
  }
}

TEST(SpinPassDual, APriorChoosesTheAxisNearIt) {
  std::mt19937_64 rng{78};
  for (int trial = 0; trial < kPasses / 4; ++trial) {
    SCOPED_TRACE(trial);
    const Orbit orbit = random_orbit(rng);
    const auto around = testing::seen_from(orbit, testing::spherical_horizon_km(40.0));
    testing::SpinningBody body = testing::random_body(around, 8.0 * kDegree_rad, rng);
    body.config.prior = SpinPrior{.axis_icrf = body.axis_icrf, .sigma_rad = 3.0 * kDegree_rad};
    const auto edges =
        testing::edges_between(body, around, 0.0, kRevolutions * 2.0 * kPi / body.rate_rad_s);
    const auto pulses = without(
        testing::pulses_from(edges, testing::kTransferStart, body.config.noise, rng), {Sun2});
    const SpinOutput output = testing::run(SpinPass{body.config, orbit}, pulses);
    EXPECT_TRUE(judged(output, body.axis_icrf).fix_accepted);
  }
}

}  // namespace
}  // namespace spindrift
