#include "services/simulation/flight_plot.h"

#include "tests/support/matchers.h"
#include "tests/support/test_paths.h"
#include "tests/support/well_formed.h"

namespace spindrift::testing::flight_plot_test {

Scenario loaded(const char* name) { return load_scenario(scenarios() / name).value(); }

TEST(FlightPlot, ShowsAttitudeRatesAndWheels) {
  const Scenario scenario = loaded("upper-stage.toml");
  const std::string page = flight_plot(scenario, simulated_pass(scenario).value());
  EXPECT_EQ(xml_problem(page), "");
  EXPECT_THAT(page, AllOf(HasSubstr("Attitude seen from the start"), HasSubstr("Body rates, deg/s"),
                          HasSubstr("Momenta of the wheels"), HasSubstr("Speed of wheel 3, rpm"),
                          HasSubstr("within 1 deg"), Not(HasSubstr("nan"))));
}

TEST(FlightPlot, ShowsWhatABodyWithoutWheelsDoes) {
  const Scenario scenario = loaded("separation.toml");
  const std::string page = flight_plot(scenario, simulated_pass(scenario).value());
  EXPECT_EQ(xml_problem(page), "");
  EXPECT_THAT(page, AllOf(HasSubstr("Body rates, deg/s"), HasSubstr("T3"),
                          Not(HasSubstr("Momenta of the wheels"))));
}

TEST(LoopPlot, ShowsTheMarginsOfSeed004) {
  const Scenario scenario = loaded("upper-stage.toml");
  const auto& flight = std::get<OrientationScenario>(scenario.flight);
  const auto channels = channel_margins(flight.truth).value();
  for (const ChannelMargins& channel : channels) {
    EXPECT_NEAR(degrees(channel.designed_margins.phase_rad), 63.6, 0.1);
    EXPECT_FALSE(channel.designed_margins.gain);
    EXPECT_LT(channel.flown_margins.phase_rad, channel.designed_margins.phase_rad);
    EXPECT_GT(channel.flown_margins.gain.value(), 10.0);
  }
  const std::string page = loop_plot("SMALLSAT", channels);
  EXPECT_EQ(xml_problem(page), "");
  EXPECT_THAT(page, AllOf(HasSubstr("X, roll: gain"),
                          HasSubstr("designed: phase margin 63.6 deg, gain margin infinite"),
                          HasSubstr("Root locus"), Not(HasSubstr("nan"))));
}

}  // namespace spindrift::testing::flight_plot_test
