#include "services/ingest/from_idl.h"

#include <cstring>
#include <functional>
#include <vector>

#include "tests/support/bus_fixture.h"
#include "tests/support/matchers.h"

namespace spindrift::from_idl_test {

TEST(FromIdl, KeepsEveryField) {
  const TelemetrySample<Pulse> sample = from_idl<Pulse>(idl_pulse(41, 17)).value();
  EXPECT_EQ(sample.spacecraft, "SPINNER");
  EXPECT_EQ(sample.origin.source, "front-end");
  EXPECT_EQ(sample.origin.session, 17U);
  EXPECT_EQ(sample.origin.seq, 41U);
  EXPECT_EQ(tai_ns(sample.value.t), kTestTime_tai_ns + 41'000'000'000);
  EXPECT_EQ(sample.value.channel, PulseChannel::Sun1);
}

TEST(FromIdl, NamesTheChannelsAsTheIdlDoes) {
  const auto channel_of = [](spindrift_PulseChannel channel) {
    spindrift_Pulse pulse = idl_pulse(0);
    pulse.channel = channel;
    return name_of(from_idl<Pulse>(pulse).value().value.channel);
  };
  EXPECT_EQ(channel_of(spindrift_SUN1), "sun1");
  EXPECT_EQ(channel_of(spindrift_SUN2), "sun2");
  EXPECT_EQ(channel_of(spindrift_NORTH_IN), "north_in");
  EXPECT_EQ(channel_of(spindrift_NORTH_OUT), "north_out");
  EXPECT_EQ(channel_of(spindrift_SOUTH_IN), "south_in");
  EXPECT_EQ(channel_of(spindrift_SOUTH_OUT), "south_out");
}

template <class Message>
struct Impossible {
  std::function<void(Message&)> spoil;
  const char* reason;
};

/// Expects each of these changes to make a sample impossible.
template <class Value, class Message>
void expect_refused(const Message& possible, const std::vector<Impossible<Message>>& cases) {
  for (const auto& [spoil, reason] : cases) {
    SCOPED_TRACE(reason);
    Message message = possible;
    spoil(message);
    EXPECT_THAT(from_idl<Value>(message), IsRefused(ErrorCode::InvalidInput, HasSubstr(reason)));
  }
}

TEST(FromIdl, RefusesWhatCannotBeTrueWithItsReason) {
  expect_refused<Pulse, spindrift_Pulse>(
      idl_pulse(0),
      {{[](auto& pulse) { pulse.spacecraft[0] = '\0'; },
        "spacecraft = \"\": must be 1 to 32 printable ASCII characters"},
       {[](auto& pulse) { pulse.spacecraft[1] = '\n'; }, "spacecraft = \"S\\x0aINNER\": must be"},
       {[](auto& pulse) { pulse.source[0] = '\xFF'; },
        "source = \"\\xffront-end\": must be printable ASCII"},
       {[](auto& pulse) { pulse.t_tai_ns = 63'072'009'999'999'999; },
        "t_tai_ns = 63072009999999999: must lie in the years 1972 to 2099"},
       {[](auto& pulse) { pulse.t_tai_ns = 4'102'444'800'000'000'000; }, "must lie in the years"},
       {[](auto& pulse) { pulse.t_tai_ns = std::numeric_limits<std::int64_t>::min(); },
        "must lie in the years"},
       {[](auto& pulse) {
          const std::uint32_t unknown = 6;
          std::memcpy(&pulse.channel, &unknown, sizeof unknown);
        },
        "channel = 6: must be 0 to 5"},
       {[](auto& pulse) { std::memset(&pulse.channel, 0xFF, sizeof pulse.channel); },
        "channel = 4294967295: must be 0 to 5"}});
}

TEST(FromIdl, TellsOfWhichKindASampleWithoutATimeIs) {
  spindrift_Pulse pulse = idl_pulse(5);
  spindrift_CodedFrame frame = idl_frame(5);
  pulse.t_tai_ns = frame.t_tai_ns = 0;
  EXPECT_THAT(from_idl<Pulse>(pulse).error().message, StartsWith("pulses: t_tai_ns = 0: must"));
  EXPECT_THAT(from_idl<CodedFrame>(frame).error().message, StartsWith("coded: t_tai_ns = 0: must"));
}

TEST(FromIdl, TakesTheFirstAndLastTimeOfTelemetry) {
  for (const std::int64_t t_tai_ns : {63'072'010'000'000'000, 4'102'444'799'999'999'999}) {
    spindrift_Pulse pulse = idl_pulse(0);
    pulse.t_tai_ns = t_tai_ns;
    EXPECT_EQ(tai_ns(from_idl<Pulse>(pulse).value().value.t), t_tai_ns);
  }
}

constexpr double kNan = std::numeric_limits<double>::quiet_NaN();

TEST(FromIdl, KeepsEveryFieldOfACodedFrame) {
  const TelemetrySample<CodedFrame> sample = from_idl<CodedFrame>(idl_frame(41)).value();
  EXPECT_EQ(sample.spacecraft, "SPINNER");
  EXPECT_EQ(sample.origin.source, "front-end");
  EXPECT_EQ(sample.origin.session, 1U);
  EXPECT_EQ(sample.origin.seq, 41U);
  EXPECT_EQ(tai_ns(sample.value.t), kTestTime_tai_ns + 41'000'000'000);
  EXPECT_EQ(sample.value.period_s, 1.0);
  EXPECT_THAT(sample.value.delay_s, ElementsAre(std::nullopt, 0.125, 0.25, 0.375, 0.5, 0.625));
}

TEST(FromIdl, TakesNanForNotReceived) {
  spindrift_CodedFrame frame = idl_frame(0);
  frame.period_s = frame.sun2_s = frame.north_in_s = kNan;
  frame.north_out_s = frame.south_in_s = frame.south_out_s = kNan;
  const TelemetrySample<CodedFrame> sample = from_idl<CodedFrame>(frame).value();
  EXPECT_EQ(sample.value.period_s, std::nullopt);
  EXPECT_THAT(sample.value.delay_s, Each(std::nullopt));
}

TEST(FromIdl, RefusesACodedFrameThatCannotBeTrueWithItsReason) {
  constexpr double kInfinity = std::numeric_limits<double>::infinity();
  expect_refused<CodedFrame, spindrift_CodedFrame>(
      idl_frame(0),
      {{[](auto& frame) { frame.spacecraft[0] = ' '; }, "spacecraft = \" PINNER\": must be"},
       {[](auto& frame) { frame.t_tai_ns = -1; }, "t_tai_ns = -1: must lie in the years"},
       {[](auto& frame) { frame.period_s = 0.0; }, "period_s = 0: must be above 0, at most 60 s"},
       {[](auto& frame) { frame.period_s = kInfinity; }, "period_s = inf: must be above 0"},
       {[](auto& frame) { frame.sun2_s = -kInfinity; }, "sun2_s = -inf: must be 0 to two periods"},
       {[](auto& frame) { frame.south_out_s = 2.01; },
        "south_out_s = 2.01: must be 0 to two periods, 2 s"}});
}

}  // namespace spindrift::from_idl_test
