#include "pipelines/spin/sequential/sequential.h"

#include <algorithm>
#include <functional>
#include <random>
#include <string>
#include <vector>

#include "pipelines/frames/angle.h"
#include "services/base/assessment_words.h"
#include "tests/support/assessed.h"
#include "tests/support/matchers.h"
#include "tests/support/recorded_pass.h"
#include "tests/support/sequential_scene.h"

namespace spindrift::testing::sequential_test {

/// Returns what is said after so many revolutions of which no edge was gated.
Assessment ok_after(std::size_t revolutions) {
  return {Quality::Ok,
          {{ReasonCode::Revolutions, {{"count", static_cast<std::int64_t>(revolutions)}}},
           {ReasonCode::EdgesGated, {{"count", std::int64_t{0}}}}}};
}

struct Goal {
  std::string pass;
  HorizonModel horizon;
  double error_deg;
  double error_sigmas;
};

class Recorded : public ::testing::TestWithParam<Goal> {};

TEST_P(Recorded, TheAxisIsFound) {
  auto pass = recorded_pass(GetParam().pass);
  pass.config.horizon.model = GetParam().horizon;
  const auto seen = observed(pass.config, pass.orbit, pass.pulses);
  std::mt19937_64 rng{3};
  const auto all =
      estimates(pass.config, seen, at_first(drawn_fix(pass.true_axis_icrf, kFixSigma_rad, rng)));
  ASSERT_EQ(all.size(), seen.size());
  const SpinEstimate& last = all.back();
  EXPECT_LT(error_deg(last, pass.true_axis_icrf), GetParam().error_deg);
  EXPECT_LT(error_deg(last, pass.true_axis_icrf), GetParam().error_sigmas * sigma_deg(last));
  EXPECT_NEAR(last.spin_rate_rad_s, pass.true_rate_rad_s, 3.0 * last.spin_rate_sigma_rad_s);
  EXPECT_EQ(last.t, seen.back().revolution.edge(PulseChannel::Sun1));
  EXPECT_EQ(last.assessment, ok_after(seen.size() - 1));
}

INSTANTIATE_TEST_SUITE_P(Passes, Recorded,
                         ::testing::Values(Goal{"nominal", HorizonModel::Sphere, 0.05, 3.0},
                                           Goal{"north-only", HorizonModel::Sphere, 0.1, 3.0},
                                           Goal{"gms5", HorizonModel::Ellipsoid, 0.01, 3.0}),
                         [](const auto& goal) {
                           return goal.param.pass == "north-only" ? "north_only" : goal.param.pass;
                         });

TEST_F(SequentialOnAScene, SaysNothingBeforeAFixThatCanStartIt) {
  const auto seen = scene.seen(0.0, 15.0);
  const auto no_fix = [](std::size_t) { return std::vector<SpinFix>{}; };
  SpinFix contradictory = scene.fix();
  contradictory.accepted = false;
  SpinFix poor = scene.fix();
  poor.covariance_rad2 = Eigen::Matrix2d::Identity();
  EXPECT_THAT(estimates(scene.body.config, seen, no_fix), IsEmpty());
  EXPECT_THAT(estimates(scene.body.config, seen, at_first(contradictory)), IsEmpty());
  EXPECT_THAT(estimates(scene.body.config, seen, at_first(poor)), IsEmpty());
}

enum class Restart { None, ByFixes, Any };

/// Describes fixes of which some are false or poor, and what becomes of the axis in force.
struct FixScene {
  const char* name;
  bool with_sun;
  double to_s;
  double false_deg;  ///< How far the false fix is turned about the direction of the Earth.
  std::function<SpinFix(Scene& scene, const SpinFix& wrong, std::size_t i)> fix;
  Restart restart;
  std::size_t still_off_at = 0;  ///< The axis is still false after this many estimates,
  double still_off_deg = 0.0;    ///< by at least this angle.
};

SpinFix poor_fix(Scene& scene) {
  return drawn_fix(scene.body.axis_icrf, 8.0 * kRadPerDeg, scene.rng);
}

class FixesThatAreFalseOrPoor : public ::testing::TestWithParam<FixScene> {};

TEST_P(FixesThatAreFalseOrPoor, DoWhatTheyMay) {
  const FixScene& param = GetParam();
  Scene scene;
  const auto seen =
      param.with_sun ? scene.seen(0.0, param.to_s) : without_sun(scene.seen(0.0, param.to_s));
  const SpinFix wrong = param.false_deg > 0.0 ? scene.false_fix(param.false_deg) : SpinFix{};
  const auto all = estimates(scene.body.config, seen, [&](std::size_t i) {
    return std::vector{param.fix(scene, wrong, i)};
  });
  const SpinEstimate& last = all.back();
  EXPECT_TRUE(is_unopposed(last.assessment.quality));
  EXPECT_EQ(restarted(last.assessment), param.restart != Restart::None);
  EXPECT_TRUE(param.restart != Restart::ByFixes ||
              has(last.assessment, ReasonCode::RestartedByFixes));
  EXPECT_LT(squared_error(last, scene.body.axis_icrf), kOneInTenThousand);
  EXPECT_TRUE(!param.with_sun || sigma_deg(last) < 0.1) << sigma_deg(last);
  EXPECT_GE(error_deg(all.at(param.still_off_at), scene.body.axis_icrf), param.still_off_deg);
}

SpinFix false_at_first(Scene& scene, const SpinFix& wrong, std::size_t i) {
  return i == 0 ? wrong : scene.fix();
}

const std::vector<FixScene> kFixScenes = {
    // Each fix has a sigma of 8 deg and contradicts nothing by itself;
    // without the Sun no edge does.
    {"TogetherTurnItAwayThoughPoor", false, 200.0, 40.0,
     [](Scene& scene, const SpinFix& wrong, std::size_t i) {
       return i == 0 ? wrong : poor_fix(scene);
     },
     Restart::ByFixes, 20, 30.0},
    {"AgreeWithItThoughPoor", true, 200.0, 0.0,
     [](Scene& scene, const SpinFix&, std::size_t i) {
       return i == 0 ? scene.fix() : poor_fix(scene);
     },
     Restart::None},
    // The first fix is false; those of the following revolutions are true.
    {"BeginWithOneThatMostEdgesContradict", true, 60.0, 6.0, false_at_first, Restart::Any},
    // Without the Sun, the edges do not separate the axes on a cone about
    // the Earth; only fixes do.
    {"ContradictAnAxisThatTheEdgesBear", false, 60.0, 12.0, false_at_first, Restart::ByFixes, 5,
     10.0},
    {"AreFalseInOneOfThree", true, 60.0, 12.0,
     [](Scene& scene, const SpinFix& wrong, std::size_t i) {
       return i % 3 == 2 ? wrong : scene.fix();
     },
     Restart::None},
    {"AreBiasedWhereEdgesFit", true, 60.0, 0.0,
     [](Scene& scene, const SpinFix&, std::size_t i) {
       return i >= 10 && i < 30 ? scene.false_fix(6.0) : scene.fix();
     },
     Restart::None}};

INSTANTIATE_TEST_SUITE_P(Sequential, FixesThatAreFalseOrPoor, ::testing::ValuesIn(kFixScenes),
                         [](const auto& scene) { return scene.param.name; });

TEST_F(SequentialOnAScene, ManyPoorFixesStartItAsOneGoodOneDoes) {
  constexpr double kPoor_rad = 5.0 * kRadPerDeg;
  const auto seen = scene.seen(0.0, 60.0);
  const auto all = estimates(scene.body.config, seen, [&](std::size_t) {
    return std::vector{drawn_fix(scene.body.axis_icrf, kPoor_rad, scene.rng)};
  });
  // A fix has 5 deg in either direction, and their mean is below 3 deg from the sixth on.
  EXPECT_EQ(all.size(), seen.size() - 5);
  EXPECT_TRUE(is_unopposed(all.back().assessment.quality));
  EXPECT_FALSE(restarted(all.back().assessment));
  EXPECT_LT(squared_error(all.back(), scene.body.axis_icrf), kOneInTenThousand);
}

TEST_F(SequentialOnAScene, ARevolutionWithoutEdgesChangesNothingButTheTime) {
  auto seen = scene.seen(0.0, 20.0);
  seen.back().revolution.edges = {};
  const auto all = estimates(scene.body.config, seen, at_first(scene.fix()));
  const SpinEstimate& before = all[all.size() - 2];
  EXPECT_EQ(all.back().axis_icrf, before.axis_icrf);
  EXPECT_EQ(all.back().t, seen.back().sky.t);
  EXPECT_NEAR(sigma_deg(all.back()), sigma_deg(before), 1e-4 * sigma_deg(before));
}

TEST_F(SequentialOnAScene, DoubtfulEdgesAreNotUsed) {
  auto seen = scene.seen(0.0, 20.0);
  auto& doubtful = seen.back().revolution;
  auto& north_in = doubtful.edges.at(index_of(PulseChannel::NorthIn));
  north_in = shifted(*north_in, 0.1);
  doubtful.edge_rejections.at(index_of(PulseChannel::NorthIn)) = Rejection::Phase;
  const SpinEstimate last = estimates(scene.body.config, seen, at_first(scene.fix())).back();
  EXPECT_EQ(number_of(last.assessment.reasons, ReasonCode::EdgesGated, "count"), 0.0);
}

TEST_F(SequentialOnAScene, FollowsAManoeuvre) {
  auto seen = scene.seen(0.0, 40.0);
  scene.body.axis_icrf = scene.turned_about_earth(8.0);
  const auto after = scene.seen(40.0, 90.0);
  const std::size_t turned = seen.size();
  seen.insert(seen.end(), after.begin(), after.end());
  const Eigen::Vector3d old_axis = scene.turned_about_earth(-8.0);
  const auto all = estimates(scene.body.config, seen, [&](std::size_t i) {
    return std::vector{
        drawn_fix(i < turned ? old_axis : scene.body.axis_icrf, kFixSigma_rad, scene.rng)};
  });
  EXPECT_LT(squared_error(all[turned - 1], old_axis), kOneInTenThousand);
  EXPECT_TRUE(std::ranges::any_of(all, [](const SpinEstimate& estimate) {
    return estimate.assessment.quality == Quality::Lost;
  }));
  EXPECT_TRUE(has(all.back().assessment, ReasonCode::RestartedGated));
  EXPECT_LT(squared_error(all.back(), scene.body.axis_icrf), kOneInTenThousand);
}

TEST(Sequential, EdgesOfASensorThatTheMissionHasNotDoNotTouchIt) {
  auto pass = recorded_pass("nominal");
  pass.config.south.reset();
  const auto with_south = observed(pass.config, pass.orbit, pass.pulses);
  auto without_south = with_south;
  for (ObservedRevolution& seen : without_south) {
    seen.revolution.edges.at(index_of(PulseChannel::SouthIn)).reset();
    seen.revolution.edges.at(index_of(PulseChannel::SouthOut)).reset();
  }
  std::mt19937_64 rng{3};
  const Fixes fixes = at_first(drawn_fix(pass.true_axis_icrf, kFixSigma_rad, rng));
  const SpinEstimate with = estimates(pass.config, with_south, fixes).back();
  const SpinEstimate without = estimates(pass.config, without_south, fixes).back();
  EXPECT_TRUE(is_unopposed(with.assessment.quality));
  EXPECT_EQ(with.assessment, without.assessment);
  EXPECT_EQ(with.axis_icrf, without.axis_icrf);
  EXPECT_EQ(with.covariance_rad2, without.covariance_rad2);
}

TEST(Sequential, EdgesThatScatterMoreThanTheirNoiseAreDoubted) {
  for (const double times : {1.0, 2.0, 5.0}) {
    Scene scene;
    const auto seen = scene.seen_noisily(times, 120.0);
    const SpinEstimate last = estimates(scene.body.config, seen, at_first(scene.fix())).back();
    EXPECT_EQ(is_unopposed(last.assessment.quality), times == 1.0) << sentence_of(last.assessment);
    EXPECT_EQ(last.assessment.quality == Quality::Doubtful &&
                  last.assessment.reasons.front().code == ReasonCode::Noise,
              times > 1.0)
        << sentence_of(last.assessment);
    EXPECT_LT(squared_error(last, scene.body.axis_icrf), kOneInTenThousand) << times;
  }
}

/// Returns a fix with so much noise that single ones contradict any axis; one in ten is ambiguous.
SpinFix noisy_fix(Scene& scene, std::size_t i) {
  constexpr double kTimes = 5.0;
  SpinFix fix = scene.fix();
  fix.axis_icrf = drawn_fix(scene.body.axis_icrf, kTimes * kFixSigma_rad, scene.rng).axis_icrf;
  if (i % 10 == 9) {
    fix.alternates = {
        {.axis_icrf = scene.turned_about_earth(40.0), .covariance_rad2 = fix.covariance_rad2}};
    fix.resolution = Resolution::Prior;
  }
  return fix;
}

TEST_F(SequentialOnAScene, FixesThatScatterMoreThanTheyStateDoNotTurnItAway) {
  const auto seen = scene.seen_noisily(2.0, 300.0);
  const auto all = estimates(scene.body.config, seen, [&](std::size_t i) {
    return std::vector{i == 0 ? scene.fix() : noisy_fix(scene, i)};
  });
  for (const SpinEstimate& estimate : all) {
    EXPECT_NE(estimate.assessment.quality, Quality::Ambiguous);
  }
  const Assessment& last = all.back().assessment;
  EXPECT_EQ(last.quality, Quality::Doubtful);
  EXPECT_EQ(last.reasons.front().code, ReasonCode::Noise);
  EXPECT_EQ(number_of(last.reasons, ReasonCode::Revolutions, "count"),
            static_cast<double>(seen.size() - 1));
  EXPECT_LT(squared_error(all.back(), scene.body.axis_icrf), kOneInTenThousand);
}

TEST_F(SequentialOnAScene, AnAxisThatIsLostMayPointAnywhere) {
  const auto seen = scene.seen(0.0, 40.0);
  const SpinEstimate last =
      estimates(scene.body.config, seen, at_first(scene.false_fix(90.0))).back();
  EXPECT_EQ(last.assessment.quality, Quality::Lost);
  EXPECT_GT(sigma_deg(last), 90.0);
}

class Silence : public ::testing::TestWithParam<double> {};

TEST_P(Silence, TheFilterGoesOnAfterwards) {
  Scene scene;
  auto seen = scene.seen(0.0, 40.0);
  const auto after = scene.seen(40.0 + GetParam(), 80.0 + GetParam());
  seen.insert(seen.end(), after.begin(), after.end());
  const auto all = estimates(scene.body.config, seen, at_first(scene.fix()));
  EXPECT_EQ(all.back().assessment, ok_after(seen.size() - 1));
  EXPECT_LT(squared_error(all.back(), scene.body.axis_icrf), kOneInTenThousand);
  EXPECT_NEAR(all.back().spin_rate_rad_s, scene.body.rate_rad_s,
              3.0 * all.back().spin_rate_sigma_rad_s);
}

INSTANTIATE_TEST_SUITE_P(Seconds, Silence, ::testing::Values(60.0, 600.0, 18000.0));

TEST_F(SequentialOnAScene, FollowsARateThatDrifts) {
  // At 1e-6 rad/s^2 for 200 s, a constant rate would put the phase off by 0.02 rad, 30 sigmas of a
  // sun edge. Times are warped; the orbit and the Sun move slightly less.
  constexpr double kDrift_rad_s2 = 1e-6;
  constexpr double kDuration_s = 200.0;
  auto edges = edges_between(scene.body, scene.around, 0.0, kDuration_s);
  for (Edge& edge : edges) {
    edge.t_s -= 0.5 * kDrift_rad_s2 / scene.body.rate_rad_s * edge.t_s * edge.t_s;
  }
  const auto seen =
      observed(scene.body.config, scene.orbit, noisy_pulses(scene.body, edges, scene.rng));
  const SpinEstimate last = estimates(scene.body.config, seen, at_first(scene.fix())).back();
  EXPECT_EQ(number_of(last.assessment.reasons, ReasonCode::EdgesGated, "count"), 0.0);
  EXPECT_LT(squared_error(last, scene.body.axis_icrf), kOneInTenThousand);
  EXPECT_NEAR(last.spin_rate_rad_s, scene.body.rate_rad_s + kDrift_rad_s2 * kDuration_s,
              4.0 * last.spin_rate_sigma_rad_s);
}

TEST_F(SequentialOnAScene, SpuriousEdgesAreCountedAndDoNoHarm) {
  auto seen = scene.seen(0.0, 60.0);
  std::uniform_real_distribution<double> off_s{0.03, 0.1};
  int spoilt = 0;
  for (std::size_t i = 5; i < seen.size(); i += 2) {
    auto& edge = seen[i].revolution.edges.at(i % kPulseChannels);
    if (edge) {
      edge = shifted(*edge, off_s(scene.rng));
      ++spoilt;
    }
  }
  const auto all = estimates(scene.body.config, seen, at_first(scene.fix()));
  EXPECT_EQ(number_of(all.back().assessment.reasons, ReasonCode::EdgesGated, "count"),
            static_cast<double>(spoilt));
  EXPECT_LT(squared_error(all.back(), scene.body.axis_icrf), kOneInTenThousand);
}

}  // namespace spindrift::testing::sequential_test
