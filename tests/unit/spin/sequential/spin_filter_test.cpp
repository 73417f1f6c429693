#include "pipelines/spin/sequential/spin_filter.h"

#include <cmath>
#include <numbers>
#include <random>
#include <vector>

#include "pipelines/frames/angle.h"
#include "pipelines/frames/celestial.h"
#include "tests/support/matchers.h"
#include "tests/support/normalised_square.h"
#include "tests/support/observed_spin.h"
#include "tests/support/recorded_pass.h"
#include "tests/support/spinning_body.h"

namespace spindrift::testing::spin_filter_test {

constexpr double kPi = std::numbers::pi;

Eigen::Matrix2d round_covariance(double sigma_rad) {
  return sigma_rad * sigma_rad * Eigen::Matrix2d::Identity();
}

RevolutionObservations work_in(SpinFilter& filter, const SpinConfig& config,
                               const ObservedRevolution& seen) {
  const GoodEdges edges{config, seen.revolution};
  filter.predict(edges.span().front().t);
  return filter.update(config, seen.sky, edges.span());
}

double sigma_deg(const SpinFilter& filter) {
  return std::sqrt(filter.axis_covariance_rad2().trace()) / kRadPerDeg;
}

/// Returns the normalised squared error (NEES): chi-square with two degrees of freedom.
double squared_error(const SpinFilter& filter, const Eigen::Vector3d& true_icrf) {
  const Eigen::Vector2d error_rad = testing::error_rad(filter.axis_icrf(), true_icrf);
  return normalised_square(error_rad, filter.axis_covariance_rad2());
}

// Chi-square quantile for a probability of 1e-4 and two degrees of freedom.
constexpr double kOneInTenThousand = 18.42;

class SpinFilterTest : public ::testing::Test {
 protected:
  SpinFilter about_the_axis(const Eigen::Matrix2d& covariance_rad2) const {
    return SpinFilter::about(pass_.true_axis_icrf, covariance_rad2, pass_.config,
                             seen_[0].revolution, seen_[0].sky)
        .value();
  }

  /// Returns the filter after the edges of these revolutions.
  SpinFilter filtered(const std::vector<ObservedRevolution>& seen) const {
    SpinFilter filter = SpinFilter::about(pass_.true_axis_icrf, round_covariance(1.0 * kRadPerDeg),
                                          pass_.config, seen[0].revolution, seen[0].sky)
                            .value();
    for (std::size_t i = 1; i <= 200; ++i) {
      work_in(filter, pass_.config, seen[i]);
    }
    return filter;
  }

  RecordedPass pass_ = recorded_pass("nominal");
  std::vector<ObservedRevolution> seen_ = observed(pass_.config, pass_.orbit, pass_.pulses);
};

TEST_F(SpinFilterTest, ReachesTheInformationLimitOfTheDesign) {
  // pipelines/spin/README.md: GTO at 13,900 km, 60 rpm, 0.1 and 0.5 ms give 0.405 deg for one
  // revolution and 0.0409 deg after 100. Chords and distance change by 5 % during the pass.
  Revolution first = seen_[0].revolution;
  first.period = seen_[100].revolution.period;  // The figures assume that the rate is known.
  SpinFilter filter = SpinFilter::about(pass_.true_axis_icrf, round_covariance(5.0 * kRadPerDeg),
                                        pass_.config, first, seen_[0].sky)
                          .value();
  work_in(filter, pass_.config, seen_[1]);
  EXPECT_NEAR(sigma_deg(filter), 0.405, 0.05 * 0.405);
  for (std::size_t i = 2; i <= 100; ++i) {
    work_in(filter, pass_.config, seen_[i]);
  }
  EXPECT_NEAR(sigma_deg(filter), 0.0409, 0.05 * 0.0409);
  EXPECT_LT(squared_error(filter, pass_.true_axis_icrf), kOneInTenThousand);
}

TEST_F(SpinFilterTest, AChannelThatIsLateMovesTheAxisByWhatItsOffsetAddsToTheCovariance) {
  const SpinFilter in_time = filtered(seen_);
  for (std::size_t channel = 0; channel < kPulseChannels; ++channel) {
    SCOPED_TRACE(name_of(static_cast<PulseChannel>(channel)));
    constexpr double kLate_s = 2e-5;
    auto late = seen_;
    for (ObservedRevolution& one : late) {
      if (auto& edge = one.revolution.edges.at(channel)) {
        edge = shifted(*edge, kLate_s);
      }
    }
    ConsideredPrior offsets_s2 = ConsideredPrior::Zero();
    offsets_s2(static_cast<Eigen::Index>(channel), static_cast<Eigen::Index>(channel)) =
        kLate_s * kLate_s;
    const double moved_rad = angle_between_rad(filtered(late).axis_icrf(), in_time.axis_icrf());
    // The shift is a fifth of an edge's noise: another edge may be gated, and slopes change
    // slightly.
    EXPECT_NEAR(moved_rad, std::sqrt(in_time.considered_rad2(offsets_s2).trace()),
                0.03 * moved_rad);
  }
}

TEST_F(SpinFilterTest, StartsWithWhatIsKnownOfTheAxisAndLittleOfPhaseAndRate) {
  Eigen::Matrix2d covariance_rad2;
  covariance_rad2 << 4e-5, 1e-5, 1e-5, 2e-5;
  const SpinFilter filter = about_the_axis(covariance_rad2);
  EXPECT_LT((filter.axis_icrf() - pass_.true_axis_icrf).norm(), 1e-14);
  EXPECT_TRUE(filter.axis_covariance_rad2().isApprox(covariance_rad2, 1e-12));
  EXPECT_GT(filter.phase_sigma_rad(), 0.05);
  EXPECT_GT(filter.rate_sigma_rad_s(), 1e-4 * filter.rate_rad_s());
  EXPECT_NEAR(filter.rate_rad_s(), pass_.true_rate_rad_s, 3.0 * filter.rate_sigma_rad_s());
}

TEST_F(SpinFilterTest, WithoutAnEdgeNothingTellsThePhase) {
  ObservedRevolution seen = seen_.front();
  seen.revolution.edges = {};
  EXPECT_FALSE(SpinFilter::about(pass_.true_axis_icrf, round_covariance(0.01), pass_.config,
                                 seen.revolution, seen.sky));
}

TEST_F(SpinFilterTest, UncertaintyGrowsWithTimeAndTimeNeverRunsBack) {
  SpinFilter filter = about_the_axis(round_covariance(0.01));
  const TaiTime t = filter.t();
  filter.predict(shifted(t, -10.0));
  EXPECT_EQ(filter.t(), t);
  const double phase_sigma_rad = filter.phase_sigma_rad();
  const double rate_sigma_rad_s = filter.rate_sigma_rad_s();
  filter.predict(shifted(t, 100.0));
  EXPECT_EQ(filter.t(), shifted(t, 100.0));
  EXPECT_GT(filter.phase_sigma_rad(), std::hypot(phase_sigma_rad, 100.0 * rate_sigma_rad_s));
  EXPECT_GT(filter.rate_sigma_rad_s(), rate_sigma_rad_s);
}

TEST_F(SpinFilterTest, ASpuriousEdgeIsGatedAndLeavesNoTrace) {
  SpinFilter filter = about_the_axis(round_covariance(0.01));
  for (std::size_t i = 1; i < 20; ++i) {
    work_in(filter, pass_.config, seen_[i]);
  }
  ObservedRevolution without = seen_[20];
  without.revolution.edges.at(index_of(PulseChannel::NorthIn)).reset();
  ObservedRevolution spurious = seen_[20];
  auto& north_in = spurious.revolution.edges.at(index_of(PulseChannel::NorthIn));
  north_in = shifted(*north_in, 0.01);  // 20 sigmas of its noise.

  SpinFilter unharmed = filter;
  for (const Observation& edge : work_in(unharmed, pass_.config, without).edges()) {
    EXPECT_FALSE(edge.rejected_by);
    EXPECT_LE(edge.nis, edge.limit);
  }
  const RevolutionObservations said = work_in(filter, pass_.config, spurious);
  for (const Observation& edge : said.edges()) {
    const bool is_spurious = edge.source == SampleSource::NorthIn;
    EXPECT_EQ(edge.rejected_by.has_value(), is_spurious);
    EXPECT_NEAR(edge.residual.value[0], is_spurious ? 0.01 : 0.0, 0.002);
    EXPECT_EQ(edge.nis > edge.limit, is_spurious);
  }
  EXPECT_EQ(filter.axis_icrf(), unharmed.axis_icrf());
  EXPECT_EQ(filter.axis_covariance_rad2(), unharmed.axis_covariance_rad2());
  EXPECT_EQ(filter.rate_rad_s(), unharmed.rate_rad_s());
}

TEST_F(SpinFilterTest, TheOrderOfTheEdgesHasNoWeight) {
  SpinFilter forward = about_the_axis(round_covariance(0.01));
  SpinFilter backward = forward;
  const GoodEdges good{pass_.config, seen_[1].revolution};
  std::vector<Pulse> edges{good.span().begin(), good.span().end()};
  forward.update(pass_.config, seen_[1].sky, edges);
  std::ranges::reverse(edges);
  backward.update(pass_.config, seen_[1].sky, edges);
  EXPECT_LT(angle_between_rad(forward.axis_icrf(), backward.axis_icrf()), 1e-9);
  EXPECT_TRUE(forward.axis_covariance_rad2().isApprox(backward.axis_covariance_rad2(), 1e-6));
}

/// Names axes where right ascension is singular or wraps, each with an orbit in which the Earth is
/// across the axis.
struct Place {
  const char* name;
  RaDec axis;
  double inclination_rad;
  double raan_rad;
};

class SpinFilterAt : public ::testing::TestWithParam<Place> {};

TEST_P(SpinFilterAt, AxisAndCovarianceAreAsGoodAsElsewhere) {
  const Place place = GetParam();
  const Orbit orbit{KeplerOrbit::make({.epoch = kTransferStart,
                                       .semi_major_axis_km = 20000.0,
                                       .eccentricity = 0.0,
                                       .inclination_rad = place.inclination_rad,
                                       .raan_rad = place.raan_rad,
                                       .argument_of_perigee_rad = 0.0,
                                       .mean_anomaly_rad = 0.0})
                        .value()};
  const auto around = seen_from(orbit);
  std::mt19937_64 rng{90};
  for (int trial = 0; trial < 10; ++trial) {
    const SpinningBody body{.axis_icrf = direction_icrf(place.axis),
                            .rate_rad_s = 2.0 * kPi,
                            .first_turn_rad = 0.6 * trial,
                            .config = usual_config()};
    const auto seen = observed(body.config, orbit,
                               noisy_pulses(body, edges_between(body, around, 0.0, 30.0), rng));
    const SpinFix fix = drawn_fix(body.axis_icrf, 0.5 * kRadPerDeg, rng);
    SpinFilter filter = SpinFilter::about(fix.axis_icrf, fix.covariance_rad2, body.config,
                                          seen[0].revolution, seen[0].sky)
                            .value();
    for (std::size_t i = 1; i < seen.size(); ++i) {
      for (const Observation& edge : work_in(filter, body.config, seen[i]).edges()) {
        EXPECT_FALSE(edge.rejected_by);
      }
    }
    EXPECT_LT(squared_error(filter, body.axis_icrf), kOneInTenThousand) << "trial " << trial;
    EXPECT_LT(sigma_deg(filter), 0.15);
  }
}

INSTANTIATE_TEST_SUITE_P(
    Places, SpinFilterAt,
    ::testing::Values(Place{"NorthPole", {.ra_rad = 0.0, .dec_rad = 0.5 * kPi}, 0.01, 0.3},
                      Place{"SouthPole", {.ra_rad = 0.0, .dec_rad = -0.5 * kPi}, 0.01, 0.3},
                      Place{"NearThePole", {.ra_rad = 2.0, .dec_rad = 1.5705}, 0.01, 0.3},
                      Place{"RightAscensionZero", {.ra_rad = 0.0, .dec_rad = 0.1}, 1.5, 0.5 * kPi},
                      Place{"JustBelowZero", {.ra_rad = -1e-4, .dec_rad = -0.3}, 1.5, 0.5 * kPi}),
    [](const auto& place) { return place.param.name; });

}  // namespace spindrift::testing::spin_filter_test
