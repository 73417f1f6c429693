// A three-axis spacecraft through the program: its samples are stored, its runs are made.

#include <gmock/gmock.h>
#include <gtest/gtest.h>

#include <csignal>
#include <filesystem>
#include <nlohmann/json.hpp>
#include <string>
#include <vector>

#include "tests/support/archive_rows.h"
#include "tests/support/bus_fixture.h"
#include "tests/support/processed_pass.h"
#include "tests/support/program.h"
#include "tests/support/test_paths.h"
#include "tests/support/text_of.h"

namespace spindrift::three_axis_test {

using ::testing::HasSubstr;
using ::testing::Not;

const std::filesystem::path kSeparation = test_data() / "three-axis" / "separation";
const std::string kMission = (kSeparation / "mission.toml").string();

constexpr const char* kAllSamples =
    "SELECT (SELECT count(*) FROM gyro_sample), (SELECT count(*) FROM sun_sample),"
    " (SELECT count(*) FROM star_sample)";
const std::vector<std::string> kWholePass{"961|223|1|"};

Program process_files(const std::filesystem::path& telemetry, const std::filesystem::path& db) {
  return Program{{"process", "--mission", kMission, "--telemetry", telemetry.string(), "--db",
                  db.string(), "--json"}};
}

TEST(ThreeAxis, ProcessStoresEverySampleAsItWasReceived) {
  const TemporaryFolder folder;
  const Outcome outcome = process(folder, kSeparation);
  ASSERT_EQ(outcome.status, 0) << outcome.log;
  EXPECT_EQ(outcome.run["kind"], "three_axis");
  EXPECT_EQ(outcome.run["samples_received"],
            nlohmann::json({{"gyro_samples", 961}, {"sun_vectors", 223}, {"star_fixes", 1}}));
  EXPECT_EQ(rows_of(outcome.db, kAllSamples), kWholePass);
  EXPECT_EQ(rows_of(outcome.db,
                    "SELECT spacecraft_id, t_tai_ns, source, seq, printf('%.12g', qx),"
                    " printf('%.12g', qw) FROM star_sample"),
            std::vector<std::string>{
                "LEOSAT|1772337937000000000|star.csv|2|-0.487081521215|0.16712265087|"});
  EXPECT_EQ(number_of(outcome.db, "SELECT count(*) FROM run WHERE finished_utc IS NOT NULL"), 1);
  EXPECT_EQ(number_of(outcome.db, "SELECT first_tai_ns FROM run"), 1772337697000000000);
}

TEST(ThreeAxis, SamplesOfASecondRunAreStoredOnce) {
  const TemporaryFolder folder;
  for (int run = 1; run <= 2; ++run) {
    EXPECT_EQ(process(folder, kSeparation).status, 0);
    EXPECT_EQ(rows_of(folder.path() / "out.db", kAllSamples), kWholePass);
  }
  EXPECT_EQ(number_of(folder.path() / "out.db", "SELECT count(*) FROM run"), 2);
}

TEST(ThreeAxis, BadRowsAreStoredWithTheirReasonAndTheOthersTakenInAnyOrder) {
  const TemporaryFolder folder;
  const TemporaryFolder telemetry;
  telemetry.write("gyro.csv",
                  "t_tai_ns,wx_rad_s,wy_rad_s,wz_rad_s\n"
                  "1772337697500000000,0.1,0,0\n"
                  "1772337697000000000,0.2,0,0\n"
                  "1772337697000000000,0.3,0,0\n"  // Again.
                  "1772337697250000000,nan,0,0\n"
                  "1772337697250000000,17.5,0,0\n"
                  "12,0,0,0\n"
                  "1772337697250000000,0,0\n");
  telemetry.write("star.csv", "t_tai_ns,qx,qy,qz,qw\n1772337698000000000,0,0,0,1.002\n");
  telemetry.write("sun.csv", "t_tai_ns,sx,sy,sz\n1772337698000000000,0,0,0\n");
  const auto db = folder.path() / "out.db";
  Program program = process_files(telemetry.path(), db);
  ASSERT_EQ(program.exit_status(), 0) << program.log();
  EXPECT_EQ(rows_of(db, "SELECT t_tai_ns, printf('%g', wx_rad_s) FROM gyro_sample"),
            (std::vector<std::string>{"1772337697000000000|0.2|", "1772337697500000000|0.1|"}));
  EXPECT_EQ(rows_of(db, kAllSamples), std::vector<std::string>{"2|0|0|"});
  EXPECT_EQ(number_of(db, "SELECT count(*) FROM rejected_input"), 6);
  EXPECT_EQ(rows_of(db, "SELECT line FROM rejected_input WHERE source LIKE '%gyro.csv'"),
            (std::vector<std::string>{"5|", "6|", "7|", "8|"}));
  EXPECT_THAT(program.log(), HasSubstr("must have length 1 within 0.001"));
}

TEST(ThreeAxis, AKindThatTheMissionDescribesNoSensorForIsStoredAndSaidOnce) {
  const TemporaryFolder folder;
  const TemporaryFolder telemetry;
  std::string csv = "t_tai_ns,channel\n";
  for (int i = 0; i < 1000; ++i) {
    csv += std::to_string(1772337697000000000 + i * 1000000) + ",sun1\n";
  }
  telemetry.write("pulses.csv", csv);
  const auto db = folder.path() / "out.db";
  Program program = process_files(telemetry.path(), db);
  ASSERT_EQ(program.exit_status(), 0) << program.log();
  EXPECT_EQ(number_of(db, "SELECT count(*) FROM pulse"), 1000);
  const std::string words = "LEOSAT: edges arrive, and the mission file has no [spin.sun_sensor]";
  const std::size_t first = program.log().find(words);
  ASSERT_NE(first, std::string::npos) << program.log();
  EXPECT_EQ(program.log().find(words, first + 1), std::string::npos);
}

TEST(ThreeAxis, ServeGoesOnWithTheRunAfterAKillAndStoresWhatComesAgainOnce) {
  const TemporaryFolder folder;
  const auto db = folder.path() / "served.db";
  const bus::BusConfig bus = bus_of_its_own();
  const auto on_bus = [&bus](std::vector<std::string> arguments) {
    arguments.insert(arguments.end(), {"--mission", kMission, "--domain",
                                       std::to_string(bus.domain), "--partition", bus.partition});
    return arguments;
  };
  const auto replay = [&] {
    Program sending{on_bus({"replay", "--telemetry", kSeparation.string(), "--speed", "0"})};
    EXPECT_EQ(sending.exit_status(), 0) << sending.log();
  };
  {
    Program service{on_bus({"serve", "--db", db.string()})};
    ASSERT_TRUE(service.says("ready")) << service.log();
    replay();
    ASSERT_TRUE(eventually([&] { return rows_of(db, kAllSamples) == kWholePass; }));
    service.signal(SIGKILL);
    service.exit_status();
  }
  Program service{on_bus({"serve", "--db", db.string()})};
  ASSERT_TRUE(service.says("ready")) << service.log();
  EXPECT_THAT(service.log(), HasSubstr("1185 samples read back"));
  replay();
  service.signal(SIGTERM);
  ASSERT_EQ(service.exit_status(), 0) << service.log();
  EXPECT_THAT(service.log(), Not(HasSubstr("samples are missing")));
  EXPECT_EQ(rows_of(db, kAllSamples), kWholePass);
  EXPECT_EQ(number_of(db, "SELECT count(*) FROM run"), 1);
  EXPECT_EQ(number_of(db, "SELECT sum(received) FROM source_count"), 2 * 1185);
  EXPECT_EQ(number_of(db, "SELECT sum(gaps) FROM source_count"), 0);
}

}  // namespace spindrift::three_axis_test
