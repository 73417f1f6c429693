#include <fmt/format.h>

#include <filesystem>
#include <nlohmann/json.hpp>
#include <ostream>
#include <string>
#include <vector>

#include "services/publisher/product_messages.h"
#include "tests/support/archive_rows.h"
#include "tests/support/bus_fixture.h"
#include "tests/support/exact_mission.h"
#include "tests/support/lines.h"
#include "tests/support/matchers.h"
#include "tests/support/on_bus.h"
#include "tests/support/processed.h"
#include "tests/support/ran.h"
#include "tests/support/recorded_files.h"
#include "tests/support/simulated.h"
#include "tests/support/subscriber.h"
#include "tests/support/test_paths.h"
#include "tests/support/text_of.h"
#include "tests/support/three_axis_files.h"

namespace spindrift::three_axis_test {

const std::filesystem::path kSeparation = test_data() / "three-axis" / "separation";

constexpr const char* kAllSamples =
    "SELECT (SELECT count(*) FROM gyro_sample), (SELECT count(*) FROM sun_sample), (SELECT "
    "count(*) FROM star_sample)";
const std::vector<std::string> kWholePass{"961|223|1|"};

Ran process_files(const std::filesystem::path& telemetry, const std::filesystem::path& db) {
  return succeeded(arguments(kSeparation / "mission.toml", telemetry, db));
}

TEST(ThreeAxis, ProcessStoresEverySampleAsItWasReceivedAndTheAttitudeOfItsStarFix) {
  const Processed outcome{kSeparation};
  EXPECT_EQ(outcome.run["kind"], "three_axis");
  EXPECT_EQ(outcome.run["samples_received"],
            nlohmann::json({{"gyro_samples", 961}, {"sun_vectors", 223}, {"star_fixes", 1}}));
  EXPECT_EQ(rows_of(outcome.db, kAllSamples), kWholePass);
  EXPECT_THAT(rows_of(outcome.db,
                      "SELECT spacecraft_id, t_tai_ns, source, seq, printf('%.12g', qx), "
                      "printf('%.12g', qw) FROM star_sample"),
              ElementsAre("LEOSAT|1772337937000000000|star.csv|2|-0.487081521215|0.16712265087|"));
  EXPECT_EQ(count_rows(outcome.db, "run WHERE finished_utc IS NOT NULL"), 1);
  EXPECT_EQ(number_of(outcome.db, "SELECT first_tai_ns FROM run"), 1772337697000000000);
  const nlohmann::json& attitude = outcome.run["attitude"];
  EXPECT_EQ(attitude["quality"], "CONVERGING");
  EXPECT_EQ(attitude["utc"], "2026-03-01T04:05:00.000Z");
  EXPECT_NEAR(attitude["noise_sigma_deg"], std::sqrt(3.0) * 20.0 / 3600.0, 1e-9);
  // The mounting of the star tracker adds 0.01 deg about each axis, its time tag next to nothing.
  EXPECT_NEAR(attitude["sigma_deg"], std::sqrt(3.0) * std::hypot(20.0 / 3600.0, 0.01), 1e-6);
  EXPECT_EQ(outcome.run["sensors"]["sun"]["accepted"], 223);
  EXPECT_EQ(outcome.run["sensors"]["sun"]["rejected"], nlohmann::json::object());
  EXPECT_THAT(
      rows_of(outcome.db, "SELECT estimator, quality, ra_deg IS NULL, qw, why FROM pass_verdict"),
      ElementsAre(fmt::format("mekf|CONVERGING|1|{:a}|CONVERGING; 0.017 of 0.02 deg is alignment|",
                              attitude["qw"].get<double>())));

  // The samples of a second run are stored once.
  process_files(kSeparation, outcome.db);
  EXPECT_EQ(rows_of(outcome.db, kAllSamples), kWholePass);
  EXPECT_EQ(count_rows(outcome.db, "run"), 2);
}

TEST(ThreeAxis, SunAndMagnetometerGiveTheAttitudeBeforeTheFirstStarFix) {
  const Simulated simulated{
      "separation.toml",
      {},
      "[three_axis.magnetometer]\nnoise_nt = 100\n" + std::string{kExactThreeAxis}};
  const Processed outcome{simulated.pass};
  const auto truth = nlohmann::json::parse(text_of(simulated.pass / "truth.json"));
  const auto acquisition = truth["T3"]["t_tai_ns"].get<std::int64_t>();
  const auto first_fix = truth["T4"]["t_tai_ns"].get<std::int64_t>();
  const std::string mekf = " FROM attitude WHERE source = 'mekf'";
  EXPECT_LT(number_of(outcome.db, "SELECT min(t_tai_ns)" + mekf), acquisition + 5'000'000'000);

  // The last attitude before the first star fix is compared with the truth at T4.
  const auto& q = truth["T4"]["q_icrf_body_xyzw"];
  const std::vector<std::string> last = rows_of(
      outcome.db, fmt::format("SELECT quality, {} - t_tai_ns < 300000000, 2 * degrees(acos(abs(qx "
                              "* {} + qy * {} + qz * {} + qw * {}))) < 4 * sigma_deg, sigma_deg < "
                              "0.5 {} AND t_tai_ns < {} ORDER BY t_tai_ns DESC LIMIT 1",
                              first_fix, q[0].get<double>(), q[1].get<double>(), q[2].get<double>(),
                              q[3].get<double>(), mekf, first_fix));
  EXPECT_THAT(last, ElementsAre("OK|1|1|1|"));
  EXPECT_GT(outcome.run["sensors"]["magnetometer"]["accepted"], 200);
  EXPECT_EQ(outcome.run["sensors"]["magnetometer"]["rejected"], nlohmann::json::object());
}

/// The ground sees by its own telemetry when the simulated satellite is lost, and when it is back.
TEST(ThreeAxis, TheGroundSeesWhenASatelliteIsLostAndRescued) {
  const Simulated simulated{"rescue.toml"};
  const auto truth = nlohmann::json::parse(text_of(simulated.pass / "truth.json"));
  const auto start = truth["start"]["t_tai_ns"].get<std::int64_t>();
  const double failed_s = 600.0;
  EXPECT_GT(truth["lost_s"], failed_s);
  EXPECT_GT(truth["control_s"].get<double>(), truth["lost_s"].get<double>() + 600.0);
  EXPECT_GT(truth["reached_s"], truth["control_s"]);
  EXPECT_LT(truth["filter_off_deg"], 5.0);
  EXPECT_LT(truth["last_off_deg"], 6.0);
  const Processed outcome{simulated.pass};
  const auto first = [&](int open) {
    return 1e-9 * static_cast<double>(
                      number_of(outcome.db, fmt::format("SELECT min(t_tai_ns) - {} FROM "
                                                        "gate_transition WHERE gate = 'lost' AND "
                                                        "open = {}",
                                                        start, open)));
  };
  EXPECT_NEAR(first(1), truth["lost_s"].get<double>(), 20.0);
  EXPECT_GT(first(0), first(1));
  EXPECT_TRUE(outcome.run["advisory"].is_null()) << "it is back";
  EXPECT_GT(count_rows(outcome.db, "advisory"), 0);
}

/// Returns what an archive holds of a pass, without its runs.
std::vector<std::string> pass_rows(const std::filesystem::path& db) {
  return rows_of(
      db,
      std::vector<std::string>{
          "SELECT t_tai_ns, source, qx, qy, qz, qw, rate_x_rad_s, rate_y_rad_s, rate_z_rad_s, "
          "sigma_deg, quality, reasons, status FROM attitude ORDER BY 1",
          "SELECT t_tai_ns, kind, rejected_by, squared_innovation FROM rejected_sample ORDER "
          "BY 1, 2",
          "SELECT spacecraft_id, finished, estimator, quality, qx, sigma_deg, why FROM "
          "pass_verdict",
          "SELECT t_tai_ns, gate, open, evidence FROM gate_transition ORDER BY 1, 2",
          "SELECT t_tai_ns, sensors, qx, sigma_deg, rate_x_rad_s, says FROM advisory ORDER BY 1",
          kAllSamples});
}

/// Returns the time of the last attitude that a late subscriber receives.
std::int64_t last_on(const bus::BusConfig& bus) {
  const Subscriber attitudes{bus, product_topic<AttitudeEstimate>()};
  const auto taken = take_samples(attitudes.reader(), 1);
  return taken.empty() ? 0 : taken.front().t_tai_ns;
}

TEST(ThreeAxis, ServeGivesWhatProcessGivesAlsoWhenItIsKilledInThePass) {
  const TemporaryFolder pass;
  testing::write_three_axis_pass(pass.path(), {.commanded_deg = 40.0});
  const Processed outcome{pass.path()};
  const std::vector<std::string> expected = pass_rows(outcome.db);
  EXPECT_THAT(rows_of(outcome.db,
                      "SELECT open, evidence ->> 'threshold', evidence ->> 'window', evidence ->> "
                      "'hits' > 6 AND evidence ->> 'value' > 5, evidence ->> 'certain' FROM "
                      "gate_transition WHERE gate = 'lost' LIMIT 1"),
              ElementsAre("1|0x1.4p+2|10|1|1|"));
  EXPECT_THAT(rows_of(outcome.db, "SELECT message FROM alert WHERE key = 'attitude.lost'"),
              ElementsAre(HasSubstr("the lost gate is open")));
  const nlohmann::json& advisory = outcome.run["advisory"];
  EXPECT_EQ(advisory["sensors"]["star"], "speaks");
  EXPECT_EQ(advisory["may_control"], false);
  EXPECT_LT(advisory["sigma_deg"], 1.0);
  EXPECT_THAT(advisory["says"].get<std::string>(), StartsWith("body lost, by field and Sun: "));
  EXPECT_THAT(outcome.run["verdict"]["why"].get<std::string>(), StartsWith("body lost, "));
  const std::int64_t last = number_of(outcome.db, "SELECT max(t_tai_ns) FROM attitude");
  ASSERT_EQ(count_rows(outcome.db, "rejected_sample"), 2);
  ASSERT_EQ(outcome.run["attitude"]["quality"], "OK");

  ReadyService service{pass.path().string(), "replay"};
  const std::int64_t middle = last - 30'000'000'000;
  for (const bool first : {true, false}) {
    const TemporaryFolder half;
    testing::write_half(pass.path(), middle, first, half.path());
    succeeded(service.words({"replay", "--telemetry", half.path(), "--speed", "0"}));
    const std::int64_t reached = first ? middle - 2'000'000'000 : last;
    ASSERT_TRUE(eventually(
        [&] { return number_of(service.db(), "SELECT max(t_tai_ns) FROM attitude") >= reached; }));
    if (first) {
      ASSERT_TRUE(eventually([&] {
        return three_axis_samples_before(service.db(), middle) ==
               three_axis_samples_before(outcome.db, middle);
      }));
      service.kill_and_go_on();
    }
  }
  EXPECT_TRUE(eventually([&] { return last_on(service.bus()) == last; }));
  ASSERT_EQ(service.stop(), 0) << service.log();
  EXPECT_THAT(service.log(), HasSubstr("continuing run"));
  EXPECT_THAT(service.log(), HasSubstr("attitude ICRF to body, Euler 3-1-2"));
  EXPECT_EQ(pass_rows(service.db()), expected);
  const auto summary = service.summary()["runs"][0];
  EXPECT_EQ(summary["attitude"], outcome.run["attitude"]);
  EXPECT_EQ(summary["advisory"], outcome.run["advisory"]);
  EXPECT_EQ(summary["sensors"], outcome.run["sensors"]);
}

TEST(ThreeAxis, BadRowsAreStoredWithTheirReasonAndTheOthersTakenInAnyOrder) {
  const TemporaryFolder folder;
  const TemporaryFolder telemetry;
  telemetry.write("gyro.csv",
                  "t_tai_ns,wx_rad_s,wy_rad_s,wz_rad_s\n"
                  "1772337697500000000,0.1,0,0\n"
                  "1772337697000000000,0.2,0,0\n"
                  "1772337697000000000,0.3,0,0\n"  // Second value for the same time.
                  "1772337697250000000,nan,0,0\n"
                  "1772337697250000000,17.5,0,0\n"
                  "12,0,0,0\n"
                  "1772337697250000000,0,0\n");
  telemetry.write("star.csv", "t_tai_ns,qx,qy,qz,qw\n1772337698000000000,0,0,0,1.002\n");
  telemetry.write("sun.csv", "t_tai_ns,sx,sy,sz\n1772337698000000000,0,0,0\n");
  const auto db = folder.path() / "out.db";
  const Ran program = process_files(telemetry.path(), db);
  EXPECT_THAT(rows_of(db, "SELECT t_tai_ns, printf('%g', wx_rad_s) FROM gyro_sample"),
              ElementsAre("1772337697000000000|0.2|", "1772337697500000000|0.1|"));
  EXPECT_THAT(rows_of(db, kAllSamples), ElementsAre("2|0|0|"));
  EXPECT_EQ(count_rows(db, "rejected_input"), 6);
  EXPECT_THAT(rows_of(db, "SELECT line FROM rejected_input WHERE source LIKE '%gyro.csv'"),
              ElementsAre("5|", "6|", "7|", "8|"));
  EXPECT_THAT(program.log, HasSubstr("must have length 1 within 0.001"));
}

/// Names a kind of telemetry whose sensor the mission file lacks.
struct Sensorless {
  const char* file;
  const char* header;
  const char* fields;  ///< Fields of every row after its time.
  const char* sensors;
  const char* table;
  const char* warning;
};

void PrintTo(const Sensorless& kind, std::ostream* out) { *out << kind.table; }

constexpr const char* kGyro = "[three_axis.gyro]\nnoise_deg_s = 0.002\nbias_sigma_deg_s = 0.01\n";
constexpr const char* kSunSensor = "[three_axis.sun_sensor]\nnoise_deg = 0.5\n";

class AKindWithoutSensor : public ::testing::TestWithParam<Sensorless> {};

TEST_P(AKindWithoutSensor, IsStoredAndSaidOnce) {
  const Sensorless& kind = GetParam();
  const TemporaryFolder folder;
  const TemporaryFolder telemetry;
  const auto mission = folder.write(
      "mission.toml",
      std::string{"[spacecraft]\nid = \"SAT\"\nkind = \"three_axis\"\n"} + kind.sensors);
  std::string csv = kind.header;
  for (int i = 0; i < 1000; ++i) {
    csv += fmt::format("{},{}\n", 1772337697000000000 + i * std::int64_t{1000000}, kind.fields);
  }
  telemetry.write(kind.file, csv);
  const auto db = folder.path() / "out.db";
  const Ran program =
      succeeded({"process", "--mission", mission, "--telemetry", telemetry.path(), "--db", db});
  EXPECT_EQ(count_rows(db, kind.table), 1000);
  expect_said_once(program.log, kind.warning);
}

INSTANTIATE_TEST_SUITE_P(
    Each, AKindWithoutSensor,
    ::testing::Values(
        Sensorless{"pulses.csv", "t_tai_ns,channel\n", "sun1", kGyro, "pulse",
                   "SAT: edges arrive, and the mission file has no [spin.sun_sensor]"},
        Sensorless{"gyro.csv", "t_tai_ns,wx_rad_s,wy_rad_s,wz_rad_s\n", "0,0,0", kSunSensor,
                   "gyro_sample",
                   "SAT: gyro samples arrive, and the mission file has no [three_axis.gyro]"},
        Sensorless{"sun.csv", "t_tai_ns,sx,sy,sz\n", "0,0,1", kGyro, "sun_sample",
                   "SAT: sun vectors arrive, and the mission file has no [three_axis.sun_sensor]"},
        Sensorless{"star.csv", "t_tai_ns,qx,qy,qz,qw\n", "0,0,0,1", kGyro, "star_sample",
                   "SAT: star fixes arrive, and the mission file has no [three_axis.star_tracker]"},
        Sensorless{"magnetometer.csv", "t_tai_ns,bx_nt,by_nt,bz_nt\n", "0,0,30000", kGyro,
                   "magnetometer_sample",
                   "SAT: magnetometer samples arrive, and the mission file has no "
                   "[three_axis.magnetometer]"}));

TEST(ThreeAxis, NormsWithinATenthOfAPercentAreStoredAsReceivedAndChangeNoAttitude) {
  const auto attitudes = [](const std::filesystem::path& pass, const TemporaryFolder& folder) {
    process_files(pass, folder.path() / "out.db");
    return rows_of(folder.path() / "out.db",
                   "SELECT t_tai_ns, source, quality, printf('%.6f %.6f %.6f %.6f %.6f', qx, qy, "
                   "qz, qw, sigma_deg) FROM attitude ORDER BY 1, 2");
  };
  const TemporaryFolder unit;
  const TemporaryFolder scaled;
  const TemporaryFolder telemetry;
  telemetry.write("gyro.csv", text_of(kSeparation / "gyro.csv"));
  for (const char* file : {"sun.csv", "star.csv"}) {
    telemetry.write(file, with_rows(text_of(kSeparation / file), [](const std::string& row) {
                      return with_numbers(
                          row, [](double value) { return fmt::format("{:.12f}", value * 1.0009); });
                    }));
  }
  const std::vector<std::string> expected = attitudes(kSeparation, unit);
  ASSERT_FALSE(expected.empty());
  EXPECT_EQ(attitudes(telemetry.path(), scaled), expected);
  EXPECT_THAT(
      rows_of(
          scaled.path() / "out.db",
          "SELECT printf('%.6f', sqrt(qx * qx + qy * qy + qz * qz + qw * qw)) FROM star_sample"),
      ElementsAre("1.000900|"));
  EXPECT_THAT(
      rows_of(scaled.path() / "out.db",
              "SELECT DISTINCT printf('%.6f', sqrt(sx * sx + sy * sy + sz * sz)) FROM sun_sample"),
      ElementsAre("1.000900|"));
}

TEST(ThreeAxis, ServeGoesOnWithTheRunAfterAKillAndStoresWhatComesAgainOnce) {
  ReadyService service{kSeparation};
  const auto db = service.db();
  ASSERT_EQ(service.replay("0"), 0);
  ASSERT_TRUE(eventually([&] {
    return rows_of(db, kAllSamples) == kWholePass &&
           number_of(db, "SELECT sum(received) FROM source_count") == 1185;
  }));
  service.kill_and_go_on();
  EXPECT_THAT(service.log(), HasSubstr("1185 samples read back"));
  ASSERT_EQ(service.replay("0"), 0);
  ASSERT_EQ(service.stop(), 0) << service.log();
  EXPECT_THAT(service.log(), Not(HasSubstr("samples are missing")));
  EXPECT_EQ(rows_of(db, kAllSamples), kWholePass);
  EXPECT_EQ(count_rows(db, "run"), 1);
  EXPECT_EQ(number_of(db, "SELECT sum(received) FROM source_count"), 2 * 1185);
  EXPECT_EQ(number_of(db, "SELECT sum(gaps) FROM source_count"), 0);
}

}  // namespace spindrift::three_axis_test
