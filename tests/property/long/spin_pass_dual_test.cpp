/// Passes with two or four possible axes because a slit or a beam is dead: over random orbits and
/// axes no estimate is confidently wrong.

#include <gtest/gtest.h>

#include <algorithm>
#include <array>
#include <cmath>
#include <map>
#include <numbers>
#include <optional>
#include <random>
#include <set>
#include <string>
#include <vector>

#include "pipelines/ephemeris/kepler_orbit.h"
#include "pipelines/frames/angle.h"
#include "pipelines/frames/celestial.h"
#include "pipelines/spin/pass/spin_pass.h"
#include "services/base/assessment_words.h"
#include "tests/support/assessed.h"
#include "tests/support/observed_spin.h"
#include "tests/support/product_text.h"
#include "tests/support/spinning_body.h"

namespace spindrift::testing::spin_pass_dual_test {

using enum PulseChannel;

constexpr double kPi = std::numbers::pi;
constexpr int kPasses = 40;
constexpr double kRevolutions = 250.0;
constexpr double kSigmas = 5.0;

const Eigen::Vector3d kAxisWithoutSun1_icrf =
    direction_icrf({.ra_rad = 120.0 * kRadPerDeg, .dec_rad = -60.0 * kRadPerDeg});

struct DeadSensors {
  std::string name;
  std::set<PulseChannel> channels;
};

const std::array<DeadSensors, 5> kDead = {{{"case 4", {Sun2}},
                                           {"case 5", {Sun2, SouthIn, SouthOut}},
                                           {"case 6", {Sun2, NorthIn, NorthOut}},
                                           {"case 7", {Sun1}},
                                           {"case 5 with sun2", {Sun1, SouthIn, SouthOut}}}};

/// Returns an orbit that rises or descends through two to six Earth radii.
Orbit random_orbit(std::mt19937_64& rng) {
  std::uniform_real_distribution<double> uniform;
  const double inclination_rad = 60.0 * uniform(rng) * kRadPerDeg;
  const double raan_rad = 2.0 * kPi * uniform(rng);
  const double argument_rad = 2.0 * kPi * uniform(rng);
  const double anomaly_rad = 0.2 + 0.5 * uniform(rng);
  return Orbit{
      KeplerOrbit::make({.epoch = kTransferStart,
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
  bool sure = false;  ///< Whether the last row of `sequential` is OK.
};

Outcome judged(const SpinOutput& output, const Eigen::Vector3d& true_icrf) {
  Outcome outcome;
  std::map<std::int64_t, SpinFix> last;
  for (const SpinFix& fix : all_of<SpinFix>(output)) {
    last.insert_or_assign(fix.revolution, fix);
  }
  const bool by_dispersion = std::any_of(last.begin(), last.end(), [](const auto& fix) {
    return fix.second.resolution == Resolution::Dispersion;
  });
  EXPECT_EQ(testing::has(output.notices, NoticeCode::DispersionSettles) ||
                testing::has(output.notices, NoticeCode::LikelihoodSettles),
            by_dispersion);
  for (const auto& [number, fix] : last) {
    if (fix.accepted) {
      outcome.fix_accepted = true;
      EXPECT_LT(angle_between_rad(fix.axis_icrf, true_icrf),
                kSigmas * std::sqrt(fix.covariance_rad2.trace()))
          << "fix of revolution " << number << ", " << name_of(fix.resolution);
    }
  }
  for (const SpinEstimate& estimate : estimates_of(output, SpinEstimator::Sequential)) {
    outcome.sure = is_unopposed(estimate.assessment.quality);
    if (outcome.sure) {
      EXPECT_LT(error_sigmas(estimate, true_icrf), kSigmas) << sentence_of(estimate.assessment);
    }
  }
  return outcome;
}

std::vector<Pulse> without(std::vector<Pulse> pulses, const std::set<PulseChannel>& dead) {
  std::erase_if(pulses, [&](const Pulse& pulse) { return dead.contains(pulse.channel); });
  return pulses;
}

/// Adds one spurious edge of each dead channel at a random phase in `share` of the turns.
std::vector<Pulse> with_strays(std::vector<Pulse> pulses, const std::set<PulseChannel>& dead,
                               double share, double period_s, std::mt19937_64& rng) {
  std::uniform_real_distribution<double> uniform;
  for (const PulseChannel channel : dead) {
    for (double turn = 0.0; turn < kRevolutions; turn += 1.0) {
      if (uniform(rng) < share) {
        pulses.push_back(
            {.t = shifted(kTransferStart, (turn + uniform(rng)) * period_s), .channel = channel});
      }
    }
  }
  std::sort(pulses.begin(), pulses.end());
  return pulses;
}

class DeadSensor : public ::testing::TestWithParam<double> {};

INSTANTIATE_TEST_SUITE_P(Strays, DeadSensor, ::testing::Values(0.0, 0.02, 0.1));

TEST_P(DeadSensor, MakesNothingConfidentlyWrong) {
  std::mt19937_64 rng{77};
  std::map<std::string, int> sure;
  std::map<std::string, int> with_fix;
  for (int trial = 0; trial < kPasses; ++trial) {
    const Surroundings from{random_orbit(rng)};
    const SpinningBody body = random_body(from.around, 8.0 * kRadPerDeg, rng);
    const auto pulses = from.pulses(body, 0.0, body.seconds_of(kRevolutions), rng);
    for (const DeadSensors& dead : kDead) {
      SCOPED_TRACE(dead.name + ", pass " + std::to_string(trial));
      const Outcome outcome = judged(run(SpinPass{body.config, from.orbit},
                                         with_strays(without(pulses, dead.channels), dead.channels,
                                                     GetParam(), body.seconds_of(1.0), rng)),
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
    const Surroundings from{random_orbit(rng)};
    SpinningBody body = random_body(from.around, 8.0 * kRadPerDeg, rng);
    body.config.prior = SpinPrior{.axis_icrf = body.axis_icrf, .sigma_rad = 3.0 * kRadPerDeg};
    const auto pulses = without(from.pulses(body, 0.0, body.seconds_of(kRevolutions), rng), {Sun2});
    const SpinOutput output = run(SpinPass{body.config, from.orbit}, pulses);
    EXPECT_TRUE(judged(output, body.axis_icrf).fix_accepted);
  }
}

/// Returns the candidate of the pass's first revolutions that is farthest from the truth.
std::optional<Eigen::Vector3d> false_axis(const SpinningBody& body, const Orbit& orbit,
                                          const std::vector<Pulse>& pulses) {
  constexpr std::ptrdiff_t kFirstPulses = 120;
  const auto all = static_cast<std::ptrdiff_t>(pulses.size());
  const auto fixes = all_of<SpinFix>(
      run(SpinPass{body.config, orbit},
          std::vector<Pulse>(pulses.begin(), pulses.begin() + std::min(all, kFirstPulses))));
  if (fixes.empty()) {
    return std::nullopt;
  }
  std::vector<Eigen::Vector3d> axes_icrf = {fixes.front().axis_icrf};
  for (const SpinAlternate& alternate : fixes.front().alternates) {
    axes_icrf.push_back(alternate.axis_icrf);
  }
  const auto farthest = *std::max_element(axes_icrf.begin(), axes_icrf.end(),
                                          [&](const Eigen::Vector3d& a, const Eigen::Vector3d& b) {
                                            return a.dot(body.axis_icrf) > b.dot(body.axis_icrf);
                                          });
  return angle_between_rad(farthest, body.axis_icrf) > 10.0 * kRadPerDeg ? std::optional{farthest}
                                                                         : std::nullopt;
}

struct PriorOutcome {
  int passes = 0;
  int estimated = 0;
  int sure = 0;

  std::string text() const {
    return std::to_string(passes) + " passes, " + std::to_string(estimated) + " estimated, " +
           std::to_string(sure) + " sure";
  }
};

/// Runs passes in which the Earth direction turns by at least 10 deg, with a prior of sigma 3 deg
/// that is about 1 deg off the truth or a false candidate.
std::map<std::string, PriorOutcome> with_prior(bool at_the_truth) {
  std::mt19937_64 rng{79};
  std::normal_distribution<double> normal{0.0, 1.0 * kRadPerDeg};
  std::map<std::string, PriorOutcome> outcomes;
  for (int trial = 0; trial < kPasses; ++trial) {
    const Surroundings from{random_orbit(rng)};
    SpinningBody body = random_body(from.around, 8.0 * kRadPerDeg, rng);
    double duration_s = 300.0;
    while (duration_s < 1500.0 &&
           angle_between_rad(from.around.earth_icrf_km(0.0),
                             from.around.earth_icrf_km(duration_s)) < 10.0 * kRadPerDeg) {
      duration_s += 50.0;
    }
    const auto pulses = from.pulses(body, 0.0, duration_s, rng);
    for (const DeadSensors& dead : kDead) {
      SCOPED_TRACE(dead.name + ", pass " + std::to_string(trial));
      const auto left = without(pulses, dead.channels);
      const auto elsewhere = false_axis(body, from.orbit, left);
      if (!elsewhere) {
        continue;
      }
      const Eigen::Vector3d middle = at_the_truth ? body.axis_icrf : *elsewhere;
      const Eigen::Vector2d off_rad{normal(rng), normal(rng)};
      SpinConfig config = body.config;
      config.prior = SpinPrior{.axis_icrf = (middle + tangent_basis(middle) * off_rad).normalized(),
                               .sigma_rad = 3.0 * kRadPerDeg};
      PriorOutcome& outcome = outcomes[dead.name];
      ++outcome.passes;
      const auto estimates =
          estimates_of(run(SpinPass{config, from.orbit}, left), SpinEstimator::Sequential);
      if (estimates.empty()) {
        continue;
      }
      const SpinEstimate& last = estimates.back();
      // No prior makes an axis certain whose fixes are all near tangent.
      outcome.estimated += !has(last.assessment, ReasonCode::FixesNearTangent) ? 1 : 0;
      if (is_unopposed(last.assessment.quality)) {
        ++outcome.sure;
        EXPECT_LT(error_sigmas(last, body.axis_icrf), kSigmas) << sentence_of(last.assessment);
      }
    }
  }
  return outcomes;
}

TEST(SpinPassDual, AFalsePriorDoesNotOutliveTheEdgesThatContradictIt) {
  for (const auto& [name, outcome] : with_prior(false)) {
    SCOPED_TRACE(name);
    EXPECT_GT(outcome.sure, outcome.passes / 4);
    ::testing::Test::RecordProperty(name, outcome.text());
  }
}

TEST(SpinPassDual, ATruePriorStands) {
  int estimated = 0;
  int sure = 0;
  for (const auto& [name, outcome] : with_prior(true)) {
    estimated += outcome.estimated;
    sure += outcome.sure;
    ::testing::Test::RecordProperty(name, outcome.text());
  }
  EXPECT_GE(sure, 0.95 * estimated);
}

/// Runs a pass without pulses of the north beam although the beam crosses the Earth.
SpinOutput without_north(bool said_to_be_healthy) {
  std::mt19937_64 rng{80};
  const Surroundings from;
  SpinningBody body = random_body(from.around, 3.0 * kRadPerDeg, rng);
  body.config.north->healthy = said_to_be_healthy;
  return run(SpinPass{body.config, from.orbit},
             without(from.pulses(body, 0.0, 60.0, rng), {NorthIn, NorthOut}));
}

SpinOutput without_sun1(const std::optional<SpinPrior>& prior) {
  std::mt19937_64 rng{82};
  const Surroundings from;
  SpinningBody body{.axis_icrf = kAxisWithoutSun1_icrf,
                    .rate_rad_s = 2.0 * kPi,
                    .first_turn_rad = 0.0,
                    .config = usual_config()};
  body.config.prior = prior;
  return run(SpinPass{body.config, from.orbit},
             without(from.pulses(body, 0.0, 200.0, rng), {Sun1}));
}

TEST(SpinPassDual, APriorSettlesAPassWithoutSun1) {
  const Eigen::Vector2d off_rad{1.5 * kRadPerDeg, -1.0 * kRadPerDeg};
  const SpinOutput output = without_sun1(SpinPrior{
      .axis_icrf =
          (kAxisWithoutSun1_icrf + tangent_basis(kAxisWithoutSun1_icrf) * off_rad).normalized(),
      .sigma_rad = 5.0 * kRadPerDeg});
  const SpinEstimate last = last_estimate(output, SpinEstimator::Sequential);
  EXPECT_TRUE(is_unopposed(last.assessment.quality)) << sentence_of(last.assessment);
  EXPECT_LT(error_sigmas(last, kAxisWithoutSun1_icrf), kSigmas);
  EXPECT_LT(sigma_rad(last), 0.5 * kRadPerDeg);
}

TEST(SpinPassDual, ASilentBeamThatIsSaidToBeHealthyIsToldAndItsFixesNotAccepted) {
  const SpinOutput output = without_north(true);
  EXPECT_THAT(output.notices,
              ::testing::Contains(Notice{NoticeCode::HealthyBeamSilent, {{"beam", "north"}}}));
  const auto fixes = all_of<SpinFix>(output);
  EXPECT_GT(fixes.size(), 40U);
  EXPECT_TRUE(std::none_of(fixes.begin(), fixes.end(), [](const SpinFix& fix) {
    return fix.accepted && fix.resolution == Resolution::Geometry;
  }));
}

TEST(SpinPassDual, ASilentBeamThatMayHaveFailedIsNoContradiction) {
  const SpinOutput output = without_north(false);
  EXPECT_FALSE(testing::has(output.notices, NoticeCode::HealthyBeamSilent));
  const auto fixes = all_of<SpinFix>(output);
  EXPECT_GT(std::count_if(fixes.begin(), fixes.end(), [](const auto& fix) { return fix.accepted; }),
            40);
}

}  // namespace spindrift::testing::spin_pass_dual_test
