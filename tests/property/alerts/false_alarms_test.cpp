#include <fmt/format.h>
#include <gtest/gtest.h>

#include <algorithm>
#include <random>

#include "pipelines/frames/angle.h"
#include "pipelines/frames/celestial.h"
#include "pipelines/spin/planning/pass_plan.h"
#include "tests/property/alerts/supervised_pass.h"

namespace spindrift::testing::false_alarms_test {

constexpr int kPasses = 100;
constexpr int kSeeds = 10;
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

struct SpinDraw {
  std::string text;
  Eigen::Vector3d axis_icrf;
  double rate_rad_s;
};

/// Draws an orbit of some hours, sensors, and an axis at which a beam mostly crosses the Earth.
SpinDraw any_spin(std::mt19937_64& rng, int seed) {
  const auto draw = [&](double low, double high) {
    return std::uniform_real_distribution<double>{low, high}(rng);
  };
  const double ra_deg = draw(0.0, 360.0);
  const double dec_deg = draw(-90.0, 90.0);
  const double rpm = draw(30.0, 100.0);
  const double north_deg = draw(70.0, 95.0);
  std::string text = text_of(scenarios() / "gto-nominal.toml");
  const auto set = [&](const std::string& line, const std::string& key, double value) {
    text = replaced(text, line, fmt::format("{} = {:.6f}", key, value));
  };
  text = replaced(text, "duration_s = 600.0", fmt::format("duration_s = 400.0\nseed = {}", seed));
  set("a_km = 24400.0", "a_km", draw(12000.0, 42000.0));
  set("e = 0.73", "e", draw(0.0, 0.4));
  set("i_deg = 28.5", "i_deg", draw(0.0, 110.0));
  set("raan_deg = 300.0", "raan_deg", draw(0.0, 360.0));
  set("argp_deg = 178.0", "argp_deg", draw(0.0, 360.0));
  set("mean_anomaly_deg = 30.0", "mean_anomaly_deg", draw(0.0, 360.0));
  set("ra_deg = 100.0", "ra_deg", ra_deg);
  set("dec_deg = -55.0", "dec_deg", dec_deg);
  set("rate_rpm = 60.0", "rate_rpm", rpm);
  set("slit_cant_deg = 45.0", "slit_cant_deg", draw(25.0, 60.0));
  set("slit_separation_deg = 35.0", "slit_separation_deg", draw(-60.0, 60.0));
  set("mount_angle_deg = 85.0", "mount_angle_deg", north_deg);
  set("azimuth_deg = 90.0", "azimuth_deg", draw(0.0, 360.0));
  set("mount_angle_deg = 95.0", "mount_angle_deg", north_deg + draw(-5.0, 20.0));
  set("azimuth_deg = 92.0", "azimuth_deg", draw(0.0, 360.0));
  return {
      .text = text,
      .axis_icrf = direction_icrf({.ra_rad = ra_deg * kRadPerDeg, .dec_rad = dec_deg * kRadPerDeg}),
      .rate_rad_s = rpm / kRpmPerRad_s};
}

/// Returns whether `geometry` predicts that every turn of the pass gives one axis.
bool has_answer(const Flight& flight, const SpinDraw& drawn) {
  const auto plan = plan_pass(*flight.mission.spin(), *flight.mission.orbit,
                              {.from = flight.sent.front().came,
                               .to = flight.sent.back().came,
                               .step_s = 20.0,
                               .axis_icrf = drawn.axis_icrf,
                               .rate_rad_s = drawn.rate_rad_s});
  return plan && std::ranges::all_of(
                     plan->steps, [](const PassStep& step) { return step.geometry.fix.axes == 1; });
}

TEST(FalseAlarms, NoneInPassesOfAnyGeometryThatHasAnAnswer) {
  std::mt19937_64 rng{2303};
  int seed = 0;
  for (int pass = 0; pass < kPasses;) {
    const SpinDraw drawn = any_spin(rng, ++seed);
    const Flight flight = flown(drawn.text);
    if (flight.sent.empty() || !has_answer(flight, drawn)) {
      continue;
    }
    SupervisedPass supervised{flight.mission, RunMode::Process};
    expect_none(supervised.process(flight.sent), flight.sent.front().came, seed);
    ++pass;
  }
  RecordProperty("drawn", seed);
}

/// The passes of deploy/scenarios as they are flown without a fault, at other seeds.
TEST(FalseAlarms, NoneInTheScenariosOfOtherSeeds) {
  const auto without_faults = [](std::string text) {
    return text.substr(0, std::min(text.find("[truth"), text.find("[faults")));
  };
  const std::string day =
      replaced(text_of(scenarios() / "geo-day.toml"), "duration_s = 86400.0", "duration_s = 600.0");
  const std::string separation =
      replaced(without_faults(text_of(scenarios() / "separation.toml")), "seed = 22\n", "");
  const std::string tumbling =
      replaced(replaced(without_faults(text_of(scenarios() / "tumbling.toml")), "seed = 5\n", ""),
               "first_star_fix_s = 1200.0", "first_star_fix_s = 0.0");
  // Edges that interfere are a fault of the link, and a nutation is one of the body.
  const std::string dirty =
      replaced(replaced(without_faults(text_of(scenarios() / "gto-dirty.toml")), "seed = 7\n", ""),
               "interference_s = 0.002", "interference_s = 0.0");
  for (const std::string& text :
       {day, separation, tumbling, dirty, text_of(scenarios() / "upper-stage.toml")}) {
    for (int seed = 1; seed <= kSeeds; ++seed) {
      const Flight flight = flown(replaced(text, "[pass]", fmt::format("[pass]\nseed = {}", seed)));
      SCOPED_TRACE(flight.mission.spacecraft_id);
      SupervisedPass supervised{flight.mission, RunMode::Process};
      expect_none(supervised.process(flight.sent), flight.sent.front().came, seed);
    }
  }
}

}  // namespace spindrift::testing::false_alarms_test
