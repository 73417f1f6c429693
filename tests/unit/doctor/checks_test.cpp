// The checks of `spindrift doctor` on machine, missions and archive with made-up facts.

#include <gmock/gmock.h>
#include <gtest/gtest.h>

#include "services/doctor/archive.h"
#include "services/doctor/disk.h"
#include "services/doctor/host.h"
#include "services/doctor/missions.h"
#include "services/doctor/report.h"
#include "tests/support/doctor_checks.h"

namespace spindrift::doctor {
namespace {

using ::testing::HasSubstr;
using ::testing::IsEmpty;
using namespace std::chrono_literals;

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

TEST(DoctorHost, IsContentWithAHostInOrder) {
  EXPECT_EQ(worst_of(check_host(good_host())), Verdict::Ok);
}

TEST(DoctorHost, JudgesTheClock) {
  HostFacts facts = good_host();
  facts.clock_synchronised = false;
  EXPECT_EQ(named(check_host(facts), "clock").verdict, Verdict::Warning);
  facts.clock_synchronised = std::nullopt;
  EXPECT_EQ(named(check_host(facts), "clock").verdict, Verdict::Warning);
  facts.clock_synchronised = true;
  facts.year = 1970;
  EXPECT_EQ(named(check_host(facts), "clock").verdict, Verdict::Failure);
  facts.year = 2262;
  EXPECT_EQ(named(check_host(facts), "clock").verdict, Verdict::Failure);
}

TEST(DoctorHost, WarnsOfTightLimits) {
  HostFacts facts = good_host();
  facts.open_files = 255;
  facts.memory_bytes = 511LL << 20;
  const auto checks = check_host(facts);
  EXPECT_EQ(named(checks, "open files").verdict, Verdict::Warning);
  EXPECT_EQ(named(checks, "memory").verdict, Verdict::Warning);
  expect_advice(checks);
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
  return {.day = day,
          .erfa = {.tai_minus_utc_s = 37, .complete_until = 2021y / 12 / 31},
          .machine = LeapTable{.tai_minus_utc_s = 37, .complete_until = 2026y / 6 / 28}};
}

TEST(DoctorLeapSeconds, WarnsWhenNoTableReachesToday) {
  EXPECT_EQ(check_leap_seconds(leaps(2026y / 6 / 28)).verdict, Verdict::Ok);
  const Check late = check_leap_seconds(leaps(2026y / 6 / 29));
  EXPECT_EQ(late.verdict, Verdict::Warning);
  EXPECT_THAT(late.found, HasSubstr("not known on "));
  expect_advice({late});
  LeapFacts alone = leaps(2023y / 1 / 1);
  EXPECT_EQ(check_leap_seconds(alone).verdict, Verdict::Ok);
  alone.machine.reset();
  EXPECT_EQ(check_leap_seconds(alone).verdict, Verdict::Warning);
}

TEST(DoctorLeapSeconds, FailsWhenTheProgramMissesOne) {
  LeapFacts facts = leaps(2026y / 5 / 1);
  facts.machine->tai_minus_utc_s = 38;
  EXPECT_EQ(check_leap_seconds(facts).verdict, Verdict::Failure);
  // A program with a newer table than the machine's is right.
  facts.machine->complete_until = 2016y / 12 / 28;
  facts.machine->tai_minus_utc_s = 36;
  facts.day = 2021y / 6 / 1;
  EXPECT_EQ(check_leap_seconds(facts).verdict, Verdict::Ok);
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

TEST(DoctorMissions, WarnsWhenTheEphemerisEndsWithinADay) {
  EXPECT_EQ(worst_of(check_one(spinner(24h))), Verdict::Ok);
  const auto checks = check_one(spinner(24h - 1s));
  EXPECT_EQ(named(checks, "orbit of SPINNER").verdict, Verdict::Warning);
  EXPECT_THAT(named(checks, "orbit of SPINNER").found,
              HasSubstr("from 2026-11-20T02:00:00Z to 2026-11-21T02:59:59Z, another 1 day"));
  expect_advice(checks);
}

TEST(DoctorMissions, WarnsWhenThereIsNoOrbitNow) {
  MissionFacts facts = spinner(48h);
  facts.ephemeris->from = kNow + 3s;
  facts.no_orbit_at = kNow;
  facts.never_an_orbit = true;
  const Check orbit = named(check_one(facts), "orbit of SPINNER");
  EXPECT_EQ(orbit.verdict, Verdict::Warning);
  EXPECT_THAT(orbit.found, HasSubstr("no orbit at 2026-11-20T03:00:00Z, 3 s before it begins"));
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

TEST(DoctorMissions, TakesElementsForAnyTime) {
  MissionFacts facts = spinner(1h);
  facts.ephemeris.reset();
  EXPECT_EQ(worst_of(check_one(facts)), Verdict::Ok);
}

TEST(DoctorMissions, FailsOnASpacecraftDescribedTwice) {
  const auto checks = check_missions(std::vector{spinner(48h), spinner(48h)}, {kNow, kNow});
  EXPECT_EQ(worst_of(checks), Verdict::Failure);
  expect_advice(checks);
}

TEST(DoctorMissions, WarnsOfWhatHasNoEffect) {
  MissionFacts facts = spinner(48h);
  facts.idle = {"three_axis"};
  EXPECT_THAT(named(check_one(facts), "mission SPINNER").found, HasSubstr("[three_axis]"));
  facts.idle.clear();
  facts.infrared = false;
  EXPECT_EQ(named(check_one(facts), "mission SPINNER").verdict, Verdict::Warning);
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

TEST(DoctorMissions, WarnsOfAnOrbitThatMayBeThatOfAnother) {
  MissionFacts facts = spinner(48h);
  facts.orbit_doubts = {"the orbit file says OBJECT_NAME = GMS-5"};
  const Check check = named(check_one(facts), "mission SPINNER");
  EXPECT_EQ(check.verdict, Verdict::Warning);
  EXPECT_THAT(check.found, HasSubstr("GMS-5"));
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

TEST(DoctorMissions, WarnsWhenTheFieldOfAMagnetometerEndsWithinADay) {
  const std::string name = "field coefficients of LEOSAT";
  EXPECT_EQ(worst_of(check_one(with_magnetometer(24h))), Verdict::Ok);
  const auto checks = check_one(with_magnetometer(24h - 1s));
  EXPECT_EQ(named(checks, name).verdict, Verdict::Warning);
  EXPECT_THAT(named(checks, name).found, HasSubstr("IGRF-14 until 2026-11-21T02:59:59Z"));
  expect_advice(checks);
  const auto of_pass = check_missions(std::vector{with_magnetometer(2h)}, {kNow, kNow + 1h});
  EXPECT_EQ(named(of_pass, name).verdict, Verdict::Ok);
}

TEST(DoctorMissions, WarnsOfAMagnetometerWithoutAnOrbit) {
  MissionFacts facts = with_magnetometer(24h);
  facts.ephemeris.reset();
  facts.orbit_given = false;
  const auto checks = check_one(facts);
  EXPECT_EQ(named(checks, "orbit of LEOSAT").verdict, Verdict::Warning);
  expect_advice(checks);
  facts.field_to.reset();
  EXPECT_EQ(worst_of(check_one(facts)), Verdict::Ok);
}

// --- disk

DiskFacts disk(std::uint64_t free_bytes) {
  return {.folder = "/data", .writable = true, .free_bytes = free_bytes, .file_system = 0xEF53};
}

TEST(DoctorDisk, SaysHowManyHoursItLasts) {
  // 2300 bytes a row at 100 rpm are 13.8 MB an hour for one spacecraft.
  EXPECT_EQ(worst_of(check_disk(disk(24 * 13'800'000ULL), 1)), Verdict::Ok);
  const auto checks = check_disk(disk(24 * 13'800'000ULL), 2);
  EXPECT_EQ(named(checks, "disk").verdict, Verdict::Warning);
  EXPECT_THAT(named(checks, "disk").found, HasSubstr("12 h of 2 spacecraft"));
  EXPECT_EQ(named(check_disk(disk(13'700'000), 1), "disk").verdict, Verdict::Failure);
  expect_advice(checks);
}

TEST(DoctorDisk, RefusesFileSystemsOfTheNetwork) {
  DiskFacts facts = disk(1ULL << 40U);
  facts.file_system = 0x6969;
  const Check found = named(check_disk(facts, 1), "file system");
  EXPECT_EQ(found.verdict, Verdict::Failure);
  EXPECT_THAT(found.found, HasSubstr("NFS"));
  facts.file_system = 0x01021994;
  EXPECT_EQ(named(check_disk(facts, 1), "file system").verdict, Verdict::Warning);
}

TEST(DoctorDisk, FailsWhereNothingCanBeWritten) {
  DiskFacts facts = disk(1ULL << 40U);
  facts.writable = false;
  EXPECT_EQ(named(check_disk(facts, 1), "write access").verdict, Verdict::Failure);
  EXPECT_EQ(worst_of(check_disk(Unexpected{{ErrorCode::Unavailable, "/data: absent"}}, 1)),
            Verdict::Failure);
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

TEST(DoctorArchive, IsContentWithAWholeOneAndWithNone) {
  EXPECT_EQ(worst_of(check_archive(good_archive(), kTaiMinusUtc_s)), Verdict::Ok);
  ArchiveFacts none = good_archive();
  none.exists = false;
  EXPECT_EQ(worst_of(check_archive(none, kTaiMinusUtc_s)), Verdict::Ok);
}

TEST(DoctorArchive, FailsOnOneThatCannotBeOpened) {
  ArchiveFacts facts = good_archive();
  facts.content = Unexpected{{ErrorCode::InvalidConfiguration, "a.db is not an archive"}};
  const auto checks = check_archive(facts, kTaiMinusUtc_s);
  EXPECT_EQ(worst_of(checks), Verdict::Failure);
  EXPECT_THAT(checks.front().found, HasSubstr("not an archive"));
  expect_advice(checks);
}

TEST(DoctorArchive, FailsOnDamageInTheWordsOfSqlite) {
  ArchiveFacts facts = good_archive();
  facts.content->damages = {"Tree 7 page 9: btreeInitPage() returns error code 11"};
  const auto checks = check_archive(facts, kTaiMinusUtc_s);
  EXPECT_EQ(named(checks, "integrity").verdict, Verdict::Failure);
  EXPECT_THAT(named(checks, "integrity").found, HasSubstr("page 9"));
  expect_advice(checks);
  facts = good_archive();
  facts.content->orphans = 5;
  EXPECT_EQ(named(check_archive(facts, kTaiMinusUtc_s), "integrity").verdict, Verdict::Failure);
}

TEST(DoctorArchive, WarnsOfALogThatIsNotMoved) {
  ArchiveFacts facts = good_archive();
  facts.wal_bytes = 256ULL << 20U;
  EXPECT_EQ(named(check_archive(facts, kTaiMinusUtc_s), "write-ahead log").verdict, Verdict::Ok);
  ++facts.wal_bytes;
  EXPECT_EQ(named(check_archive(facts, kTaiMinusUtc_s), "write-ahead log").verdict,
            Verdict::Warning);
}

TEST(DoctorArchive, WarnsOfUnfinishedRunsUnlessOneIsWriting) {
  ArchiveFacts facts = good_archive();
  facts.content->unfinished_runs = 2;
  EXPECT_EQ(named(check_archive(facts, kTaiMinusUtc_s), "runs").verdict, Verdict::Warning);
  facts.writer = "pid 12 (spindrift serve) on ant";
  const auto checks = check_archive(facts, kTaiMinusUtc_s);
  EXPECT_EQ(named(checks, "runs").verdict, Verdict::Ok);
  EXPECT_THAT(named(checks, "writer").found, HasSubstr("pid 12"));
}

TEST(DoctorArchive, ComparesTheLeapSeconds) {
  ArchiveFacts facts = good_archive();
  for (const int archive_s : {36, 38}) {
    facts.content->tai_minus_utc_s = archive_s;
    EXPECT_EQ(named(check_archive(facts, kTaiMinusUtc_s), "leap seconds of the archive").verdict,
              Verdict::Warning);
  }
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

}  // namespace
}  // namespace spindrift::doctor
