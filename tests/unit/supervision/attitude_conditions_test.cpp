#include "pipelines/supervision/attitude_conditions.h"

#include <algorithm>
#include <cstdint>
#include <optional>
#include <set>
#include <string>
#include <vector>

#include "pipelines/ephemeris/kepler_orbit.h"
#include "pipelines/ephemeris/sun.h"
#include "tests/support/matchers.h"

namespace spindrift::attitude_conditions_test {

TaiTime at(double t_s) { return shifted(tai_from_ns(1'795'143'637'000'000'000), t_s); }

AttitudeEstimate estimate(double t_s, Quality quality) {
  return {.t = at(t_s),
          .q_icrf_body = Eigen::Quaterniond::Identity(),
          .rate_body_rad_s = std::nullopt,
          .covariance_rad2 = 1e-8 * Eigen::Matrix3d::Identity(),
          .assessment = {.quality = quality}};
}

/// Matches one change of this kind.
auto only(Change change) { return ElementsAre(::testing::Field(&ConditionChange::change, change)); }

class AttitudeConditionsTest : public ::testing::Test {
 protected:
  AttitudeConditions conditions_{AlertLimits{}, std::nullopt};
};

/// Returns the changes of attitude.lost among the changes of an estimate.
ConditionChanges lost_by(AttitudeConditions& conditions, const AttitudeEstimate& estimate) {
  ConditionChanges changes = conditions.evaluate(estimate);
  std::erase_if(changes, [](const auto& one) { return one.code != AlertCode::AttitudeLost; });
  return changes;
}

TEST_F(AttitudeConditionsTest, ClearALostAttitudeWhenItHasBeenOkForTenSeconds) {
  EXPECT_THAT(lost_by(conditions_, estimate(0.0, Quality::Ok)), IsEmpty());
  EXPECT_THAT(lost_by(conditions_, estimate(10.0, Quality::Ok)), only(Change::Cleared));
  EXPECT_THAT(lost_by(conditions_, estimate(11.0, Quality::Lost)), only(Change::Raised));
  for (const Quality quality : {Quality::Converging, Quality::Doubtful}) {
    for (double t_s = 12.0; t_s < 40.0; t_s += 1.0) {
      EXPECT_THAT(lost_by(conditions_, estimate(t_s, quality)), IsEmpty());
    }
  }
  EXPECT_THAT(lost_by(conditions_, estimate(40.0, Quality::Ok)), IsEmpty());
  EXPECT_THAT(lost_by(conditions_, estimate(49.0, Quality::Doubtful)), IsEmpty());
  EXPECT_THAT(lost_by(conditions_, estimate(50.0, Quality::Ok)), IsEmpty());
  EXPECT_THAT(lost_by(conditions_, estimate(59.9, Quality::Ok)), IsEmpty());
  EXPECT_THAT(lost_by(conditions_, estimate(60.0, Quality::Ok)), only(Change::Cleared));
}

TEST_F(AttitudeConditionsTest, RaiseThatStarFixesOverruleTheAttitude) {
  AttitudeEstimate anew = estimate(1.0, Quality::Converging);
  anew.assessment.reasons = {{ReasonCode::Since, {{"since_tai_ns", tai_ns(anew.t)}}}};
  ASSERT_THAT(lost_by(conditions_, anew), only(Change::Raised));
  anew.t += std::chrono::seconds{1};
  EXPECT_THAT(lost_by(conditions_, anew), IsEmpty());
  EXPECT_THAT(lost_by(conditions_, estimate(3.0, Quality::Ok)), IsEmpty());
  EXPECT_THAT(lost_by(conditions_, estimate(13.0, Quality::Ok)), only(Change::Cleared));
}

ThreeAxisConfig commanded() {
  return {.gyro = {},
          .sun_sensor = {},
          .star_tracker = {},
          .magnetometer = Magnetometer{.noise_nt = 100.0},
          .inertia = {},
          .nominal = NominalAttitude{.frame = NominalAttitude::Frame::Icrf,
                                     .q_frame_body = Eigen::Quaterniond::Identity()}};
}

SampleObservation field(double t_s) {
  return {.estimator = AttitudeSource::Mekf,
          .said = {.t = at(t_s), .source = SampleSource::Magnetometer}};
}

GateTransition lost_gate(double t_s, bool open) {
  return {.t = at(t_s),
          .gate = Gate::Lost,
          .open = open,
          .value = open ? 12.5 : 1.0,
          .since = at(t_s - 9.0),
          .hits = open ? 9 : 1,
          .window = 10,
          .more = {{"certain", std::int64_t{1}}}};
}

TEST(LostGate, RaisesALostAttitudeUntilItIsClosedAndTheAnswerIsOk) {
  AttitudeConditions conditions{AlertLimits{}, std::nullopt, commanded()};
  const ConditionChanges raised = conditions.evaluate(lost_gate(9.0, true));
  ASSERT_THAT(raised, only(Change::Raised));
  EXPECT_EQ(raised[0].code, AlertCode::AttitudeLost);
  const Evidence& evidence = raised[0].evidence;
  EXPECT_EQ(evidence.value, 12.5);
  EXPECT_EQ(evidence.limit, 5.0);
  EXPECT_EQ(evidence.unit, "deg");
  EXPECT_EQ(evidence.since, at(0.0));
  EXPECT_THAT(
      evidence.more,
      ElementsAre(NamedValue{"certain", std::int64_t{1}}, NamedValue{"gate", std::string{"lost"}},
                  NamedValue{"hits", std::int64_t{9}}, NamedValue{"window", std::int64_t{10}}));
  for (double t_s = 10.0; t_s < 40.0; t_s += 1.0) {
    conditions.evaluate(field(t_s));
    EXPECT_THAT(lost_by(conditions, estimate(t_s, Quality::Ok)), IsEmpty()) << t_s;
  }
  EXPECT_THAT(conditions.evaluate(lost_gate(40.0, false)), IsEmpty());
  EXPECT_THAT(lost_by(conditions, estimate(49.0, Quality::Ok)), IsEmpty());
  EXPECT_THAT(lost_by(conditions, estimate(50.0, Quality::Ok)), only(Change::Cleared));
}

TEST(LostGate, DecidesWhileTheMagnetometerSpeaks) {
  AttitudeConditions conditions{AlertLimits{}, std::nullopt, commanded()};
  conditions.evaluate(field(0.0));
  EXPECT_THAT(lost_by(conditions, estimate(1.0, Quality::Lost)), IsEmpty());
  EXPECT_THAT(lost_by(conditions, estimate(11.0, Quality::Lost)), only(Change::Raised))
      << "the magnetometer is silent";
}

TEST(LostGate, ThatIsOpenAtTheEndSettlesTheAlert) {
  for (const bool is_open : {true, false}) {
    AttitudeConditions conditions{AlertLimits{}, std::nullopt, commanded()};
    conditions.evaluate(lost_gate(9.0, true));
    if (!is_open) {
      conditions.evaluate(lost_gate(19.0, false));
    }
    const ConditionChanges settled = conditions.settle();
    EXPECT_EQ(std::any_of(settled.begin(), settled.end(),
                          [](const ConditionChange& one) {
                            return one.code == AlertCode::AttitudeLost &&
                                   one.change == Change::Cleared;
                          }),
              !is_open);
  }
}

/// Returns the keys that change so.
std::set<std::string> keys_of(const ConditionChanges& changes, Change change) {
  std::set<std::string> keys;
  for (const ConditionChange& one : changes) {
    if (one.change == change) {
      keys.insert(alert_key(one.code, one.about));
    }
  }
  return keys;
}

std::set<std::string> raised_in(const ConditionChanges& changes) {
  return keys_of(changes, Change::Raised);
}

std::set<std::string> cleared_in(const ConditionChanges& changes) {
  return keys_of(changes, Change::Cleared);
}

TEST_F(AttitudeConditionsTest, RaiseAnAttitudeThatIsDoubtfulForHalfAMinute) {
  for (double t_s = 0.0; t_s < 30.0; t_s += 1.0) {
    EXPECT_THAT(raised_in(conditions_.evaluate(estimate(t_s, Quality::Doubtful))), IsEmpty());
  }
  EXPECT_EQ(raised_in(conditions_.evaluate(estimate(30.0, Quality::Doubtful))),
            std::set<std::string>{"attitude.doubtful"});
}

TEST_F(AttitudeConditionsTest, AreSettledByTheLastAttitude) {
  EXPECT_THAT(conditions_.settle(), IsEmpty()) << "there is no answer";
  conditions_.evaluate(estimate(0.0, Quality::Lost));
  conditions_.evaluate(estimate(1.0, Quality::Doubtful));
  EXPECT_EQ(raised_in(conditions_.settle()), std::set<std::string>{"attitude.doubtful"});
}

TEST_F(AttitudeConditionsTest, SettleAContradictionOfSensors) {
  AttitudeEstimate contradicted = estimate(0.0, Quality::Ok);
  contradicted.contradiction = {.culprit = SampleSource::Star,
                                .with = {SampleSource::Sun},
                                .off = {"angle_deg", 2.0},
                                .sigmas = 20.0,
                                .since = at(0.0)};
  EXPECT_EQ(raised_in(conditions_.evaluate(contradicted)),
            std::set<std::string>{"sensor.contradicts:star"});
  conditions_.evaluate(estimate(1.0, Quality::Ok));
  EXPECT_EQ(cleared_in(conditions_.settle()).count("sensor.contradicts:star"), 1U);
}

TEST_F(AttitudeConditionsTest, RaiseAContradictionOfSensorsThatGiveNoAttitude) {
  const SensorContradiction between{.culprit = {},
                                    .with = {SampleSource::Sun, SampleSource::Magnetometer},
                                    .off = {"angle_deg", 20.0},
                                    .sigmas = 20.0,
                                    .since = at(0.0)};
  std::set<std::string> raised;
  for (double t_s = 0.0; t_s <= 5.0; t_s += 1.0) {
    raised = raised_in(conditions_.evaluate(SensorsCompared{at(t_s), between}));
  }
  EXPECT_EQ(raised, std::set<std::string>{"sensor.contradicts:unknown"});
}

TEST_F(AttitudeConditionsTest, RaiseThatNoAnswerComesOfFixes) {
  std::set<std::string> raised;
  for (int t_s = 0; t_s <= 61; ++t_s) {
    raised = raised_in(conditions_.await_answer({{at(t_s), true}}));
    EXPECT_EQ(raised.contains("attitude.no_answer"), t_s == 61) << t_s;
  }
  AttitudeConditions answered{AlertLimits{}, std::nullopt};
  std::vector<AwaitedSample> all;
  for (int t_s = 0; t_s <= 600; ++t_s) {
    all.push_back({at(t_s), true});
  }
  answered.await_answer(all);
  for (int t_s = 0; t_s <= 600; t_s += 10) {
    answered.evaluate(estimate(t_s, Quality::Ok));
  }
  EXPECT_THAT(raised_in(answered.settle()), IsEmpty());
}

TEST_F(AttitudeConditionsTest, WaitFiveTimesAsLongForAnAnswerOfSensorsThatAloneGiveNone) {
  std::set<std::string> raised;
  for (int t_s = 0; t_s <= 301; ++t_s) {
    raised = raised_in(conditions_.await_answer({{at(t_s), false}}));
    EXPECT_EQ(raised.contains("attitude.no_answer"), t_s == 301) << t_s;
  }
  // Fields that come late, in time behind that of the gyro, are waited with as fields.
  AttitudeConditions late{AlertLimits{}, std::nullopt};
  for (int t_s = 0; t_s <= 61; ++t_s) {
    raised = raised_in(late.await_answer({{at(t_s), false}, {at(t_s - 1.0), true}}));
    EXPECT_EQ(raised.contains("attitude.no_answer"), t_s == 61) << t_s;
  }
}

RejectedSample left_out(double t_s, Rejection why) {
  return {.t = at(t_s), .kind = SampleKind::Star, .rejected_by = why};
}

TEST_F(AttitudeConditionsTest, RaiseASensorThatRepeatsItself) {
  for (double t_s = 0.0; t_s < 5.0; t_s += 1.0) {
    EXPECT_THAT(raised_in(conditions_.evaluate(left_out(t_s, Rejection::Frozen))), IsEmpty());
    EXPECT_THAT(conditions_.evaluate(left_out(t_s, Rejection::Innovation)), IsEmpty());
  }
  EXPECT_EQ(raised_in(conditions_.evaluate(left_out(5.0, Rejection::Frozen))),
            std::set<std::string>{"sensor.stuck:star"});
  const auto has_cleared = [this](double t_s) {
    const ConditionChanges changes = conditions_.evaluate(estimate(t_s, Quality::Ok));
    return std::any_of(changes.begin(), changes.end(), [](const ConditionChange& one) {
      return one.code == AlertCode::SensorStuck && one.change == Change::Cleared;
    });
  };
  EXPECT_FALSE(has_cleared(9.9));
  EXPECT_TRUE(has_cleared(10.0));
}

/// Gives ten estimates a second with this mean square of the innovations in five degrees of
/// freedom.
/// @return The last change that concerns divergence.
std::optional<ConditionChange> last_change(AttitudeConditions& conditions, double from_s,
                                           double to_s, double mean_square) {
  std::optional<ConditionChange> last;
  for (double t_s = from_s; t_s < to_s; t_s += 0.1) {
    AttitudeEstimate one = estimate(t_s, Quality::Ok);
    one.innovations = {.squared = 5.0 * mean_square, .freedom = 5};
    for (const ConditionChange& change : conditions.evaluate(one)) {
      if (change.code == AlertCode::AttitudeDiverged) {
        last = change;
      }
    }
  }
  return last;
}

TEST_F(AttitudeConditionsTest, RaiseInnovationsThatAreTooLargeOrTooSmallForTwoMinutes) {
  for (const double mean_square : {0.8, 1.2}) {
    AttitudeConditions conditions{AlertLimits{}, std::nullopt};
    EXPECT_EQ(last_change(conditions, 0.0, 200.0, 1.0)->change, Change::Cleared);
    EXPECT_FALSE(last_change(conditions, 200.0, 260.0, mean_square));
    const auto raised = last_change(conditions, 260.0, 320.0, mean_square).value();
    EXPECT_EQ(raised.change, Change::Raised);
    EXPECT_EQ(last_change(conditions, 320.0, 500.0, 1.0)->change, Change::Cleared);
  }
}

TEST_F(AttitudeConditionsTest, SettleADivergenceThatIsOverAndRaiseNoneOfTheLastWindowAlone) {
  last_change(conditions_, 0.0, 320.0, 1.2);
  const auto last = last_change(conditions_, 320.0, 385.0, 1.0);
  EXPECT_TRUE(!last || last->change == Change::Renewed) << "it is held to be there";
  EXPECT_EQ(cleared_in(conditions_.settle()).count("attitude.diverged"), 1U);

  AttitudeConditions brief{AlertLimits{}, std::nullopt};
  EXPECT_FALSE(last_change(brief, 0.0, 100.0, 1.2));
  EXPECT_EQ(raised_in(brief.settle()).count("attitude.diverged"), 0U);
}

TEST_F(AttitudeConditionsTest, JudgeNoInnovationsWhereThereAreNone) {
  for (double t_s = 0.0; t_s < 300.0; t_s += 0.1) {
    for (const ConditionChange& change : conditions_.evaluate(estimate(t_s, Quality::Ok))) {
      EXPECT_NE(change.code, AlertCode::AttitudeDiverged);
    }
  }
}

/// Returns the keys raised and not cleared for samples that come once a second.
std::set<std::string> raised_by(AttitudeConditions& conditions, std::vector<SampleKind> kinds,
                                int from_s, int to_s) {
  std::set<std::string> raised;
  for (int t_s = from_s; t_s < to_s; ++t_s) {
    for (const SampleKind kind : kinds) {
      for (const ConditionChange& change : conditions.evaluate(kind, at(t_s))) {
        const std::string key = alert_key(change.code, change.about);
        if (change.change == Change::Raised) {
          raised.insert(key);
        } else if (change.change == Change::Cleared) {
          raised.erase(key);
        }
      }
    }
  }
  return raised;
}

using Keys = std::set<std::string>;
using enum SampleKind;

TEST_F(AttitudeConditionsTest, RaiseASensorThatGivesNothingWhileOthersDo) {
  EXPECT_EQ(raised_by(conditions_, {Gyro, Star, OrbitState}, 0, 10), Keys{});
  EXPECT_EQ(raised_by(conditions_, {Gyro}, 10, 14), Keys{});
  EXPECT_EQ(raised_by(conditions_, {Gyro}, 14, 20), Keys{"channel.silent:star"});
  EXPECT_THAT(conditions_.evaluate(Star, at(20.5)), only(Change::Cleared));
}

TEST_F(AttitudeConditionsTest, RaiseASensorThatNothingBlindsAndThatNeverComes) {
  ThreeAxisConfig config;
  config.gyro = GyroSensor{.noise_rad_s = 1e-5, .bias_sigma_rad_s = 1e-4, .range_rad_s = {}};
  config.star_tracker =
      StarTracker{.q_body_sensor = Eigen::Quaterniond::Identity(), .noise_rad = 1e-4};
  config.magnetometer = spindrift::Magnetometer{.noise_nt = 100.0};
  AttitudeConditions conditions{AlertLimits{}, std::nullopt, config};
  EXPECT_EQ(raised_by(conditions, {Sun}, 0, 5), Keys{});
  EXPECT_EQ(raised_by(conditions, {Sun}, 5, 10),
            (Keys{"channel.silent:gyro", "channel.silent:magnetometer"}));
  EXPECT_THAT(conditions.evaluate(Gyro, at(10)), only(Change::Cleared));
}

TEST_F(AttitudeConditionsTest, BelieveNoSampleAloneThatTimeHasGoneOn) {
  constexpr int kYears_s = 600'000'000;
  EXPECT_EQ(raised_by(conditions_, {Gyro, Star}, 0, 10), Keys{});
  conditions_.evaluate(Gyro, at(kYears_s));
  EXPECT_EQ(raised_by(conditions_, {Gyro, Star}, 10, 20), Keys{});
  conditions_.evaluate(Star, at(kYears_s));
  EXPECT_EQ(raised_by(conditions_, {Gyro}, 20, 30), Keys{"channel.silent:star"});
}

TEST_F(AttitudeConditionsTest, BelieveNoNumberOfSamplesThatTimeHasGoneOnUnlessItGoesOnFromThere) {
  EXPECT_EQ(raised_by(conditions_, {Gyro, Star}, 0, 10), Keys{});
  EXPECT_EQ(raised_by(conditions_, {Gyro}, 1800, 1820), Keys{});
  EXPECT_EQ(raised_by(conditions_, {Gyro, Star}, 10, 20), Keys{});
  EXPECT_EQ(raised_by(conditions_, {Gyro}, 3600, 3630), Keys{"channel.silent:star"});
}

TEST_F(AttitudeConditionsTest, ExpectNoSunThatTheEarthHides) {
  const Eigen::Vector3d to_sun = geometric_sun_icrf_km(at(0)).normalized();
  const Eigen::Vector3d across = to_sun.unitOrthogonal();
  const auto orbit = KeplerOrbit::through(
      at(0), {.position_icrf_km = -7000.0 * to_sun, .velocity_icrf_km_s = 7.5 * across});
  AttitudeConditions hidden{AlertLimits{}, Orbit{orbit.value()}};
  EXPECT_EQ(raised_by(hidden, {Gyro, Sun}, 0, 10), Keys{});
  EXPECT_EQ(raised_by(hidden, {Gyro}, 10, 60), Keys{});
  AttitudeConditions unknown{AlertLimits{}, std::nullopt};
  EXPECT_EQ(raised_by(unknown, {Gyro, Sun}, 0, 10), Keys{});
  EXPECT_EQ(raised_by(unknown, {Gyro}, 10, 60), Keys{"channel.silent:sun"});
}

/// The Sun sensor looks along X, the tracker along Z, and the field of each is 30 deg wide.
ThreeAxisConfig with_fields_of_view() {
  constexpr double kHalf_rad = 0.52;
  ThreeAxisConfig config;
  config.sun_sensor = DigitalSunSensor{
      .noise_rad = 0.01,
      .view = FieldOfView{.boresight_body = Eigen::Vector3d::UnitX(), .half_angle_rad = kHalf_rad}};
  config.star_tracker = StarTracker{
      .q_body_sensor = Eigen::Quaterniond::Identity(),
      .noise_rad = 1e-4,
      .view = FieldOfView{.boresight_body = Eigen::Vector3d::UnitZ(), .half_angle_rad = kHalf_rad}};
  return config;
}

/// Returns the keys open after a minute in which only the attitude goes on.
/// @param towards_sun_body Direction to the Sun, body axes.
Keys open_behind_a_minute(const std::optional<Orbit>& orbit,
                          const Eigen::Vector3d& towards_sun_body) {
  AttitudeConditions conditions{AlertLimits{}, orbit, with_fields_of_view()};
  for (const SampleSource source : {SampleSource::Sun, SampleSource::Star}) {
    conditions.evaluate(SampleObservation{.estimator = AttitudeSource::Mekf,
                                          .said = {.t = at(0), .source = source}});
  }
  Keys open;
  for (int t_s = 0; t_s <= 60; ++t_s) {
    AttitudeEstimate one = estimate(t_s, Quality::Ok);
    one.q_icrf_body = Eigen::Quaterniond::FromTwoVectors(towards_sun_body,
                                                         geometric_sun_icrf_km(one.t).normalized());
    for (const std::string& key : raised_in(conditions.evaluate(one))) {
      open.insert(key);
    }
  }
  return open;
}

TEST_F(AttitudeConditionsTest, ExpectNothingThatIsOutsideAFieldOfView) {
  EXPECT_EQ(open_behind_a_minute({}, Eigen::Vector3d::UnitX()),
            (Keys{"channel.silent:star", "channel.silent:sun"}));
  EXPECT_EQ(open_behind_a_minute({}, Eigen::Vector3d::UnitY()), Keys{"channel.silent:star"});
  EXPECT_EQ(open_behind_a_minute({}, Eigen::Vector3d::UnitZ()), Keys{});
}

TEST_F(AttitudeConditionsTest, ExpectNoStarsWhereTheEarthIs) {
  const Eigen::Vector3d to_sun = geometric_sun_icrf_km(at(0)).normalized();
  const auto beyond = [&](const Eigen::Vector3d& position_km) {
    return Orbit{KeplerOrbit::through(
                     at(0), {.position_icrf_km = position_km, .velocity_icrf_km_s = 7.5 * to_sun})
                     .value()};
  };
  // The tracker looks across the Sun, where the first spacecraft has the Earth behind itself.
  const Eigen::Vector3d boresight_icrf =
      Eigen::Quaterniond::FromTwoVectors(Eigen::Vector3d::UnitX(), to_sun) *
      Eigen::Vector3d::UnitZ();
  EXPECT_EQ(open_behind_a_minute(beyond(7000.0 * boresight_icrf), Eigen::Vector3d::UnitX()),
            (Keys{"channel.silent:star", "channel.silent:sun"}));
  EXPECT_EQ(open_behind_a_minute(beyond(-7000.0 * boresight_icrf), Eigen::Vector3d::UnitX()),
            Keys{"channel.silent:sun"});
}

TEST_F(AttitudeConditionsTest, LeaveASensorWithAFieldOfViewToTheAttitude) {
  AttitudeConditions conditions{AlertLimits{}, std::nullopt, with_fields_of_view()};
  EXPECT_EQ(raised_by(conditions, {Gyro, Sun, Star, Magnetometer}, 0, 10), Keys{});
  EXPECT_EQ(raised_by(conditions, {Gyro}, 10, 60), Keys{"channel.silent:magnetometer"});
}

}  // namespace spindrift::attitude_conditions_test
