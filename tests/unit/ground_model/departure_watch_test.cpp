#include "pipelines/ground_model/comparison/departure_watch.h"

#include <cmath>

#include "tests/support/matchers.h"

namespace spindrift::departure_watch_test {

constexpr TaiTime kStart = tai_from_ns(1'772'337'637'000'000'000);
constexpr double kSigma = 0.002;
constexpr double kBand = 5.0;

/// Watches two channels, of which the second has no values; both hold for ten seconds.
class DepartureWatchTest : public ::testing::Test {
 protected:
  static constexpr std::size_t kRate = 0;
  static constexpr std::size_t kSensor = 1;

  std::optional<ConditionChange> see(double t_s, double sigmas) {
    return watch_.evaluate(
        {.channel = kRate,
         .t = shifted(kStart, t_s),
         .came = true,
         .value = ComparedValue{.flight = 1.0 + sigmas * kSigma, .model = 1.0, .sigma = kSigma}});
  }
  std::optional<ConditionChange> see_sensor(double t_s, bool came) {
    return watch_.evaluate({.channel = kSensor, .t = shifted(kStart, t_s), .came = came});
  }
  ChannelComparison rate() const { return watch_.channels().at(kRate); }

  DepartureWatch watch_{{{.name = "gyro_x", .unit = "deg/s", .holding_s = 10.0},
                         {.name = "gyro", .unit = "", .holding_s = 10.0}},
                        kBand};
};

TEST_F(DepartureWatchTest, TakesNoOutlierForADeparture) {
  for (int t_s = 0; t_s < 100; ++t_s) {
    const auto change = see(t_s, t_s % 10 == 0 ? 50.0 : 1.0);
    EXPECT_TRUE(!change || change->change == Change::Cleared);
  }
  EXPECT_FALSE(rate().departure);
  EXPECT_EQ(rate().outside, 10);
}

/// Outliers on both sides of a gap do not prove that the channel was away during the gap: there are
/// too few samples.
TEST_F(DepartureWatchTest, TakesOutliersOnBothSidesOfAGapForNone) {
  for (const double t_s : {0.0, 1.0, 2.0, 3.0, 61.0, 62.0}) {
    see(t_s, 40.0);
  }
  see(63.0, 0.5);
  for (const double t_s : {64.0, 74.0}) {
    see(t_s, 40.0);
  }
  see(75.0, 0.5);
  EXPECT_FALSE(rate().departure);
}

TEST_F(DepartureWatchTest, FindsTheFirstInstantOfADepartureOnceMostOfTheWindowIsAway) {
  for (int t_s = 0; t_s < 50; ++t_s) {
    see(t_s, t_s == 19 || t_s == 46 ? 8.0 : 0.5);
  }
  // The outlier is within the window but is not the start of the departure.
  for (int t_s = 50; t_s < 59; ++t_s) {
    ASSERT_FALSE(see(t_s, -6.0 - 0.1 * (t_s - 50))) << t_s;
  }
  const auto change = see(59.0, -7.0).value();
  EXPECT_EQ(change.change, Change::Raised);
  EXPECT_EQ(change.code, AlertCode::ModelDeparture);
  EXPECT_EQ(change.about, "gyro_x");
  ASSERT_TRUE(rate().departure);
  for (const Evidence& evidence : {change.evidence, *rate().departure}) {
    EXPECT_EQ(evidence.since, shifted(kStart, 50.0));
    EXPECT_EQ(evidence.last, shifted(kStart, 59.0));
    EXPECT_NEAR(evidence.value, 6.0 * kSigma, 1e-12);
    EXPECT_NEAR(evidence.limit, kBand * kSigma, 1e-12);
    EXPECT_EQ(evidence.sigma, kSigma);
    EXPECT_EQ(evidence.unit, "deg/s");
  }
}

/// Nutation, for example, crosses the model twice a turn.
TEST_F(DepartureWatchTest, FindsFlightThatSwingsAboutTheModel) {
  for (int i = 0; i < 400; ++i) {
    see(0.1 * i, i < 200 ? 0.5 : 12.0 * std::sin(0.5 * i));
  }
  ASSERT_TRUE(rate().departure);
  EXPECT_NEAR(seconds_between(kStart, rate().departure->since), 20.0, 1.0);
}

/// The star fixes at the end of a separation are an example.
TEST_F(DepartureWatchTest, FindsAChannelThatIsAwayAtAllOfItsFewSamples) {
  for (int t_s = 0; t_s < 8; ++t_s) {
    see(t_s, 50.0);
  }
  ASSERT_TRUE(rate().departure);
  EXPECT_EQ(rate().departure->since, kStart);
}

TEST_F(DepartureWatchTest, KeepsTheFirstDepartureWhenFlightIsBackForAMinuteAndLeavesAgain) {
  std::vector<Change> changes;
  for (int t_s = 0; t_s < 200; ++t_s) {
    const bool is_away = (t_s >= 20 && t_s < 40) || (t_s >= 70 && t_s < 80) || t_s >= 160;
    if (const auto change = see(t_s, is_away ? 9.0 : 3.9)) {
      changes.push_back(change->change);
    }
  }
  // The channel is away again within a minute, so it was never back.
  EXPECT_THAT(changes, ElementsAre(Change::Raised, Change::Cleared, Change::Raised));
  EXPECT_EQ(rate().departure->since, shifted(kStart, 20.0));
}

TEST_F(DepartureWatchTest, FindsASensorThatIsSilentWhereTheModelSends) {
  see_sensor(0.0, true);
  for (int t_s = 1; t_s < 15; ++t_s) {
    see_sensor(t_s, false);
  }
  const auto departure = watch_.channels().at(kSensor).departure.value();
  EXPECT_EQ(departure.since, shifted(kStart, 1.0));
  EXPECT_NEAR(departure.value, 10.0, 1e-9);
  EXPECT_EQ(departure.limit, 10.0);
  EXPECT_EQ(departure.unit, "s silent");
}

TEST_F(DepartureWatchTest, CountsWhatComesLateAndJudgesNothingByIt) {
  for (int t_s = 0; t_s < 9; ++t_s) {
    see(t_s, 6.0);
  }
  see(3.5, 0.0);
  for (int t_s = 9; t_s < 12; ++t_s) {
    see(t_s, 6.0);
  }
  EXPECT_EQ(rate().residuals.count(), 13);
  EXPECT_EQ(rate().departure->since, kStart);
}

TEST_F(DepartureWatchTest, GivesTheStatisticsOfTheResiduals) {
  for (const double sigmas : {1.0, -1.0, 3.0, 1.0}) {
    see(0.0, sigmas);
  }
  const ResidualStatistics& residuals = rate().residuals;
  EXPECT_EQ(residuals.count(), 4);
  EXPECT_NEAR(residuals.mean(), 1.0 * kSigma, 1e-12);
  EXPECT_NEAR(residuals.sigma(), std::sqrt(8.0 / 3.0) * kSigma, 1e-12);
  EXPECT_NEAR(residuals.rms(), std::sqrt(3.0) * kSigma, 1e-12);
  EXPECT_NEAR(residuals.normalised_rms(), std::sqrt(3.0), 1e-9);
  EXPECT_NEAR(residuals.most(), 3.0 * kSigma, 1e-12);
}

}  // namespace spindrift::departure_watch_test
