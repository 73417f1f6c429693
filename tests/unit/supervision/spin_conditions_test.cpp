#include "pipelines/supervision/spin_conditions.h"

#include <optional>
#include <set>
#include <string>

#include "pipelines/ephemeris/kepler_orbit.h"
#include "pipelines/frames/angle.h"
#include "tests/support/matchers.h"

namespace spindrift::spin_conditions_test {

using enum PulseChannel;

const TaiTime kStart = tai_from_ns(1'795'143'637'000'000'000);
TaiTime at(double t_s) { return shifted(kStart, t_s); }

const Eigen::Vector3d kAxis = Eigen::Vector3d::UnitZ();

SpinConfig config() {
  return {.sun_sensor = {.slit_cant_rad = 0.5, .slit_separation_rad = 0.5},
          .north = InfraredSensor{.mount_angle_rad = 85.0 * kRadPerDeg, .azimuth_rad = 0.0},
          .south = std::nullopt,
          .noise = {.sun_s = 1e-4, .infrared_s = 1e-4},
          .horizon = {.model = HorizonModel::Sphere, .co2_altitude_km = 40.0},
          .screening = {},
          .geometry = {},
          .prior = std::nullopt};
}

/// Returns an equatorial orbit 10,000 km from the Earth's centre, with the Earth 90 deg from the
/// axis.
Orbit orbit() {
  return Orbit{KeplerOrbit::through(kStart, {.position_icrf_km = {1e4, 0.0, 0.0},
                                             .velocity_icrf_km_s = {0.0, 6.3, 0.0}})
                   .value()};
}

SpinEstimate estimate(double t_s, Quality quality, double sigma_deg = 0.05, double off_deg = 0.0,
                      SpinEstimator estimator = SpinEstimator::Sequential) {
  const double sigma_rad = sigma_deg * kRadPerDeg;
  return {.t = at(t_s),
          .estimator = estimator,
          .axis_icrf = Eigen::AngleAxisd{off_deg * kRadPerDeg, Eigen::Vector3d::UnitX()} * kAxis,
          .covariance_rad2 = 0.5 * sigma_rad * sigma_rad * Eigen::Matrix2d::Identity(),
          .spin_rate_rad_s = 6.0,
          .spin_rate_sigma_rad_s = 1e-5,
          .assessment = {.quality = quality}};
}

SpinTarget target_at(double rate_rad_s) {
  return {.axis_icrf = kAxis,
          .rate = SpinTarget::Rate{.rad_s = rate_rad_s, .tolerance_rad_s = 0.1}};
}

/// Collects the keys that are raised and not cleared.
struct Supervised {
  SpinConditions conditions;
  std::set<std::string> raised = {};

  explicit Supervised(const std::optional<SpinTarget>& target = std::nullopt,
                      const SpinConfig& mission = config())
      : conditions{mission, orbit(), AlertLimits{}, target} {}

  template <class Product>
  void evaluate(const Product& product) {
    note(conditions.evaluate(product));
  }
  void settle() { note(conditions.settle()); }

  void note(const ConditionChanges& changes) {
    for (const ConditionChange& change : changes) {
      const std::string key = alert_key(change.code, change.about);
      if (change.change == Change::Raised) {
        raised.insert(key);
      } else if (change.change == Change::Cleared) {
        raised.erase(key);
      }
    }
  }
};

using Keys = std::set<std::string>;

/// @return The keys that are raised then.
const Keys& give_estimates(Supervised& pass, Quality quality, double sigma_deg, double off_deg,
                           double from_s, double to_s) {
  for (double t_s = from_s; t_s < to_s; t_s += 1.0) {
    pass.evaluate(estimate(t_s, quality, sigma_deg, off_deg));
  }
  return pass.raised;
}

void give_period(Supervised& pass, std::int64_t revolution,
                 std::optional<Rejection> rejected_by = std::nullopt) {
  pass.evaluate(RevolutionProduct{
      .revolution = revolution, .t_sun1 = at(static_cast<double>(revolution)), .period_s = 1.0});
  pass.evaluate(SpinMeasurement{.revolution = revolution,
                                .quantity = SpinQuantity::Period,
                                .value = 1.0,
                                .sigma = 1e-4,
                                .rejected_by = rejected_by});
}

/// Gives the edges of all channels of a turn except `silent`.
void give_edges(Supervised& pass, std::int64_t revolution, std::optional<PulseChannel> silent,
                std::optional<Rejection> rejected_by = std::nullopt) {
  for (const PulseChannel channel : {Sun1, Sun2, NorthIn, NorthOut}) {
    if (channel != silent) {
      const double t_s =
          static_cast<double>(revolution) + 0.1 * static_cast<double>(index_of(channel));
      pass.evaluate(PulseUse{.pulse = {.t = at(t_s), .channel = channel},
                             .revolution = revolution,
                             .rejected_by = rejected_by});
    }
  }
}

const Keys& give_turns(Supervised& pass, int from, int to,
                       std::optional<PulseChannel> silent = {}) {
  for (int revolution = from; revolution < to; ++revolution) {
    give_edges(pass, revolution, silent);
  }
  return pass.raised;
}

/// Gives an answer that says nothing of the axis, every half minute.
void give_answer(Supervised& pass, int revolution) {
  if (revolution % 30 == 29) {
    pass.evaluate(
        estimate(revolution, revolution % 60 == 29 ? Quality::Doubtful : Quality::Ambiguous));
  }
}

class SpinConditionsTest : public ::testing::Test {
 protected:
  Supervised pass_;
};

TEST_F(SpinConditionsTest, RaiseNothingOfANominalPass) {
  Supervised pass{target_at(6.0)};
  give_estimates(pass, Quality::Converging, 2.0, 0.0, 0.0, 30.0);
  give_estimates(pass, Quality::Ok, 0.05, 0.0, 30.0, 300.0);
  for (int revolution = 0; revolution < 300; ++revolution) {
    give_edges(pass, revolution, std::nullopt);
    give_period(pass, revolution);
  }
  EXPECT_EQ(pass.raised, Keys{});
}

TEST_F(SpinConditionsTest, RaiseAQualityThatIsHeldAndClearIt) {
  EXPECT_EQ(give_estimates(pass_, Quality::Ambiguous, 0.05, 0.0, 0.0, 60.0), Keys{});
  EXPECT_EQ(give_estimates(pass_, Quality::Ambiguous, 0.05, 0.0, 60.0, 70.0),
            Keys{"spin.ambiguous"});
  EXPECT_EQ(give_estimates(pass_, Quality::Doubtful, 0.05, 0.0, 70.0, 140.0),
            Keys{"spin.doubtful"});
  pass_.evaluate(estimate(141.0, Quality::Lost));
  EXPECT_EQ(pass_.raised, (Keys{"attitude.lost", "spin.doubtful"}));
}

TEST_F(SpinConditionsTest, RaiseASigmaThatIsWideTwoMinutesAfterTheFirstAnswer) {
  EXPECT_EQ(give_estimates(pass_, Quality::Ok, 1.5, 0.0, 0.0, 120.0), Keys{});
  EXPECT_EQ(give_estimates(pass_, Quality::Ok, 1.5, 0.0, 120.0, 122.0), Keys{"spin.sigma"});
}

TEST_F(SpinConditionsTest, RaiseNoWideSigmaForTwoMinutesAfterAManoeuvre) {
  give_estimates(pass_, Quality::Ok, 0.05, 0.0, 0.0, 300.0);
  pass_.conditions.note_manoeuvre(at(310.0));
  EXPECT_EQ(give_estimates(pass_, Quality::Converging, 1.5, 0.0, 312.0, 432.0), Keys{});
  EXPECT_EQ(give_estimates(pass_, Quality::Ok, 1.5, 0.0, 432.0, 434.0), Keys{"spin.sigma"});
}

TEST_F(SpinConditionsTest, RaiseAWideSigmaBeforeAManoeuvreThatIsToCome) {
  pass_.conditions.note_manoeuvre(at(310.0));
  EXPECT_EQ(give_estimates(pass_, Quality::Ok, 1.5, 0.0, 0.0, 122.0), Keys{"spin.sigma"});
}

TEST_F(SpinConditionsTest, RaiseAnAxisAndARateAwayFromTheirTarget) {
  Supervised pass{target_at(5.0)};
  EXPECT_EQ(give_estimates(pass, Quality::Ok, 0.1, 2.2, 0.0, 20.0), Keys{"spin.rate"});
  EXPECT_EQ(give_estimates(pass, Quality::Ok, 0.1, 2.4, 20.0, 40.0),
            (Keys{"spin.off_target", "spin.rate"}));
}

TEST_F(SpinConditionsTest, HoldTheAxisAgainstTheTargetThatAnOperatorSets) {
  pass_.conditions.set_target(at(20.0), Eigen::Vector3d::UnitX());
  give_estimates(pass_, Quality::Ok, 0.1, 0.0, 0.0, 20.0);
  EXPECT_FALSE(pass_.conditions.target());
  EXPECT_EQ(give_estimates(pass_, Quality::Ok, 0.1, 0.0, 20.0, 40.0), Keys{"spin.off_target"});
  pass_.conditions.set_target(at(0.0), kAxis);
  EXPECT_EQ(give_estimates(pass_, Quality::Ok, 0.1, 0.0, 40.0, 60.0), Keys{});
}

TEST_F(SpinConditionsTest, RaiseThatTheEstimatorsDiffer) {
  for (double t_s = 0.0; t_s < 20.0; t_s += 1.0) {
    pass_.evaluate(estimate(t_s, Quality::Ok));
    pass_.evaluate(estimate(t_s + 0.5, Quality::Ok, 0.05, 0.3, SpinEstimator::Mean));
  }
  EXPECT_EQ(pass_.raised, Keys{"spin.disagree"});
}

TEST_F(SpinConditionsTest, RaiseNothingOfASequentialThatBatchOverrules) {
  for (double t_s = 0.0; t_s < 120.0; t_s += 1.0) {
    if (t_s == 5.0 || t_s == 65.0) {
      pass_.evaluate(estimate(t_s, Quality::Ok, 0.02, 0.0, SpinEstimator::Batch));
    }
    pass_.evaluate(estimate(t_s, Quality::Doubtful, 0.01));
  }
  EXPECT_EQ(pass_.raised, Keys{});
  // The solutions by batch stop.
  EXPECT_EQ(give_estimates(pass_, Quality::Doubtful, 0.01, 0.0, 120.0, 240.0),
            Keys{"spin.doubtful"});
}

TEST_F(SpinConditionsTest, AreSettledByTheFinalAnswer) {
  give_estimates(pass_, Quality::Doubtful, 2.0, 0.0, 0.0, 200.0);
  EXPECT_EQ(pass_.raised, (Keys{"spin.doubtful", "spin.sigma"}));
  pass_.evaluate(estimate(199.0, Quality::Ok, 0.9, 0.0, SpinEstimator::Batch));
  pass_.settle();
  EXPECT_EQ(pass_.raised, Keys{});

  Supervised ambiguous;
  give_estimates(ambiguous, Quality::Ok, 0.1, 0.0, 0.0, 10.0);
  EXPECT_EQ(give_estimates(ambiguous, Quality::Ambiguous, 0.1, 0.0, 10.0, 20.0), Keys{});
  ambiguous.settle();
  EXPECT_EQ(ambiguous.raised, Keys{"spin.ambiguous"});

  Supervised apart;
  give_estimates(apart, Quality::Ok, 0.1, 0.0, 0.0, 10.0);
  apart.evaluate(estimate(9.0, Quality::Ok, 0.1, 0.6, SpinEstimator::Batch));
  EXPECT_EQ(apart.raised, Keys{});
  apart.settle();
  EXPECT_EQ(apart.raised, (Keys{"spin.disagree", "spin.doubtful"}));
}

TEST_F(SpinConditionsTest, SettleThatNoAnswerCameByTheSolutionOfTheWholePass) {
  for (int revolution = 0; revolution <= 60; ++revolution) {
    give_edges(pass_, revolution, std::nullopt, {});
  }
  EXPECT_TRUE(pass_.raised.contains("spin.no_answer"));
  pass_.evaluate(estimate(60.5, Quality::Doubtful, 0.1, 0.0, SpinEstimator::Batch));
  pass_.settle();
  EXPECT_FALSE(pass_.raised.contains("spin.no_answer"));
}

TEST_F(SpinConditionsTest, SettleAChannelThatIsDeadFromTheStartByTheSolutionOfTheWholePass) {
  EXPECT_EQ(give_turns(pass_, 0, 30, NorthOut), Keys{});
  pass_.evaluate(estimate(29.5, Quality::Ok, 0.1, 0.0, SpinEstimator::Batch));
  EXPECT_EQ(pass_.raised, Keys{});
  pass_.settle();
  EXPECT_EQ(pass_.raised, Keys{"channel.silent:north_out"});

  Supervised out_of_view;
  give_turns(out_of_view, 0, 30, NorthOut);
  SpinEstimate away = estimate(29.5, Quality::Ok, 0.1, 0.0, SpinEstimator::Batch);
  away.axis_icrf = Eigen::AngleAxisd{70.0 * kRadPerDeg, Eigen::Vector3d::UnitY()} * kAxis;
  out_of_view.evaluate(away);
  out_of_view.settle();
  EXPECT_EQ(out_of_view.raised, Keys{});
}

TEST_F(SpinConditionsTest, SettleAContradictionOfSensors) {
  pass_.evaluate(SensorsCompared{.t = at(0.0),
                                 .contradiction = SensorContradiction{.culprit = SampleSource::Sun2,
                                                                      .with = {SampleSource::Sun1},
                                                                      .off = {"angle_deg", 2.0},
                                                                      .sigmas = 208.0,
                                                                      .since = at(0.0)}});
  EXPECT_EQ(pass_.raised, Keys{"sensor.contradicts:sun2"});
  pass_.evaluate(SensorsCompared{.t = at(15.0), .contradiction = {}});
  EXPECT_EQ(pass_.raised, Keys{"sensor.contradicts:sun2"});
  pass_.settle();
  EXPECT_EQ(pass_.raised, Keys{});
}

TEST_F(SpinConditionsTest, RaiseThatNoAnswerComesOfUsableEdges) {
  for (const auto rejected_by :
       {std::optional{Rejection::Unassociated}, std::optional<Rejection>{}}) {
    Supervised pass;
    for (int revolution = 0; revolution < 59; ++revolution) {
      give_edges(pass, revolution, std::nullopt, rejected_by);
    }
    EXPECT_FALSE(pass.raised.contains("spin.no_answer"));
    give_edges(pass, 60, std::nullopt, rejected_by);
    EXPECT_TRUE(pass.raised.contains("spin.no_answer"));
    pass.evaluate(estimate(61.0, Quality::Ambiguous));
    give_edges(pass, 61, std::nullopt, rejected_by);
    EXPECT_FALSE(pass.raised.contains("spin.no_answer"));
  }
  Supervised late;
  for (int revolution = 0; revolution < 100; ++revolution) {
    give_edges(late, revolution, std::nullopt, Rejection::OutOfTime);
  }
  EXPECT_FALSE(late.raised.contains("spin.no_answer"));
}

TEST_F(SpinConditionsTest, RaiseAChannelThatTheAxisInForceShouldSee) {
  pass_.evaluate(estimate(0.0, Quality::Ok));
  give_turns(pass_, 0, 20);
  EXPECT_EQ(give_turns(pass_, 20, 29, NorthIn), Keys{});
  give_edges(pass_, 29, NorthIn);
  EXPECT_EQ(pass_.raised, Keys{"channel.silent:north_in"});
  give_edges(pass_, 30, std::nullopt);
  EXPECT_EQ(pass_.raised, Keys{});
}

TEST_F(SpinConditionsTest, RaiseAChannelThatIsDeadFromTheStart) {
  for (const PulseChannel dead : {Sun2, NorthOut}) {
    Supervised pass;
    EXPECT_EQ(give_turns(pass, 0, 30, dead), Keys{}) << "no axis yet";
    pass.evaluate(estimate(30.0, Quality::Ok));
    EXPECT_EQ(give_turns(pass, 30, 42, dead),
              Keys{"channel.silent:" + std::string{kPulseChannelNames.at(index_of(dead))}});
  }
}

TEST_F(SpinConditionsTest, RaiseADeadSlit1WithoutAnAxisWhereSlit2SeesTheSun) {
  EXPECT_EQ(give_turns(pass_, 0, 10, Sun1), Keys{});
  EXPECT_EQ(give_turns(pass_, 10, 12, Sun1), Keys{"channel.silent:sun1"});
}

TEST_F(SpinConditionsTest, ExpectABeamThatHasNeverComeWhateverTheMissionSaysOfItsHealth) {
  for (const bool healthy : {false, true}) {
    SpinConfig mission = config();
    mission.south = InfraredSensor{
        .mount_angle_rad = 95.0 * kRadPerDeg, .azimuth_rad = 0.1, .healthy = healthy};
    Supervised pass{std::nullopt, mission};
    pass.evaluate(estimate(0.0, Quality::Ok));
    EXPECT_EQ(give_turns(pass, 0, 30),
              Keys({"channel.silent:south_in", "channel.silent:south_out"}))
        << healthy;
  }
}

/// The other axis is 70 deg off, where the beam misses the Earth.
TEST_F(SpinConditionsTest, ExpectWithoutAnAnswerWhatTheAxesOfTheLastFixMustSee) {
  SpinFix fix{.revolution = 0,
              .t = at(0.0),
              .geometry_case = 2,
              .axis_icrf = kAxis,
              .covariance_rad2 = 1e-6 * Eigen::Matrix2d::Identity(),
              .alternates = {{.axis_icrf = kAxis}},
              .resolution = Resolution::Ambiguous,
              .norm = 1.0,
              .accepted = false};
  const auto silent_of = [](const SpinFix& last, PulseChannel dead) {
    Supervised pass;
    pass.evaluate(last);
    return give_turns(pass, 0, 30, dead);
  };
  EXPECT_EQ(silent_of(fix, NorthOut), Keys{"channel.silent:north_out"});
  fix.alternates.front().axis_icrf =
      Eigen::AngleAxisd{70.0 * kRadPerDeg, Eigen::Vector3d::UnitY()} * kAxis;
  EXPECT_EQ(silent_of(fix, NorthOut), Keys{"channel.silent:north_out"})
      << "the other end of the chord comes, so the other axis is not the true one";
  fix.near_tangent = true;
  EXPECT_EQ(silent_of(fix, NorthOut), Keys{}) << "the true axis may be missing";

  Supervised doubted;
  fix.near_tangent = false;
  doubted.evaluate(fix);
  doubted.evaluate(estimate(0.0, Quality::Doubtful));
  EXPECT_EQ(give_turns(doubted, 0, 29, NorthOut), Keys{});
}

/// Slit 2 ends 46 deg from the axis; the Sun is 32 or 110 deg from the axis.
TEST_F(SpinConditionsTest, ExpectNoSunBehindTheEndOfASlit) {
  for (const double off_deg : {113.0, 0.0}) {
    SpinConfig mission = config();
    mission.sun_sensor.slit_cant_rad = 0.8;
    Supervised pass{std::nullopt, mission};
    pass.evaluate(estimate(0.0, Quality::Ok, 0.05, off_deg));
    EXPECT_EQ(give_turns(pass, 0, 40, Sun2), off_deg > 0.0 ? Keys{} : Keys{"channel.silent:sun2"});
  }
}

TEST_F(SpinConditionsTest, GiveABeamThatComesIntoViewItsRevolutions) {
  pass_.evaluate(estimate(0.0, Quality::Ok));
  give_turns(pass_, 0, 20);
  SpinEstimate away = estimate(20.0, Quality::Ok);
  away.axis_icrf = Eigen::AngleAxisd{70.0 * kRadPerDeg, Eigen::Vector3d::UnitY()} * kAxis;
  pass_.evaluate(away);
  give_turns(pass_, 20, 55, NorthIn);
  pass_.evaluate(estimate(55.0, Quality::Ok));
  for (int revolution = 55; revolution < 64; ++revolution) {
    give_edges(pass_, revolution, NorthIn);
    EXPECT_EQ(pass_.raised, Keys{}) << revolution;
  }
  EXPECT_EQ(give_turns(pass_, 64, 80, NorthIn), Keys{"channel.silent:north_in"});
}

TEST_F(SpinConditionsTest, ExpectNoEdgesOfABeamThatMissesTheEarth) {
  pass_.evaluate(estimate(0.0, Quality::Ok, 0.05, 70.0));
  give_turns(pass_, 0, 20);
  // From a quarter of the orbit on the Earth is 20 deg from that axis.
  pass_.evaluate(estimate(2300.0, Quality::Ok, 0.05, 70.0));
  EXPECT_EQ(give_turns(pass_, 2300, 2350, NorthIn), Keys{});
}

TEST_F(SpinConditionsTest, RaiseSharesOfTheLastHundredRevolutions) {
  for (int revolution = 0; revolution < 110; ++revolution) {
    const bool is_bad = revolution % 4 == 0;
    give_edges(pass_, revolution, std::nullopt,
               is_bad ? std::optional{Rejection::Phase} : std::nullopt);
    give_period(pass_, revolution, is_bad ? std::optional{Rejection::Period} : std::nullopt);
    give_answer(pass_, revolution);
  }
  EXPECT_EQ(pass_.raised, (Keys{"spin.period", "spin.rejection"}));
}

/// A turn without a usable sun1 edge has a period, which is refused, and no revolution.
TEST_F(SpinConditionsTest, CountPeriodsOfTurnsWhoseSunEdgeIsRefused) {
  for (int revolution = 0; revolution < 120; ++revolution) {
    if (revolution % 2 == 0) {
      give_period(pass_, revolution);
    } else {
      pass_.evaluate(SpinMeasurement{.revolution = revolution,
                                     .quantity = SpinQuantity::Period,
                                     .value = 1.0,
                                     .sigma = 1e-4,
                                     .rejected_by = Rejection::Phase});
    }
  }
  EXPECT_EQ(pass_.raised, Keys{"spin.period"});
}

PulseUse left_over(double t_s, PulseChannel channel, Rejection rejection) {
  return {.pulse = {.t = at(t_s), .channel = channel}, .revolution = {}, .rejected_by = rejection};
}

TEST_F(SpinConditionsTest, CountEdgesThatFoundNoRevolution) {
  for (const Rejection rejection : {Rejection::Unassociated, Rejection::Copy, Rejection::Late}) {
    Supervised copied;
    Supervised without_axis;
    for (int revolution = 0; revolution < 110; ++revolution) {
      give_edges(copied, revolution, std::nullopt);
      copied.evaluate(left_over(revolution + 0.005, Sun1, rejection));
      copied.evaluate(left_over(revolution + 0.005, Sun2, rejection));
      for (const PulseChannel channel : {Sun1, Sun2, NorthIn, NorthOut, SouthIn, SouthOut}) {
        without_axis.evaluate(left_over(revolution + 0.005, channel, rejection));
      }
      give_answer(copied, revolution);
      give_answer(without_axis, revolution);
    }
    EXPECT_EQ(copied.raised, Keys{"spin.rejection"});
    EXPECT_EQ(without_axis.raised, Keys{"spin.rejection"});
  }
  Supervised by_operator;
  for (int revolution = 0; revolution < 110; ++revolution) {
    give_edges(by_operator, revolution, Sun1);
    by_operator.evaluate(left_over(revolution + 0.005, Sun1, Rejection::Operator));
    give_answer(by_operator, revolution);
  }
  EXPECT_EQ(by_operator.raised, Keys{});
}

/// Ten copies of one channel are five turns, not ten.
TEST_F(SpinConditionsTest, TakeACopyForNoEdge) {
  pass_.evaluate(estimate(0.0, Quality::Ok));
  for (int revolution = 0; revolution < 30; ++revolution) {
    give_edges(pass_, revolution, revolution < 20 ? std::nullopt : std::optional{NorthIn});
    if (revolution >= 28) {
      EXPECT_EQ(pass_.raised.contains("channel.silent:north_in"), revolution == 29);
    }
    pass_.evaluate(left_over(revolution + 0.5, Sun1, Rejection::Copy));
  }
}

BatchSolution solution(double t_s, std::optional<double> half_angle_deg) {
  BatchSolution solution{};
  solution.estimate.t = at(t_s);
  solution.nutation.emplace();
  if (half_angle_deg) {
    solution.nutation->found.emplace().half_angle_rad = {.value = *half_angle_deg * kRadPerDeg,
                                                         .sigma = 0.002 * kRadPerDeg};
  }
  return solution;
}

TEST_F(SpinConditionsTest, RaiseANutationThatIsWideOrGrows) {
  pass_.evaluate(solution(0.0, std::nullopt));
  pass_.evaluate(solution(60.0, 0.1));
  pass_.evaluate(solution(120.0, 0.11));
  EXPECT_EQ(pass_.raised, Keys{});
  pass_.evaluate(solution(180.0, 0.12));
  EXPECT_EQ(pass_.raised, Keys{"spin.nutation"});
  pass_.evaluate(solution(240.0, 0.1));
  EXPECT_EQ(pass_.raised, Keys{});
  pass_.evaluate(solution(300.0, 0.6));
  EXPECT_EQ(pass_.raised, Keys{"spin.nutation"});
}

TEST_F(SpinConditionsTest, GiveARateInRpm) {
  SpinConditions conditions{config(), orbit(), AlertLimits{}, target_at(5.0)};
  std::optional<ConditionChange> raised;
  for (int t_s = 0; t_s < 20; ++t_s) {
    for (const ConditionChange& change : conditions.evaluate(estimate(t_s, Quality::Ok))) {
      raised = change.change == Change::Raised ? std::optional{change} : raised;
    }
  }
  ASSERT_TRUE(raised);
  EXPECT_EQ(raised->code, AlertCode::SpinRate);
  EXPECT_EQ(raised->evidence.unit, "rpm");
  EXPECT_NEAR(raised->evidence.value, 9.5493, 1e-4);
  EXPECT_NEAR(raised->evidence.limit, 0.95493, 1e-5);
}

TEST_F(SpinConditionsTest, RaiseInterferenceWhileItLasts) {
  give_edges(pass_, 0, std::nullopt, Rejection::Interference);
  EXPECT_EQ(pass_.raised, Keys{"spin.interference"});
  give_answer(pass_, 29);
  EXPECT_EQ(give_turns(pass_, 1, 70), Keys{});
}

}  // namespace spindrift::spin_conditions_test
