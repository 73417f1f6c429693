#include "pipelines/ground_model/link/coded_telemetry.h"

#include <utility>
#include <vector>

#include "tests/support/matchers.h"

namespace spindrift::coded_telemetry_test {

using enum PulseChannel;
using ::testing::DoubleNear;
using ::testing::Optional;

constexpr double kResolution_s = 1e-5;
// Sums and multiples of the resolution are exact to a few ulps of a second.
constexpr double kRounding_s = 1e-14;

ReceivedPulse at(double t_s, PulseChannel channel) {
  return {.pulse = {.t = shifted(tai_from_ns(1'000'000'000'000), t_s), .channel = channel},
          .damage = {}};
}

ReceivedPass pass(std::vector<ReceivedPulse> pulses, std::vector<Pulse> silenced = {}) {
  return {.pulses = std::move(pulses), .silenced = std::move(silenced), .missing = 0};
}

auto seconds(double value_s) { return Optional(DoubleNear(value_s, kRounding_s)); }

TEST(CodedTelemetry, GivesPeriodAndDelaysOnTheGrid) {
  const auto frames =
      coded_telemetry(pass({at(0.0, Sun1), at(0.079323, Sun2), at(0.4545051, NorthIn),
                            at(1.0000561, Sun1), at(1.5, SouthOut)}),
                      kResolution_s);
  ASSERT_EQ(frames.size(), 2U);
  EXPECT_EQ(frames[0].t, tai_from_ns(1'000'000'000'000));
  EXPECT_FALSE(frames[0].period_s);
  EXPECT_THAT(frames[0].delay_s.at(index_of(Sun2)), seconds(0.07932));
  EXPECT_THAT(frames[0].delay_s.at(index_of(NorthIn)), seconds(0.45451));
  EXPECT_FALSE(frames[0].delay_s.at(index_of(SouthOut)));
  EXPECT_THAT(frames[1].period_s, seconds(1.00006));
  EXPECT_THAT(frames[1].delay_s.at(index_of(SouthOut)), seconds(0.49994));
}

TEST(CodedTelemetry, KeepsTheFirstEdgeOfAChannelAndNoneAheadOfTheFirstSun1) {
  const auto frames = coded_telemetry(
      pass({at(-0.2, NorthIn), at(0.0, Sun1), at(0.3, NorthIn), at(0.4, NorthIn)}), kResolution_s);
  ASSERT_EQ(frames.size(), 1U);
  EXPECT_THAT(frames[0].delay_s.at(index_of(NorthIn)), seconds(0.3));
}

TEST(CodedTelemetry, TakesDelaysModuloThePeriodWhereASun1WasLost) {
  const auto frames = coded_telemetry(
      pass({at(0.0, Sun1), at(1.0, Sun1), at(2.3, NorthIn), at(3.0, Sun1)}), kResolution_s);
  ASSERT_EQ(frames.size(), 3U);
  EXPECT_THAT(frames[1].delay_s.at(index_of(NorthIn)), seconds(0.3));
  EXPECT_THAT(frames[2].period_s, seconds(2.0));
}

TEST(CodedTelemetry, ASilenceOfTheLinkTakesFramesAndStretchesNoInterval) {
  const auto frames = coded_telemetry(
      pass({at(0.0, Sun1), at(0.4, NorthIn), at(1.0, Sun1), at(5.0, Sun1), at(5.4, NorthIn)},
           {at(1.4, NorthIn).pulse, at(2.0, Sun1).pulse, at(2.4, NorthIn).pulse,
            at(3.0, Sun1).pulse, at(4.0, Sun1).pulse, at(4.4, NorthIn).pulse}),
      kResolution_s);
  ASSERT_EQ(frames.size(), 2U);
  EXPECT_EQ(frames[0].t, at(0.0, Sun1).pulse.t);
  EXPECT_EQ(frames[1].t, at(5.0, Sun1).pulse.t);
  EXPECT_THAT(frames[1].period_s, seconds(1.0));
  EXPECT_THAT(frames[1].delay_s.at(index_of(NorthIn)), seconds(0.4));
}

TEST(CodedTelemetry, IsEmptyWhereTheCounterOverflowsOrHasNotTicked) {
  const auto frames =
      coded_telemetry(pass({at(0.0, Sun1), at(60.00001, NorthIn), at(60.00002, Sun1),
                            at(120.00002, Sun1), at(120.000024, Sun1), at(180.000024, NorthIn)}),
                      kResolution_s);
  ASSERT_EQ(frames.size(), 4U);
  EXPECT_FALSE(frames[0].delay_s.at(index_of(NorthIn)));
  EXPECT_FALSE(frames[1].period_s);
  EXPECT_THAT(frames[2].period_s, seconds(60.0));
  EXPECT_FALSE(frames[3].period_s);
  EXPECT_THAT(frames[3].delay_s.at(index_of(NorthIn)), seconds(60.0));
}

}  // namespace spindrift::coded_telemetry_test
