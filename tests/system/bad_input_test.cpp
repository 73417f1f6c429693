// Input that no pass should contain: the program reports it and invents no results. Bad rows and
// files of telemetry are in process_test.cpp.

#include <fmt/format.h>

#include <algorithm>
#include <array>
#include <fstream>
#include <nlohmann/json.hpp>
#include <set>
#include <sstream>
#include <string>
#include <string_view>
#include <utility>

#include "tests/support/altered_text.h"
#include "tests/support/archive_rows.h"
#include "tests/support/axis_error.h"
#include "tests/support/lines.h"
#include "tests/support/matchers.h"
#include "tests/support/processed.h"
#include "tests/support/ran.h"
#include "tests/support/simulated.h"

namespace spindrift::bad_input_test {

const nlohmann::json kTruth{{"ra_deg", 100.0}, {"dec_deg", -55.0}};

std::string nominal(const std::string& file) { return text_of(kPasses / "nominal" / file); }

/// Processes the nominal pass with another text of one of its files.
Processed nominal_with(const std::string& file, const std::string& text) {
  const PassCopy pass{"nominal"};
  pass.folder.write(file, text);
  return Processed{pass.folder.path()};
}

/// Expects no axis, and the log to say why.
void expect_no_axis(const Processed& outcome, const std::string& why) {
  EXPECT_THAT(outcome.log, HasSubstr(why));
  EXPECT_EQ(outcome.run["fixes_accepted"], 0);
  EXPECT_TRUE(outcome.run["mean"].is_null());
  EXPECT_TRUE(outcome.run["sequential"].is_null());
  EXPECT_EQ(count_rows(outcome.db, "spin_estimate"), 0);
  EXPECT_EQ(count_rows(outcome.db, "spin_fix WHERE accepted = 1"), 0);
  // Telemetry is stored even without a fix.
  EXPECT_EQ(count_rows(outcome.db, "pulse"), outcome.run["edges_received"]);
}

TEST(BadGeometry, WithSunAndEarthInOneLineGivesNoAxisAndSaysWhy) {
  // Local noon: seen from the geostationary orbit the Earth is opposite the Sun, which is then at
  // RA 235.14, Dec -19.58 deg.
  const Simulated simulated{"gto-nominal.toml",
                            {{"a_km = 24400.0", "a_km = 42164.0"},
                             {"e = 0.73", "e = 0.0"},
                             {"i_deg = 28.5", "i_deg = 90.0"},
                             {"raan_deg = 300.0", "raan_deg = 235.138"},
                             {"argp_deg = 178.0", "argp_deg = 0.0"},
                             {"anomaly_deg = 30.0", "anomaly_deg = -19.833"},
                             {"duration_s = 600.0", "duration_s = 120.0"},
                             {"ra_deg = 100.0", "ra_deg = 235.138"},
                             {"dec_deg = -55.0", "dec_deg = 70.417"}}};
  const Processed outcome{simulated.pass};
  expect_no_axis(outcome, "Sun and Earth stand 179.");
  EXPECT_EQ(outcome.run["fixes"], 0);
  EXPECT_GT(outcome.run["edges_accepted"], 700);

  const auto plot = simulated.folder.path() / "plan.svg";
  succeeded({"geometry", "--mission", simulated.mission(), "--from", "2026-11-20T03:00:00Z", "--to",
             "2026-11-20T03:02:00Z", "--attitude", "235.138,70.417", "--plot", plot});
  EXPECT_THAT(text_of(plot), HasSubstr("Sun, Earth in line"));
}

TEST(BadGeometry, WithChordsWiderThanTheEarthGivesNoAxisAndSaysWhy) {
  // The Earth's disc is 41.7 deg wide, and both beams pass near its middle.
  const Simulated simulated{"gto-nominal.toml",
                            {{"[spin.noise]",
                              "[truth.ir.north]\nchord_excess_deg = 10.0\n"
                              "[truth.ir.south]\nchord_excess_deg = 10.0\n[spin.noise]"}}};
  expect_no_axis(Processed{simulated.pass}, "contradict each other");
}

TEST(BadGeometry, WithABeamThatNeverMeetsTheEarthGivesNoAxisAndSaysWhy) {
  const Simulated simulated{"gto-nominal.toml",
                            {{"mount_angle_deg = 85.0", "mount_angle_deg = 20.0"},
                             {"mount_angle_deg = 95.0", "mount_angle_deg = 160.0"}}};
  const Processed outcome{simulated.pass};
  expect_no_axis(outcome, "a sun angle without a chord");
  EXPECT_EQ(outcome.run["fixes"], 0);
  EXPECT_EQ(count_rows(outcome.db, "pulse WHERE channel LIKE '%_in'"), 0);
}

TEST(BadGeometry, WithAMissionWhoseBeamsCannotMeetTheEarthSaysThatItContradictsTheTelemetry) {
  const Processed outcome = nominal_with(
      "mission.toml",
      replaced(nominal("mission.toml"), {{"mount_angle_deg = 85", "mount_angle_deg = 20"},
                                         {"mount_angle_deg = 95", "mount_angle_deg = 160"}}));
  expect_no_axis(outcome, "contradict each other");
  EXPECT_THAT(outcome.log, HasSubstr("check the mission's mounting angles"));
}

struct Missing {
  const char* channel;
  int main_case;  ///< Geometry case of nearly all revolutions with the other five channels.
};

TEST(MissingChannel, LeavesTheCaseThatTheOthersAllow) {
  // Without sun1 there is no dihedral and no sun angle, but sun2 gives the azimuth of both chords;
  // without sun2 there is no sun angle; with half a chord only the other beam's is left.
  for (const auto& [channel, main_case] : std::array<Missing, 6>{{{"sun1", 7},
                                                                  {"sun2", 4},
                                                                  {"north_in", 3},
                                                                  {"north_out", 3},
                                                                  {"south_in", 2},
                                                                  {"south_out", 2}}}) {
    SCOPED_TRACE(channel);
    const Processed outcome =
        nominal_with("pulses.csv", without_channel(channel, nominal("pulses.csv")));
    EXPECT_EQ(count_rows(outcome.db, "pulse_use"), 3000);
    EXPECT_GT(outcome.run["fixes_by_case"].value(std::to_string(main_case), 0), 570)
        << outcome.run["fixes_by_case"];
    for (const char* const estimator : {"mean", "sequential"}) {
      ASSERT_FALSE(outcome.run[estimator].is_null());
      const double sigma_deg = outcome.run[estimator]["noise_sigma_deg"].get<double>();
      EXPECT_LT(error_deg(outcome.run[estimator], kTruth), std::min(0.2, 3.0 * sigma_deg))
          << estimator;
      // Without a sun angle, the cones intersect well in the second half of the pass only.
      const bool is_poor = main_case == 4 && estimator == std::string_view{"mean"};
      EXPECT_LT(sigma_deg, is_poor ? 0.2 : 0.1) << estimator;
    }
  }
}

/// Processes the rows of the nominal pass for which `keep(channel, number)` is true.
template <class Keep>
Processed process_part(const Keep& keep) {
  int number = 0;
  return nominal_with("pulses.csv", with_rows(nominal("pulses.csv"), [&](const std::string& row) {
                        return keep(row.substr(row.find(',') + 1), ++number) ? row : "";
                      }));
}

TEST(OneSensor, AloneGivesNoAxisAndNoBatchSolutionAndSaysWhy) {
  const std::array<std::pair<std::string, std::string>, 3> sensors = {
      {{"sun", "a cone about the Sun"}, {"north", "cone"}, {"south", "cone"}}};
  for (const auto& [sensor, why] : sensors) {
    const Processed outcome = process_part(
        [&, &name = sensor](const std::string& channel, int) { return channel.starts_with(name); });
    SCOPED_TRACE(sensor);
    expect_no_axis(outcome, why);
    EXPECT_THAT(outcome.log, HasSubstr("no batch solution: "));
    std::set<std::string> codes;
    for (const auto& warning : outcome.answer["warnings"]) {
      codes.insert(warning["code"]);
      EXPECT_THAT(outcome.log, HasSubstr(warning["text"].get<std::string>()));
      EXPECT_EQ(warning["values"]["spacecraft"], "SPINNER");
    }
    EXPECT_THAT(codes, ::testing::IsSupersetOf({"no_axis", "no_batch_solution"}));
    EXPECT_EQ(count_rows(outcome.db, "spin_batch"), 0);
  }
}

/// Every fiftieth edge of a channel, displaced at random, does not make a usable channel, so no
/// axis may come of it.
TEST(MissingChannel, StraysOfADeadSensorGiveNoAxis) {
  const Processed outcome = process_part([](const std::string& channel, int row) {
    return !channel.starts_with("sun") || (channel.starts_with("sun2") && row % 331 == 7);
  });
  expect_no_axis(outcome, "no axis");
  EXPECT_GT(count_rows(outcome.db, "pulse_use WHERE channel = 'sun2'"), 0);
  EXPECT_EQ(number_of(outcome.db, "SELECT sum(accepted) FROM pulse_use WHERE channel = 'sun2'"), 0);
}

TEST(FewEdges, GiveNoBatchSolutionAndSayHowManyItNeeds) {
  const Processed outcome = process_part([](const std::string&, int row) { return row <= 15; });
  EXPECT_TRUE(outcome.run["batch"].is_null());
  EXPECT_THAT(outcome.log, HasSubstr("need more than"));
}

TEST(FewEdges, OnDemandAreRefusedWithTheReason) {
  const Processed outcome{"nominal"};
  const Ran batch = ended({"batch", "--mission", kPasses / "nominal" / "mission.toml", "--db",
                           outcome.db, "--last", "1"});
  EXPECT_NE(batch.status, 0);
  EXPECT_THAT(batch.log, HasSubstr("need more than"));
}

TEST(BadMission, IsRefusedWithAllItsTenMistakes) {
  expect_refused("mission.toml", R"([spacecraft]
id = "A,B"
kind = "spin"
colour = "red"
[orbit]
oem = "missing.oem"
[spin.sun_sensor]
slit_cant_deg = 95
slit_separation_dge = 35.0
[spin.ir.north]
mount_angle_deg = "85"
azimuth_deg = 900
[spin.screening]
window = 100.5
sigma = -1
[spin.horizon]
model = "flat"
co2_altitude_km = 40
)",
                 {"spacecraft.id", "spacecraft.colour", "orbit.oem", "slit_cant_deg",
                  "slit_separation_dge", "mount_angle_deg", "azimuth_deg", "screening.window",
                  "screening.sigma", "horizon.model", "[spin.noise]"});
}

TEST(ShortOrbit, GivesTheAxisWhereItReachesAndSaysFromWhereOnItDoesNot) {
  const std::string oem = nominal("orbit.oem");
  const Processed outcome = nominal_with(
      "orbit.oem",
      replaced(oem.substr(0, oem.find("2026-11-20T03:05:30.000 ")),
               {{"STOP_TIME = 2026-11-20T03:12:00.000", "STOP_TIME = 2026-11-20T03:05:00.000"}}));
  EXPECT_THAT(outcome.log, ::testing::ContainsRegex(
                               "2026-11-20T03:04:59.*Z: the orbit of the mission file does not "
                               "cover the revolution"));
  EXPECT_THAT(outcome.log,
              ::testing::ContainsRegex("revolutions outside it gave no axis, the last at "
                                       "2026-11-20T03:09:59.*Z"));
  // One of the 600 good sun1 edges is a 3-sigma outlier.
  EXPECT_EQ(outcome.run["revolutions"], 599);
  EXPECT_NEAR(outcome.run["fixes"].get<double>(), 300.0, 3.0);
  EXPECT_EQ(count_rows(outcome.db, "spin_fix WHERE t_tai_ns > 1795143937000000000"), 0);
  EXPECT_LT(error_deg(outcome.run["mean"], kTruth), 0.1);
}

/// Returns the nominal orbit displaced by `off_km` from 03:05:00 (line 31 of the file) on.
std::string spliced_orbit(double off_km) {
  std::string spliced;
  int number = 0;
  for (std::string line : lines_of(nominal("orbit.oem"))) {
    if (++number >= 31) {
      std::istringstream words{line};
      std::string time;
      double x_km = 0.0;
      std::string others;
      std::getline(words >> time >> x_km, others);
      line = fmt::format("{} {:.6f}{}", time, x_km + off_km, others);
    }
    spliced += line + "\n";
  }
  return spliced;
}

TEST(SplicedOrbit, IsWarnedOfByEveryCommandThatUsesIt) {
  const PassCopy pass{"nominal"};
  pass.folder.write("orbit.oem", spliced_orbit(18.0));
  const Ran process = succeeded(pass.arguments_here());
  // The distance to the Earth's centre is 15 124 km.
  const auto warns = HasSubstr(
      "mission.toml: orbit.oem = \"orbit.oem\", line 31: the orbit jumps by 18 km at "
      "2026-11-20T03:05:00.000Z: states of different solutions spliced? The nadir direction is off "
      "by up to 0.068 deg there");
  EXPECT_THAT(process.log, warns);
  EXPECT_THAT(succeeded({"batch", "--mission", pass.mission(), "--db", pass.db}).log, warns);
  EXPECT_THAT(succeeded({"geometry", "--mission", pass.mission(), "--from", "2026-11-20T03:00:00Z",
                         "--to", "2026-11-20T03:10:00Z", "--attitude", "100,-55"})
                  .log,
              warns);
}

TEST(SplicedOrbit, IsRefusedByLineWhereNoOrbitCouldBeSo) {
  expect_refused("orbit.oem", spliced_orbit(50.0), {"line 31: the orbit jumps: 50 km from"});
}

/// Returns the nominal orbit in two segments; from 03:05 on, the second is `faster_km_s` faster.
std::string stepped_orbit(double faster_km_s) {
  std::string meta;
  std::string first;
  std::string second;
  for (const std::string& line : lines_of(nominal("orbit.oem"))) {
    const bool is_state = line.starts_with("2026-11-20T");
    first += !is_state || line < "2026-11-20T03:05:00.5" ? line + "\n" : "";
    meta += line == "META_START" || (!meta.empty() && !is_state) ? line + "\n" : "";
    if (is_state && line > "2026-11-20T03:04:59.5") {
      std::istringstream words{line};
      std::string time;
      std::array<double, 6> state{};  // Position, km, and velocity, km/s.
      words >> time;
      for (double& component : state) {
        words >> component;
      }
      // The states are 30 s apart.
      const auto states = std::count(second.begin(), second.end(), '\n');
      state[2] += 30.0 * static_cast<double>(states) * faster_km_s;
      state[5] += faster_km_s;
      second += fmt::format("{} {}\n", time, fmt::join(state, " "));
    }
  }
  return first + meta + second;
}

TEST(OrbitWithAStep, IsWarnedOfAndWhatRestsOnBothSidesIsDoubtful) {
  for (const double faster_km_s : {0.0, 0.12}) {
    const Processed outcome = nominal_with("orbit.oem", stepped_orbit(faster_km_s));
    const bool steps = faster_km_s > 0.0;
    EXPECT_EQ(outcome.log.find("two segments do not meet at 2026-11-20T03:05:00.000Z: by 0.000 km "
                               "and 120.00 m/s") != std::string::npos,
              steps)
        << outcome.log;
    for (const std::string estimator : {"mean", "sequential", "batch"}) {
      EXPECT_EQ(count_rows(outcome.db,
                           "spin_estimate WHERE quality = 'OK' AND t_tai_ns > 1795143937000000000 "
                           "AND estimator = '" +
                               estimator + "'") == 0,
                steps)
          << estimator;
    }
  }
}

TEST(OrbitWithAHole, IsWarnedOfAndGivesNoAxisThere) {
  // The pass contains the perigee at 03:26.
  const Simulated simulated{"gto-nominal.toml",
                            {{"duration_s = 600.0", "duration_s = 3600.0"},
                             {"mean_anomaly_deg = 30.0", "mean_anomaly_deg = 345.0"},
                             {"rate_rpm = 60.0", "rate_rpm = 30.0"}}};
  std::string holed;
  for (const std::string& line : lines_of(text_of(simulated.pass / "orbit.oem"))) {
    const bool left_out = line > "2026-11-20T03:15:00.5" && line < "2026-11-20T03:44:59.5";
    holed += left_out ? "" : line + "\n";
  }
  std::ofstream{simulated.pass / "orbit.oem"} << holed;
  const Processed outcome{simulated.pass};
  EXPECT_THAT(outcome.log,
              HasSubstr("mission.toml: orbit.oem = \"orbit.oem\", line 43: no orbit for 1800 s "
                        "before it, from 2026-11-20T03:15:00.000Z to 2026-11-20T03:45:00.000Z"));
  // The interval is 03:15:00 to 03:45:00, less a revolution at either end.
  EXPECT_EQ(
      count_rows(outcome.db,
                 "spin_fix WHERE t_tai_ns BETWEEN 1795144539000000000 AND 1795146335000000000"),
      0);
  EXPECT_GT(outcome.run["fixes_accepted"], 400);
  EXPECT_LT(error_deg(outcome.run["mean"], kTruth), 0.1);
  EXPECT_LT(error_deg(outcome.run["sequential"], kTruth), 0.1);
}

TEST(AbsurdTimes, ThatCouldBeTrueLeaveTheOtherProductsAlone) {
  // The stamps are in the years 1980 and 2099, and a day ahead.
  const Processed outcome =
      nominal_with("more.csv",
                   "t_tai_ns,channel\n315532819000000000,sun2\n"
                   "4070908837000000000,sun1\n1795230037000000000,north_in\n");
  EXPECT_EQ(outcome.run["input_rejected"], 0);
  EXPECT_EQ(count_rows(outcome.db, "pulse"), 3603);
  EXPECT_EQ(count_rows(outcome.db,
                       "pulse_use WHERE accepted = 0 AND t_tai_ns IN (315532819000000000, "
                       "4070908837000000000, 1795230037000000000)"),
            3);
  // One of the 600 good sun1 edges is a 3-sigma outlier.
  EXPECT_EQ(outcome.run["revolutions"], 599);
  EXPECT_LT(error_deg(outcome.run["mean"], kTruth), 0.05);
  EXPECT_LT(error_deg(outcome.run["sequential"], kTruth), 0.05);
}

}  // namespace spindrift::bad_input_test
