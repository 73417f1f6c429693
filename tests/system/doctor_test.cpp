#include <fmt/format.h>

#include <cmath>
#include <fstream>
#include <nlohmann/json.hpp>
#include <numbers>
#include <set>
#include <stdexcept>
#include <string>
#include <utility>
#include <vector>

#include "pipelines/time/utc.h"
#include "services/base/wall_clock.h"
#include "tests/support/archive_rows.h"
#include "tests/support/bus_child.h"
#include "tests/support/bus_fixture.h"
#include "tests/support/matchers.h"
#include "tests/support/on_bus.h"
#include "tests/support/processed.h"
#include "tests/support/ran.h"
#include "tests/support/test_paths.h"

namespace spindrift::doctor_test {

using namespace std::chrono_literals;

const std::string kMission = (recorded_passes() / "nominal" / "mission.toml").string();

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

Diagnosis diagnose(const bus::BusConfig& bus, const std::vector<std::string>& arguments) {
  const Ran doctor = ended(with(on(bus, {"doctor", "--json"}), arguments));
  EXPECT_EQ(doctor.log, "");
  return {.status = doctor.status, .report = doctor.json()};
}

/// Diagnoses until a check says so.
template <class Is>
Diagnosis diagnosed(const bus::BusConfig& bus, const Words& arguments, const Is& is) {
  Diagnosis diagnosis{};
  if (!eventually([&] {
        diagnosis = diagnose(bus, arguments);
        return is(diagnosis);
      })) {
    throw std::runtime_error{diagnosis.report.dump()};
  }
  return diagnosis;
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

std::set<std::filesystem::path> files_beside(const std::filesystem::path& db) {
  const std::filesystem::directory_iterator entries{db.parent_path()};
  return {begin(entries), end(entries)};
}

bool is_running(pid_t pid) { return waitpid(pid, nullptr, WNOHANG) == 0; }

TEST(Doctor, FindsNoFailureWhereAllIsWellAndLeavesNothingBesideTheArchive) {
  const TemporaryFolder folder;
  const bus::BusConfig bus = bus_of_its_own();
  const ForeignWriter front_end{bus, "telemetry", 1};
  const Processed processed{"nominal"};
  const auto before = files_beside(processed.db);
  const std::string bytes = text_of(processed.db);
  const Diagnosis diagnosis =
      diagnosed(bus, {"--mission", current_mission(folder), "--db", processed.db},
                [](const auto& so_far) { return so_far.verdict("telemetry") == "ok"; });
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
  EXPECT_EQ(files_beside(processed.db), before);
  EXPECT_EQ(text_of(processed.db), bytes);
}

TEST(Doctor, PrintsAListForPeople) {
  const Ran doctor = succeeded(on(bus_of_its_own(), {"doctor"}));
  EXPECT_THAT(doctor.out, HasSubstr("WARNING  telemetry"));
  EXPECT_THAT(doctor.out, HasSubstr("0 failures, "));
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
}

TEST(Doctor, SaysWhatTheDefaultsOfAlignmentCost) {
  const TemporaryFolder folder;
  folder.write("orbit.oem", text_of(std::filesystem::path{kMission}.parent_path() / "orbit.oem"));
  const std::string mission =
      folder
          .write("mission.toml", text_of(kMission) +
                                     "\n[spin.target]\nra_deg = 100\ndec_deg = -55\n"
                                     "[spin.alignment]\nco2_altitude_km = 0\n")
          .string();
  const auto diagnosis = diagnose(
      bus_of_its_own(),
      {"--mission", mission, "--from", "2026-11-20T03:00:00Z", "--to", "2026-11-20T03:10:00Z"});
  EXPECT_EQ(diagnosis.verdict("alignment of SPINNER"), "warning");
  const std::string found = diagnosis.found("alignment of SPINNER");
  EXPECT_THAT(found, HasSubstr("from 2026-11-20T03:00:00Z to 2026-11-20T03:10:00Z"));
  EXPECT_THAT(found, HasSubstr("\nspin.alignment.north_mount_angle_deg = 0.05: "));
  EXPECT_THAT(found, Not(HasSubstr("co2_altitude_km")));
}

TEST(Doctor, EndsWithTwoForABadMissionOrCommandLine) {
  const TemporaryFolder folder;
  const auto bad = folder.write("mission.toml", "[spacecraft]\nid = \"X\"\nkind = \"kite\"\n");
  refused({"doctor", "--mission", bad}, {"mission.toml:3"});
  refused({"doctor", "--domain", "231"}, {});
  refused({"doctor", "--from", "2026-11-20T03:00:00Z"}, {});
  refused({"doctor", "--from", "2026-11-20T03:00:00Z", "--to", "2026-11-20"}, {});
}

TEST(Doctor, FailsOnADamagedArchive) {
  const Processed processed{"nominal"};
  const auto& db = processed.db;
  {
    constexpr int kPageBytes = 4096;
    std::fstream file{db, std::ios::binary | std::ios::in | std::ios::out};
    for (int page = 100; page < 120; ++page) {
      file.seekp(page * kPageBytes);
      file << std::string(16, '\xff');
    }
  }
  const auto diagnosis = diagnose(bus_of_its_own(), {"--db", db});
  EXPECT_EQ(diagnosis.status, 1);
  EXPECT_EQ(diagnosis.verdict("integrity"), "failure") << diagnosis.report;
  EXPECT_THAT(diagnosis.found("integrity"), HasSubstr("age "));
}

TEST(Doctor, FailsOnTwoMissionsOfOneSpacecraftAndWhereNoArchiveIs) {
  const TemporaryFolder folder;
  const auto file = folder.write("notes.db", "not a database, but long enough to be looked at");
  for (const auto& [arguments, check] : std::vector<std::pair<Words, std::string>>{
           {{"--mission", kMission, kMission}, ""},
           {{"--db", file}, "archive"},
           {{"--db", folder.path()}, "archive"},
           {{"--db", folder.path() / "absent" / "a.db"}, "disk"}}) {
    SCOPED_TRACE(arguments.back());
    const auto diagnosis = diagnose(bus_of_its_own(), arguments);
    EXPECT_EQ(diagnosis.status, 1);
    EXPECT_EQ(check.empty() ? diagnosis.report["verdict"] : diagnosis.check(check)["verdict"],
              "failure");
  }
}

TEST(Doctor, LooksAtAnArchiveThatAServiceWrites) {
  ReadyService service{"nominal"};
  const auto diagnosis = diagnose(service.bus(), {"--db", service.db()});
  EXPECT_EQ(diagnosis.status, 0) << diagnosis.report;
  EXPECT_EQ(diagnosis.verdict("integrity"), "ok");
  EXPECT_THAT(diagnosis.found("writer"), HasSubstr("serve"));
  EXPECT_THAT(diagnosis.found("runs"), HasSubstr("1 not finished"));
  EXPECT_EQ(diagnosis.verdict("runs"), "ok");

  ASSERT_EQ(service.stop(), 0) << service.log();
  // The service must not report the doctor as an incompatible client.
  EXPECT_THAT(service.log(), Not(HasSubstr("incompatible")));
  EXPECT_EQ(count_rows(service.db(), "source_count"), 0);
}

TEST(Doctor, WarnsOfARunThatWasKilled) {
  ReadyService service{"nominal"};
  ASSERT_TRUE(eventually([&] { return count_rows(service.db(), "run") == 1; }));
  service.kill();

  const auto diagnosis = diagnose(service.bus(), {"--db", service.db()});
  EXPECT_EQ(diagnosis.status, 0) << diagnosis.report;
  EXPECT_EQ(diagnosis.verdict("runs"), "warning") << diagnosis.report;
}

TEST(Doctor, NamesAWriterWhoseQosDoesNotDo) {
  const bus::BusConfig bus = bus_of_its_own();
  const ForeignWriter weak{bus, "weak", 1};
  const Diagnosis diagnosis =
      diagnosed(bus, {}, [](const auto& so_far) { return so_far.verdict("QoS") == "failure"; });
  EXPECT_EQ(diagnosis.status, 1);
  EXPECT_THAT(diagnosis.found("QoS"), HasSubstr("BEST_EFFORT"));
  EXPECT_THAT(diagnosis.found("QoS"), HasSubstr("pid " + std::to_string(weak.pid())));
}

TEST(Doctor, TellsOfTelemetryInAnotherPartition) {
  const bus::BusConfig bus = bus_of_its_own();
  const ForeignWriter front_end{
      {.domain = bus.domain, .partition = bus.partition + "-other"}, "telemetry", 1};
  const Diagnosis diagnosis = diagnosed(bus, {}, [&](const auto& so_far) {
    return so_far.found("telemetry").find(bus.partition + "-other") != std::string::npos;
  });
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
