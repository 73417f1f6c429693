#include <fmt/format.h>
#include <gmock/gmock.h>
#include <gtest/gtest.h>
#include <spindrift.h>

#include <cmath>
#include <fstream>
#include <nlohmann/json.hpp>
#include <numbers>

#include "pipelines/time/utc.h"
#include "services/base/wall_clock.h"
#include "tests/support/archive_rows.h"
#include "tests/support/bus_child.h"
#include "tests/support/bus_fixture.h"
#include "tests/support/program.h"
#include "tests/support/test_paths.h"

namespace spindrift::doctor_test {

using namespace std::chrono_literals;
using ::testing::HasSubstr;

const std::filesystem::path kPasses = recorded_passes();
const std::string kMission = (kPasses / "nominal" / "mission.toml").string();

struct Diagnosis {
  int status;
  nlohmann::json report;

  nlohmann::json check(const std::string& name) const {
    for (const auto& check : report["checks"]) {
      if (check["name"] == name) {
        return check;
      }
    }
    return {{"verdict", "absent"}, {"found", report.dump()}, {"advice", ""}};
  }
  std::string verdict(const std::string& name) const { return check(name)["verdict"]; }
  std::string found(const std::string& name) const { return check(name)["found"]; }
};

std::vector<std::string> on(const bus::BusConfig& bus, std::vector<std::string> arguments) {
  for (std::string argument : {std::string{"--domain"}, std::to_string(bus.domain),
                               std::string{"--partition"}, bus.partition}) {
    arguments.push_back(std::move(argument));
  }
  return arguments;
}

Diagnosis diagnose(const bus::BusConfig& bus, const std::vector<std::string>& arguments) {
  std::vector<std::string> all = on(bus, {"doctor", "--json"});
  all.insert(all.end(), arguments.begin(), arguments.end());
  Program doctor{all};
  const int status = doctor.exit_status();
  EXPECT_EQ(doctor.log(), "");
  return {.status = status, .report = nlohmann::json::parse(doctor.out())};
}

/// Returns an archive of one pass.
std::filesystem::path processed(const TemporaryFolder& folder) {
  const auto db = folder.path() / "pass.db";
  Program process{{"process", "--mission", kMission, "--telemetry", (kPasses / "nominal").string(),
                   "--db", db.string()}};
  EXPECT_EQ(process.exit_status(), 0) << process.log();
  return db;
}

/// Returns a mission whose ephemeris reaches from an hour ago to two days ahead.
std::string current_mission(const TemporaryFolder& folder) {
  const TaiTime now = tai_now();
  std::string oem =
      "CCSDS_OEM_VERS = 2.0\nCREATION_DATE = 2026-01-01T00:00:00\nORIGINATOR = TEST\n\n"
      "META_START\nOBJECT_NAME = SPINNER\nOBJECT_ID = 2026-999A\nCENTER_NAME = EARTH\n"
      "REF_FRAME = EME2000\nTIME_SYSTEM = TAI\n";
  std::string states;
  std::string first;
  std::string last;
  for (int hour = -1; hour <= 48; ++hour) {
    // OEM times have no trailing Z.
    last = format_utc(now + hour * 1h, 3);
    last.pop_back();
    first = first.empty() ? last : first;
    const double turn_rad = 2.0 * std::numbers::pi * hour / 23.9345;
    const double x = std::cos(turn_rad);
    const double y = std::sin(turn_rad);
    states += fmt::format("{} {} {} 0.0 {} {} 0.0\n", last, 42164.0 * x, 42164.0 * y, -3.0747 * y,
                          3.0747 * x);
  }
  oem += "START_TIME = " + first + "\nSTOP_TIME = " + last +
         "\nINTERPOLATION = LAGRANGE\nINTERPOLATION_DEGREE = 1\nMETA_STOP\n\n" + states;
  folder.write("orbit.oem", oem);
  return folder.write("mission.toml", text_of(kMission)).string();
}

bool is_running(pid_t pid) { return waitpid(pid, nullptr, WNOHANG) == 0; }

TEST(Doctor, FindsNoFailureWhereAllIsWell) {
  const TemporaryFolder folder;
  const bus::BusConfig bus = bus_of_its_own();
  const ForeignWriter front_end{bus, "telemetry", 1};
  const std::vector<std::string> arguments{"--mission", current_mission(folder), "--db",
                                           processed(folder).string()};
  Diagnosis diagnosis{};
  ASSERT_TRUE(eventually([&] {
    diagnosis = diagnose(bus, arguments);
    return diagnosis.verdict("telemetry") == "ok";
  })) << diagnosis.report;

  EXPECT_EQ(diagnosis.status, 0) << diagnosis.report;
  for (const std::string name :
       {"network", "participants", "telemetry", "QoS", "mission SPINNER", "orbit of SPINNER",
        "disk", "archive", "integrity", "write-ahead log", "writer", "runs",
        "leap seconds of the archive", "SQLite"}) {
    EXPECT_EQ(diagnosis.verdict(name), "ok") << diagnosis.check(name);
  }
  EXPECT_NE(diagnosis.verdict("round trip"), "failure") << diagnosis.found("round trip");
  EXPECT_THAT(diagnosis.found("telemetry"), HasSubstr("pid " + std::to_string(front_end.pid())));
  // The text is "N of 100 programs ...", where N leaves room at least for the front-end.
  EXPECT_LT(std::stoi(diagnosis.found("participants")), 100);
  EXPECT_THAT(diagnosis.found("participants"), HasSubstr(" of 100 programs"));
  // The front-end waits for a subscriber and must not take the doctor for one.
  EXPECT_TRUE(is_running(front_end.pid()));
}

TEST(Doctor, LeavesNothingBesideTheArchive) {
  const TemporaryFolder folder;
  const auto db = processed(folder);
  const auto files = [&] {
    std::vector<std::string> names;
    for (const auto& entry : std::filesystem::directory_iterator{folder.path()}) {
      names.push_back(entry.path().filename());
    }
    std::sort(names.begin(), names.end());
    return names;
  };
  const auto before = files();
  const std::string bytes = text_of(db);
  EXPECT_EQ(diagnose(bus_of_its_own(), {"--db", db.string()}).status, 0);
  EXPECT_EQ(files(), before);
  EXPECT_EQ(text_of(db), bytes);
}

TEST(Doctor, PrintsAListForPeople) {
  Program doctor{on(bus_of_its_own(), {"doctor"})};
  EXPECT_EQ(doctor.exit_status(), 0) << doctor.log();
  EXPECT_THAT(doctor.out(), HasSubstr("WARNING  telemetry"));
  EXPECT_THAT(doctor.out(), HasSubstr("0 failures, "));
}

TEST(Doctor, WarnsOfAnEphemerisThatDoesNotReach) {
  const auto diagnosis = diagnose(bus_of_its_own(), {"--mission", kMission});
  EXPECT_EQ(diagnosis.status, 0);
  EXPECT_EQ(diagnosis.verdict("orbit of SPINNER"), "warning");
  EXPECT_THAT(diagnosis.found("orbit of SPINNER"),
              HasSubstr("to 2026-11-20T03:12:00Z: no orbit at"));
}

TEST(Doctor, JudgesForTheComingPass) {
  const auto judged = [](const std::string& to) {
    return diagnose(bus_of_its_own(),
                    {"--mission", kMission, "--from", "2026-11-20T03:00:00Z", "--to", to});
  };
  const auto covered = judged("2026-11-20T03:10:00Z");
  EXPECT_EQ(covered.verdict("orbit of SPINNER"), "ok");
  EXPECT_THAT(covered.found("orbit of SPINNER"), HasSubstr("another 2 min behind the pass"));
  EXPECT_EQ(judged("2026-11-20T03:13:00Z").verdict("orbit of SPINNER"), "warning");
  EXPECT_EQ((Program{{"doctor", "--from", "2026-11-20T03:00:00Z"}}.exit_status()), 2);
  EXPECT_EQ(
      (Program{{"doctor", "--from", "2026-11-20T03:00:00Z", "--to", "2026-11-20"}}.exit_status()),
      2);
}

TEST(Doctor, FailsOnTwoMissionsOfOneSpacecraft) {
  const auto diagnosis = diagnose(bus_of_its_own(), {"--mission", kMission, kMission});
  EXPECT_EQ(diagnosis.status, 1);
  EXPECT_EQ(diagnosis.report["verdict"], "failure");
}

TEST(Doctor, EndsWithTwoForABadMissionOrCommandLine) {
  const TemporaryFolder folder;
  const auto bad = folder.write("mission.toml", "[spacecraft]\nid = \"X\"\nkind = \"kite\"\n");
  Program mission{{"doctor", "--mission", bad.string()}};
  EXPECT_EQ(mission.exit_status(), 2);
  EXPECT_THAT(mission.log(), HasSubstr("mission.toml:3"));
  EXPECT_EQ((Program{{"doctor", "--domain", "231"}}.exit_status()), 2);
}

TEST(Doctor, FailsOnADamagedArchive) {
  const TemporaryFolder folder;
  const auto db = processed(folder);
  {
    constexpr int kPageBytes = 4096;
    std::fstream file{db, std::ios::binary | std::ios::in | std::ios::out};
    for (int page = 100; page < 120; ++page) {
      file.seekp(page * kPageBytes);
      file << std::string(16, '\xff');
    }
  }
  const auto diagnosis = diagnose(bus_of_its_own(), {"--db", db.string()});
  EXPECT_EQ(diagnosis.status, 1);
  EXPECT_EQ(diagnosis.verdict("integrity"), "failure") << diagnosis.report;
  EXPECT_THAT(diagnosis.found("integrity"), HasSubstr("age "));
}

TEST(Doctor, FailsOnAFileThatIsNoArchive) {
  const TemporaryFolder folder;
  const auto file = folder.write("notes.db", "not a database, but long enough to be looked at");
  for (const std::filesystem::path& path : {file, folder.path()}) {
    const auto diagnosis = diagnose(bus_of_its_own(), {"--db", path.string()});
    EXPECT_EQ(diagnosis.status, 1) << path;
    EXPECT_EQ(diagnosis.verdict("archive"), "failure") << path;
  }
}

TEST(Doctor, FailsWhereTheFolderOfTheArchiveIsNotThere) {
  const TemporaryFolder folder;
  const auto diagnosis =
      diagnose(bus_of_its_own(), {"--db", (folder.path() / "absent" / "a.db").string()});
  EXPECT_EQ(diagnosis.status, 1);
  EXPECT_EQ(diagnosis.verdict("disk"), "failure");
}

TEST(Doctor, LooksAtAnArchiveThatAServiceWrites) {
  const TemporaryFolder folder;
  const auto db = folder.path() / "live.db";
  const bus::BusConfig bus = bus_of_its_own();
  Program service{on(bus, {"serve", "--mission", kMission, "--db", db.string()})};
  ASSERT_TRUE(service.says("ready")) << service.log();

  const auto diagnosis = diagnose(bus, {"--db", db.string()});
  EXPECT_EQ(diagnosis.status, 0) << diagnosis.report;
  EXPECT_EQ(diagnosis.verdict("integrity"), "ok");
  EXPECT_THAT(diagnosis.found("writer"), HasSubstr("serve"));
  EXPECT_THAT(diagnosis.found("runs"), HasSubstr("1 not finished"));
  EXPECT_EQ(diagnosis.verdict("runs"), "ok");

  service.signal(SIGTERM);
  EXPECT_EQ(service.exit_status(), 0) << service.log();
  // The service must not report the doctor as an incompatible client.
  EXPECT_EQ(service.log().find("incompatible"), std::string::npos);
  EXPECT_EQ(number_of(db, "SELECT count(*) FROM source_count"), 0);
}

TEST(Doctor, WarnsOfARunThatWasKilled) {
  const TemporaryFolder folder;
  const auto db = folder.path() / "live.db";
  const bus::BusConfig bus = bus_of_its_own();
  Program service{on(bus, {"serve", "--mission", kMission, "--db", db.string()})};
  ASSERT_TRUE(service.says("ready")) << service.log();
  ASSERT_TRUE(eventually([&] { return number_of(db, "SELECT count(*) FROM run") == 1; }));
  service.signal(SIGKILL);
  service.exit_status();

  const auto diagnosis = diagnose(bus, {"--db", db.string()});
  EXPECT_EQ(diagnosis.status, 0) << diagnosis.report;
  EXPECT_EQ(diagnosis.verdict("runs"), "warning") << diagnosis.report;
}

TEST(Doctor, NamesAWriterWhoseQosDoesNotDo) {
  const bus::BusConfig bus = bus_of_its_own();
  const ForeignWriter weak{bus, "weak", 1};
  Diagnosis diagnosis{};
  ASSERT_TRUE(eventually([&] {
    diagnosis = diagnose(bus, {});
    return diagnosis.verdict("QoS") == "failure";
  }));
  EXPECT_EQ(diagnosis.status, 1);
  EXPECT_THAT(diagnosis.found("QoS"), HasSubstr("BEST_EFFORT"));
  EXPECT_THAT(diagnosis.found("QoS"), HasSubstr("pid " + std::to_string(weak.pid())));
}

TEST(Doctor, TellsOfTelemetryInAnotherPartition) {
  const bus::BusConfig bus = bus_of_its_own();
  const ForeignWriter front_end{
      {.domain = bus.domain, .partition = bus.partition + "-other"}, "telemetry", 1};
  Diagnosis diagnosis{};
  ASSERT_TRUE(eventually([&] {
    diagnosis = diagnose(bus, {});
    return diagnosis.found("telemetry").find(bus.partition + "-other") != std::string::npos;
  }));
  EXPECT_EQ(diagnosis.verdict("telemetry"), "warning");
}

TEST(Doctor, GivesTheReasonWhenTheNetworkIsRefused) {
  const TemporaryFolder folder;
  const auto xml = folder.write(
      "dds.xml",
      "<CycloneDDS><Domain Id=\"any\"><General><Interfaces>"
      "<NetworkInterface name=\"nosuch0\"/></Interfaces></General></Domain></CycloneDDS>");
  setenv("CYCLONEDDS_URI", ("file://" + xml.string()).c_str(), 1);
  const auto diagnosis = diagnose(bus_of_its_own(), {});
  unsetenv("CYCLONEDDS_URI");
  EXPECT_EQ(diagnosis.status, 1);
  EXPECT_EQ(diagnosis.verdict("network"), "failure");
  EXPECT_THAT(diagnosis.found("network"), HasSubstr("nosuch0"));
}

}  // namespace spindrift::doctor_test
