#include "pipelines/supervision/sensor_conditions.h"

#include "tests/support/matchers.h"

namespace spindrift::sensor_conditions_test {

TaiTime at_s(int t_s) { return tai_from_ns(1'795'143'637'000'000'000 + t_s * 1'000'000'000LL); }

SensorContradiction of(std::optional<SampleSource> culprit, std::vector<SampleSource> with,
                       double sigmas = 20.0) {
  return {.culprit = culprit,
          .with = std::move(with),
          .off = {"angle_deg", 2.0},
          .sigmas = sigmas,
          .since = at_s(-3)};
}
const SensorContradiction kStar =
    of(SampleSource::Star, {SampleSource::Sun, SampleSource::Magnetometer});
const SensorContradiction kEither = of({}, {SampleSource::Star, SampleSource::Gyro});

TEST(SensorConditions, NameTheCulpritAtOnceWithWhatContradictsIt) {
  SensorConditions conditions{AlertLimits{}};
  EXPECT_THAT(conditions.evaluate(at_s(0), {}), IsEmpty());
  const ConditionChanges raised = conditions.evaluate(at_s(1), kStar);
  ASSERT_THAT(raised, SizeIs(1));
  EXPECT_EQ(alert_key(raised[0].code, raised[0].about), "sensor.contradicts:star");
  EXPECT_EQ(raised[0].who, "sun, magnetometer");
  EXPECT_EQ(raised[0].evidence.value, 20.0);
  EXPECT_EQ(raised[0].evidence.limit, 5.0);
  EXPECT_EQ(raised[0].evidence.since, at_s(-3));
  EXPECT_THAT(raised[0].evidence.more,
              ElementsAre(NamedValue{"angle_deg", 2.0}, NamedValue{"sigma", 20.0},
                          NamedValue{"with", std::vector<std::string>{"sun", "magnetometer"}}));
  EXPECT_THAT(conditions.evaluate(at_s(2), kStar), IsEmpty());
}

TEST(SensorConditions, WaitForTheNameBeforeTheySayThatItIsUnknown) {
  SensorConditions conditions{AlertLimits{}};
  EXPECT_THAT(conditions.evaluate(at_s(0), kEither), IsEmpty());
  EXPECT_THAT(conditions.evaluate(at_s(4), kEither), IsEmpty());
  const ConditionChanges raised = conditions.evaluate(at_s(5), kEither);
  ASSERT_THAT(raised, SizeIs(1));
  EXPECT_EQ(raised[0].about, "unknown");
  EXPECT_EQ(raised[0].who, "star, gyro");
}

TEST(SensorConditions, EndHalfAMinuteAfterTheContradiction) {
  SensorConditions conditions{AlertLimits{}};
  conditions.evaluate(at_s(0), kStar);
  const auto is_renewed = Each(Field(&ConditionChange::change, Change::Renewed));
  EXPECT_THAT(conditions.evaluate(at_s(10), {}), is_renewed);
  EXPECT_THAT(conditions.evaluate(at_s(20), kStar), is_renewed);
  EXPECT_THAT(conditions.evaluate(at_s(30), {}), is_renewed);
  EXPECT_THAT(conditions.evaluate(at_s(59), {}), is_renewed);
  const ConditionChanges over = conditions.evaluate(at_s(60), {});
  ASSERT_THAT(over, SizeIs(1));
  EXPECT_EQ(over[0].change, Change::Cleared);
  EXPECT_EQ(over[0].about, "star");
}

TEST(SensorConditions, KeepWhatIsKnownWhileTheyClear) {
  SensorConditions conditions{AlertLimits{}};
  conditions.evaluate(at_s(0), kStar);
  const ConditionChanges clearing = conditions.evaluate(at_s(10), {});
  ASSERT_THAT(clearing, SizeIs(1));
  EXPECT_EQ(clearing[0].evidence.value, 0.0);
  EXPECT_EQ(clearing[0].who, "sun, magnetometer");
  EXPECT_EQ(clearing[0].evidence.since, at_s(-3));
  EXPECT_THAT(clearing[0].evidence.more,
              ElementsAre(NamedValue{"angle_deg", 2.0}, NamedValue{"sigma", 20.0},
                          NamedValue{"with", std::vector<std::string>{"sun", "magnetometer"}}));
}

TEST(SensorConditions, AreSettledByTheLastComparison) {
  SensorConditions conditions{AlertLimits{}};
  EXPECT_THAT(conditions.settle(), IsEmpty()) << "nothing was compared";
  conditions.evaluate(at_s(0), kStar);
  conditions.evaluate(at_s(1), {});
  const ConditionChanges over = conditions.settle();
  ASSERT_THAT(over, SizeIs(1));
  EXPECT_EQ(over[0].change, Change::Cleared);
  EXPECT_EQ(over[0].about, "star");
  EXPECT_GT(over[0].t, at_s(1));

  SensorConditions either{AlertLimits{}};
  EXPECT_THAT(either.evaluate(at_s(0), kEither), IsEmpty());
  const ConditionChanges raised = either.settle();
  ASSERT_THAT(raised, SizeIs(1));
  EXPECT_EQ(raised[0].change, Change::Raised);
  EXPECT_EQ(raised[0].who, "star, gyro");
}

TEST(SensorConditions, TakeAsManySigmaAsTheLimitSays) {
  AlertLimits limits;
  limits.contradicts_sigmas = 30.0;
  SensorConditions conditions{limits};
  EXPECT_THAT(conditions.evaluate(at_s(0), kStar), IsEmpty());
  EXPECT_THAT(conditions.evaluate(at_s(1), of(SampleSource::Star, {SampleSource::Sun}, 31.0)),
              SizeIs(1));
}

}  // namespace spindrift::sensor_conditions_test
