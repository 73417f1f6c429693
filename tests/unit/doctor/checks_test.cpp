// The checks of `spindrift doctor` on machine, missions and archive with made-up facts.

#include "services/doctor/archive.h"
#include "services/doctor/disk.h"
#include "services/doctor/host.h"
#include "services/doctor/missions.h"
#include "services/doctor/report.h"
#include "tests/support/doctor_checks.h"
#include "tests/support/matchers.h"

namespace spindrift::doctor::checks_test {

using namespace std::chrono_literals;
using enum Verdict;

constexpr TaiTime kNow = tai_from_ns(1'795'143'637'000'000'000);

// --- host

HostFacts good_host() {
  return {.year = 2026,
          .clock_synchronised = true,
          .clock_error_s = 0.002,
          .open_files = 1024,
          .memory_bytes = 4LL << 30,
          .sqlite_version = 3051003};
}

TEST(DoctorHost, JudgesTheClockAndTightLimits) {
  expect_judged<HostFacts>(
      good_host(), check_host,
      {{"clock that runs free", [](auto& f) { f.clock_synchronised = false; }, "clock", Warning},
       {"clock of which nothing is known", [](auto& f) { f.clock_synchronised.reset(); }, "clock",
        Warning},
       {"clock never set", [](auto& f) { f.year = 1970; }, "clock", Failure},
       {"clock beyond TAI", [](auto& f) { f.year = 2262; }, "clock", Failure},
       {"few open files", [](auto& f) { f.open_files = 255; }, "open files", Warning},
       {"little memory", [](auto& f) { f.memory_bytes = 511LL << 20; }, "memory", Warning}});
}

TEST(DoctorHost, NamesTheVersionsOfSqliteThatCanDamageAFile) {
  HostFacts facts = good_host();
  EXPECT_THAT(named(check_host(facts), "SQLite").advice, IsEmpty());
  facts.sqlite_version = 3051002;
  EXPECT_THAT(named(check_host(facts), "SQLite").advice, HasSubstr("no other program write"));
  EXPECT_THAT(named(check_host(facts), "SQLite").found, HasSubstr("3.51.2"));
}

// --- leap seconds

TEST(DoctorLeapSeconds, ReadsTheTableOfTheMachine) {
  // 3676924800 and 3692217600 are 1 July 2016 less a leap second, and 1 January 2017; 3991593600 is
  // 28 June 2026.
  const auto table = machine_table(
      "#$ 3945196800\n#@ 3991593600\n2272060800\t10\t# 1 Jan 1972\n3692217600\t37\t# 1 Jan 2017\n");
  ASSERT_TRUE(table);
  EXPECT_EQ(table->tai_minus_utc_s, 37);
  EXPECT_EQ(table->complete_until, std::chrono::sys_days{2026y / 6 / 28});
  EXPECT_EQ(table->since, std::chrono::sys_days{2017y / 1 / 1});
  EXPECT_FALSE(machine_table(""));
  EXPECT_FALSE(machine_table("nonsense"));
  EXPECT_FALSE(machine_table("3692217600\t37\n"));
}

TEST(DoctorLeapSeconds, KnowsTheTableOfErfa) {
  const LeapFacts facts = leap_facts(kNow);
  EXPECT_GE(facts.erfa.tai_minus_utc_s, 37);
  EXPECT_GE(facts.erfa.complete_until, std::chrono::sys_days{2017y / 12 / 31});
  EXPECT_LT(facts.erfa.complete_until, std::chrono::sys_days{2100y / 1 / 1});
}

LeapFacts leaps(std::chrono::sys_days day) {
  return {
      .day = day,
      .erfa = {.tai_minus_utc_s = 37, .since = 2017y / 1 / 1, .complete_until = 2021y / 12 / 31},
      .machine = LeapTable{
          .tai_minus_utc_s = 37, .since = 2017y / 1 / 1, .complete_until = 2026y / 6 / 28}};
}

TEST(DoctorLeapSeconds, WarnsWhenNoTableReachesTodayAndFailsWhenTheProgramMissesOne) {
  expect_judged<LeapFacts>(
      leaps(2026y / 6 / 28), [](const LeapFacts& f) { return std::vector{check_leap_seconds(f)}; },
      {{"day after the last", [](auto& f) { f.day = 2026y / 6 / 29; }, "leap seconds", Warning,
        "not known on "},
       {"machine reaches further", [](auto& f) { f.day = 2023y / 1 / 1; }, "leap seconds", Ok},
       {"no table of the machine",
        [](auto& f) {
          f.day = 2023y / 1 / 1;
          f.machine.reset();
        },
        "leap seconds", Warning},
       {"program misses one",
        [](auto& f) {
          f.machine->tai_minus_utc_s = 38;
          f.machine->since = 2026y / 1 / 1;
        },
        "leap seconds", Failure},
       {"program has a newer table than the machine",
        [](auto& f) {
          f.machine = LeapTable{
              .tai_minus_utc_s = 36, .since = 2015y / 7 / 1, .complete_until = 2016y / 12 / 28};
          f.day = 2021y / 6 / 1;
        },
        "leap seconds", Ok}});
}

// --- missions

MissionFacts spinner(std::chrono::seconds left) {
  return {.spacecraft = "SPINNER",
          .kind = SpacecraftKind::Spin,
          .ephemeris = Coverage{.from = kNow - 1h, .to = kNow + left},
          .no_orbit_at = {},
          .infrared = true,
          .idle = {}};
}

std::vector<Check> check_one(const MissionFacts& mission) {
  return check_missions(std::vector{mission}, {kNow, kNow});
}

TEST(DoctorMissions, JudgesASpinnerInAPassOfNow) {
  expect_judged<MissionFacts>(
      spinner(24h), check_one,
      {{"ephemeris ends within a day", [](auto& f) { f.ephemeris->to -= 1s; }, "orbit of SPINNER",
        Warning, "from 2026-11-20T02:00:00Z to 2026-11-21T02:59:59Z, another 1 day"},
       {"no orbit now",
        [](auto& f) {
          f.ephemeris = Coverage{.from = kNow + 3s, .to = kNow + 48h};
          f.no_orbit_at = kNow;
          f.never_an_orbit = true;
        },
        "orbit of SPINNER", Warning, "no orbit at 2026-11-20T03:00:00Z, 3 s before it begins"},
       {"elements", [](auto& f) { f.ephemeris.reset(); }, "orbit of SPINNER", Ok},
       {"table of another kind", [](auto& f) { f.idle = {"three_axis"}; }, "mission SPINNER",
        Warning, "[three_axis]"},
       {"no infrared sensor", [](auto& f) { f.infrared = false; }, "mission SPINNER", Warning},
       {"orbit of another", [](auto& f) { f.orbit_doubts = {"OBJECT_NAME = GMS-5"}; },
        "mission SPINNER", Warning, "GMS-5"}});
}

TEST(DoctorMissions, SaysWhichAlignmentStandsAtItsDefaultAndWhatItCosts) {
  expect_judged<MissionFacts>(
      spinner(24h), check_one,
      {{"all stated", [](auto&) {}, "alignment of SPINNER", Ok, "stated in the mission file"},
       {"one at its default",
        [](auto& f) {
          f.defaults = {{.key = "spin.alignment.slit_cant_deg", .value = 0.05, .cost_deg = 0.123}};
          f.planned = {kNow, kNow + 600s};
        },
        "alignment of SPINNER", Warning,
        "defaults in force, and what each adds to sigma of the axis from 2026-11-20T03:00:00Z to "
        "2026-11-20T03:10:00Z:\nspin.alignment.slit_cant_deg = 0.05: 0.12 deg"},
       {"one at a default that costs nothing",
        [](auto& f) { f.defaults = {{.key = "spin.alignment.time_tag_s", .value = 0.0}}; },
        "alignment of SPINNER", Ok, "spin.alignment.time_tag_s = 0"},
       {"no axis to plan with",
        [](auto& f) { f.defaults = {{.key = "spin.alignment.slit_cant_deg", .value = 0.05}}; },
        "alignment of SPINNER", Warning,
        "([spin.target] or [spin.prior], and an orbit at the time of --from, would tell"},
       {"three axes",
        [](auto& f) {
          f.kind = SpacecraftKind::ThreeAxis;
          f.defaults = {{.key = "three_axis.alignment.gyro_scale",
                         .value = 0.001,
                         .cost_deg = 0.36,
                         .where = "a turn"}};
        },
        "alignment of SPINNER", Warning, "gyro_scale = 0.001: 0.36 deg a turn"}});
}

TEST(DoctorMissions, FailsOnAPassOfWhichNoTimeHasAnOrbit) {
  const ComingPass pass{.from = kNow + 30 * 24h, .to = kNow + 31 * 24h};
  MissionFacts facts = spinner(24h);
  facts.no_orbit_at = pass.from;
  EXPECT_EQ(named(check_missions(std::vector{facts}, pass), "orbit of SPINNER").verdict,
            Verdict::Warning);
  facts.never_an_orbit = true;
  const auto checks = check_missions(std::vector{facts}, pass);
  const Check orbit = named(checks, "orbit of SPINNER");
  EXPECT_EQ(orbit.verdict, Verdict::Failure);
  EXPECT_THAT(orbit.found, HasSubstr("no orbit at 2026-12-20T03:00:00Z, 29 days after it ends"));
  expect_advice(checks);
}

TEST(DoctorMissions, FailsOnASpacecraftDescribedTwice) {
  const auto checks = check_missions(std::vector{spinner(48h), spinner(48h)}, {kNow, kNow});
  EXPECT_EQ(worst_of(checks), Verdict::Failure);
  expect_advice(checks);
}

TEST(DoctorMissions, AsksTheOrbitOfAComingPassToReachItsEndOnly) {
  const auto judged = [](TaiTime to) {
    return named(check_missions(std::vector{spinner(2h)}, {kNow, to}), "orbit of SPINNER");
  };
  EXPECT_EQ(judged(kNow + 1h).verdict, Verdict::Ok);
  EXPECT_THAT(judged(kNow + 1h).found, HasSubstr("another 1 h behind the pass"));
}

TEST(DoctorMissions, JudgesTheGroundModelForThePass) {
  MissionFacts facts = spinner(48h);
  const auto judged = [&](TaiTime to) {
    return named(check_missions(std::vector{facts}, {kNow, to}), "ground model of SPINNER");
  };
  facts.ground_model = Coverage{.from = kNow - 1h, .to = kNow + 2h};
  EXPECT_EQ(judged(kNow + 2h).verdict, Verdict::Ok);
  EXPECT_EQ(judged(kNow + 3h).verdict, Verdict::Warning);
  // The model of a future pass is not checked against the present.
  facts.ground_model = Coverage{.from = kNow + 1h, .to = kNow + 2h};
  EXPECT_EQ(judged(kNow).verdict, Verdict::Ok);
  EXPECT_EQ(judged(kNow + 2h).verdict, Verdict::Warning);
  facts.ground_model.reset();
  facts.model_problem = "pass.toml: cannot be read";
  EXPECT_EQ(judged(kNow).verdict, Verdict::Failure);
  EXPECT_THAT(judged(kNow).found, HasSubstr("pass.toml"));
  expect_advice(check_one(facts));
}

MissionFacts with_magnetometer(std::chrono::seconds field_left) {
  return {.spacecraft = "LEOSAT",
          .kind = SpacecraftKind::ThreeAxis,
          .ephemeris = Coverage{.from = kNow - 1h, .to = kNow + 48h},
          .no_orbit_at = {},
          .field_to = kNow + field_left,
          .infrared = true,
          .idle = {}};
}

TEST(DoctorMissions, JudgesTheFieldAndTheOrbitThatAMagnetometerNeeds) {
  const std::string name = "field coefficients of LEOSAT";
  expect_judged<MissionFacts>(with_magnetometer(24h), check_one,
                              {{"field ends within a day", [](auto& f) { *f.field_to -= 1s; },
                                name.c_str(), Warning, "IGRF-14 until 2026-11-21T02:59:59Z"},
                               {"no orbit",
                                [](auto& f) {
                                  f.ephemeris.reset();
                                  f.orbit_given = false;
                                },
                                "orbit of LEOSAT", Warning}});
  MissionFacts without = with_magnetometer(24h);
  without.ephemeris.reset();
  without.orbit_given = false;
  without.field_to.reset();
  EXPECT_EQ(worst_of(check_one(without)), Ok);
  const auto of_pass = check_missions(std::vector{with_magnetometer(2h)}, {kNow, kNow + 1h});
  EXPECT_EQ(named(of_pass, name).verdict, Ok);
}

// --- disk

DiskFacts disk(std::uint64_t free_bytes) {
  return {.folder = "/data", .writable = true, .free_bytes = free_bytes, .file_system = 0xEF53};
}

TEST(DoctorDisk, JudgesHowManyHoursItLastsAndWhatKindItIs) {
  const auto for_one = [](const DiskFacts& facts) { return check_disk(facts, 1); };
  // 2300 bytes a row at 100 rpm are 13.8 MB an hour for one spacecraft.
  expect_judged<DiskFacts>(
      disk(24 * 13'800'000ULL), for_one,
      {{"less than an hour", [](auto& f) { f.free_bytes = 13'700'000; }, "disk", Failure},
       {"NFS", [](auto& f) { f.file_system = 0x6969; }, "file system", Failure, "NFS"},
       {"tmpfs", [](auto& f) { f.file_system = 0x01021994; }, "file system", Warning},
       {"not writable", [](auto& f) { f.writable = false; }, "write access", Failure}});
  const auto checks = check_disk(disk(24 * 13'800'000ULL), 2);
  EXPECT_EQ(named(checks, "disk").verdict, Warning);
  EXPECT_THAT(named(checks, "disk").found, HasSubstr("12 h of 2 spacecraft"));
  expect_advice(checks);
  EXPECT_EQ(worst_of(check_disk(Unexpected{{ErrorCode::Unavailable, "/data: absent"}}, 1)),
            Failure);
}

// --- archive

constexpr int kTaiMinusUtc_s = 37;

ArchiveFacts good_archive() {
  return {.path = "a.db",
          .exists = true,
          .bytes = 1 << 20,
          .wal_bytes = 0,
          .writer = {},
          .content = ArchiveContent{.damages = {}, .tai_minus_utc_s = 37}};
}

TEST(DoctorArchive, JudgesWhatItFindsInOne) {
  const auto checks_of = [](const ArchiveFacts& facts) {
    return check_archive(facts, kTaiMinusUtc_s);
  };
  expect_judged<ArchiveFacts>(
      good_archive(), checks_of,
      {{"none", [](auto& f) { f.exists = false; }, "archive", Ok},
       {"not to be opened",
        [](auto& f) {
          f.content = Unexpected{{ErrorCode::InvalidConfiguration, "a.db is not an archive"}};
        },
        "archive", Failure, "not an archive"},
       {"damaged",
        [](auto& f) {
          f.content->damages = {"Tree 7 page 9: btreeInitPage() returns error code 11"};
        },
        "integrity", Failure, "page 9"},
       {"orphans", [](auto& f) { f.content->orphans = 5; }, "integrity", Failure},
       {"longest log", [](auto& f) { f.wal_bytes = 256ULL << 20U; }, "write-ahead log", Ok},
       {"log that is not moved", [](auto& f) { f.wal_bytes = (256ULL << 20U) + 1; },
        "write-ahead log", Warning},
       {"unfinished runs", [](auto& f) { f.content->unfinished_runs = 2; }, "runs", Warning},
       {"fewer leap seconds", [](auto& f) { f.content->tai_minus_utc_s = 36; },
        "leap seconds of the archive", Warning},
       {"more leap seconds", [](auto& f) { f.content->tai_minus_utc_s = 38; },
        "leap seconds of the archive", Warning}});
  ArchiveFacts written = good_archive();
  written.content->unfinished_runs = 2;
  written.writer = "pid 12 (spindrift serve) on ant";
  EXPECT_EQ(named(checks_of(written), "runs").verdict, Ok);
  EXPECT_THAT(named(checks_of(written), "writer").found, HasSubstr("pid 12"));
}

// --- report

TEST(DoctorReport, AlignsItsColumnsAndBreaksLongLines) {
  const std::vector<Check> checks{
      ok("disk", "fine"),
      warning("a long name", std::string(40, 'a') + ' ' + std::string(40, 'b') + "\nsecond",
              "do it")};
  EXPECT_EQ(to_text(checks, true),
            "ok       disk         fine\n"
            "WARNING  a long name  " +
                std::string(40, 'a') + "\n" + "                        " + std::string(40, 'b') +
                "\n" +
                "                      second\n"
                "                      -> do it\n"
                "\n0 failures, 1 warning, 1 sound\n");
}

TEST(DoctorReport, SaysOnlyWhatItFoundUnlessAskedForMore) {
  EXPECT_EQ(to_text(std::vector{ok("disk", "fine")}, false), "0 failures, 0 warnings, 1 sound\n");
  EXPECT_EQ(to_text(std::vector{ok("disk", "fine"), failure("clock", "wrong", "")}, false),
            "FAILURE  clock  wrong\n\n1 failure, 0 warnings, 1 sound\n");
}

TEST(DoctorReport, LeavesAWordLongerThanALineWhole) {
  const std::string word(200, 'x');
  EXPECT_THAT(to_text(std::vector{ok("n", word)}, true), HasSubstr(word));
  EXPECT_THAT(to_text(std::vector{ok("n", word + " y " + word)}, true), HasSubstr(word + "\n"));
}

TEST(DoctorReport, GivesTheWorstVerdict) {
  EXPECT_EQ(worst_of({}), Verdict::Ok);
  EXPECT_EQ(worst_of(std::vector{failure("a", "b", "c"), ok("d", "e")}), Verdict::Failure);
  EXPECT_EQ(to_json(std::vector{warning("a", "b", "c")}),
            R"({"checks":[{"advice":"c","found":"b","name":"a","verdict":"warning"}],)"
            R"("verdict":"warning"})"
            "\n");
}

}  // namespace spindrift::doctor::checks_test
