#include <fmt/format.h>
#include <gtest/gtest.h>

#include <random>

#include "tests/property/alerts/supervised_pass.h"

namespace spindrift::testing::false_alarms_test {

constexpr int kPasses = 100;
constexpr int kServed = 5;  // Every fifth pass is also computed as `serve` does it.

void expect_none(const RaisedByKey& raised, TaiTime start, int pass) {
  for (const auto& [key, alert] : raised) {
    EXPECT_EQ(alert.severity, AlertSeverity::Info)
        << key << " of pass " << pass << " at " << seconds_between(start, alert.t) << " s";
  }
}

/// Expects only the silence at the end of the telemetry to be reported.
void expect_none_but_the_end(const Flight& flight, int pass) {
  SupervisedPass supervised{flight.mission, RunMode::Live};
  RaisedByKey raised = supervised.serve(flight.sent);
  EXPECT_GT(raised.at("link.silent").t, flight.sent.back().came);
  raised.erase("link.silent");
  expect_none(raised, flight.sent.front().came, pass);
}

TEST(FalseAlarms, NoneOfANutationThatDoesNotGrow) {
  const auto flight = flown(text_of(scenarios() / "gto-nutating.toml"));
  SupervisedPass supervised{flight.mission, RunMode::Live};
  EXPECT_FALSE(supervised.serve(flight.sent).contains("spin.nutation"));
}

TEST(FalseAlarms, NoneInPassesOfASpinner) {
  std::mt19937_64 rng{2301};
  std::uniform_real_distribution<double> either{-1.0, 1.0};
  const std::string nominal = text_of(scenarios() / "gto-nominal.toml");
  for (int pass = 0; pass < kPasses; ++pass) {
    const double ra_deg = 100.0 + 4.0 * either(rng);
    const double dec_deg = -55.0 + 4.0 * either(rng);
    const double rpm = 60.0 + 20.0 * either(rng);
    std::string text = replaced(nominal, "duration_s = 600.0",
                                fmt::format("duration_s = 600.0\nseed = {}", pass + 1));
    text = replaced(text, "ra_deg = 100.0", fmt::format("ra_deg = {}", ra_deg));
    text = replaced(text, "dec_deg = -55.0", fmt::format("dec_deg = {}", dec_deg));
    text = replaced(text, "rate_rpm = 60.0", fmt::format("rate_rpm = {}", rpm));
    const auto flight = flown(
        text,
        fmt::format("\n[spin.target]\nra_deg = {}\ndec_deg = {}\nrpm = {}\ntolerance_rpm = 0.5\n",
                    ra_deg, dec_deg, rpm));
    SupervisedPass supervised{flight.mission, RunMode::Process};
    expect_none(supervised.process(flight.sent), flight.sent.front().came, pass);
    if (pass % kServed == 0) {
      expect_none_but_the_end(flight, pass);
    }
  }
}

TEST(FalseAlarms, NoneInPassesOfAThreeAxisSpacecraft) {
  std::mt19937_64 rng{2302};
  std::uniform_real_distribution<double> either{-1.0, 1.0};
  for (int pass = 0; pass < kPasses; ++pass) {
    std::string text = replaced(three_axis_text(), "seed = 22", fmt::format("seed = {}", pass + 1));
    text =
        replaced(text, "rate_deg_s = [0.62, -0.33, 0.066]",
                 fmt::format("rate_deg_s = [{}, {}, {}]", either(rng), either(rng), either(rng)));
    const auto flight = flown(text);
    SupervisedPass supervised{flight.mission, RunMode::Process};
    expect_none(supervised.process(flight.sent), flight.sent.front().came, pass);
    if (pass % kServed == 0) {
      expect_none_but_the_end(flight, pass);
    }
  }
}

}  // namespace spindrift::testing::false_alarms_test
