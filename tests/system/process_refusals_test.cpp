#include <fmt/format.h>
#include <sys/stat.h>

#include <nlohmann/json.hpp>

#include "tests/support/archive_rows.h"
#include "tests/support/matchers.h"
#include "tests/support/processed.h"
#include "tests/support/program.h"
#include "tests/support/ran.h"
#include "tests/support/recorded_files.h"

namespace spindrift::process_refusals_test {

TEST(Process, SaysWhyThereIsNoAxisWhereNoRowIsOfUse) {
  const std::string header = "t_tai_ns,channel,spacecraft\n";
  const std::string edge = "1795143637568806257,sun1,";
  const auto log_of = [&](const std::string& rows, std::int64_t bad_rows) {
    const PassCopy pass{"nominal"};
    pass.folder.write("pulses.csv", header + rows);
    const Ran program =
        bad_rows == 0
            ? succeeded(pass.arguments_here())
            : refused(pass.arguments_here(), {"spindrift: nothing of the telemetry can be read: "});
    EXPECT_EQ(count_rows(pass.db, "pulse"), 0);
    EXPECT_EQ(count_rows(pass.db, "rejected_input"), bad_rows);
    return program.log;
  };
  const std::string says = "SPINNER: no edge of it in the telemetry, and no axis: ";
  EXPECT_THAT(log_of(edge + "OTHER\n" + edge + "THIRD\n", 0),
              HasSubstr(says + "0 bad rows, 2 samples of other spacecraft\n"));
  EXPECT_THAT(log_of(edge + "\n", 1),
              HasSubstr(says + "1 bad row, 0 samples of other spacecraft\n"));
}

TEST(Process, EndsWithABadStatusAndTheLikelyCauseWhereNothingCanBeRead) {
  const PassCopy pass{"nominal"};
  pass.folder.write("pulses.csv", "t_tai_ns,channel\n1795143637.568,sun1\n1795143638.568,sun1\n");
  refused(pass.arguments_here(),
          {"pulses.csv:2: t_tai_ns = \"1795143637.568\": must be an integer; "
           "looks like s, not ns\n"});
  EXPECT_EQ(count_rows(pass.db, "rejected_input"), 2);
}

TEST(Process, RefusesBadRowsWhenStrict) {
  const PassCopy pass{"nominal"};
  pass.folder.write("more.csv", "t_tai_ns,channel\n1795143637568806257,sun3\n");
  refused(with(pass.arguments_here(), {"--strict"}), {"more.csv:2: "});
  EXPECT_FALSE(std::filesystem::exists(pass.db));
}

TEST(Process, RefusesAFileThatIsNotWhatItShouldBe) {
  expect_refused("mission.toml",
                 text_of(kPasses / "nominal" / "mission.toml") + "\n[spin.colour]\nhue = 3\n",
                 {"mission.toml:", "spin.colour"});
  expect_refused("mission.toml", "", {"mission.toml: [spacecraft]: missing"});
  expect_refused("orbit.oem", "CCSDS_OEM_VERS = 2.0\nthis is no orbit\n", {"orbit.oem", "line 2"});
  expect_refused("orbit.oem", "", {"orbit.oem", "must begin with CCSDS_OEM_VERS"});
  expect_refused("pulses.csv", "t_tai_ns,channel\n",
                 {"no row of telemetry", "pulses.csv: no rows"});
  expect_refused("notes.csv", "when,what\n1,2\n", {"notes.csv:1", "t_tai_ns,channel"});
}

TEST(Process, StoresEdgesOfASpacecraftThatIsNoSpinnerAndSaysThatNothingIsComputed) {
  const PassCopy pass{"nominal"};
  pass.folder.write("mission.toml",
                    "[spacecraft]\nid = \"SPINNER\"\nkind = \"three_axis\"\n"
                    "[orbit]\noem = \"orbit.oem\"\n");
  const Ran program = succeeded(pass.arguments_here());
  EXPECT_THAT(program.log, HasSubstr("edges arrive, and the mission file has no "
                                     "[spin.sun_sensor]: they are stored"));
  EXPECT_EQ(count_rows(pass.db, "pulse"), 3600);
  EXPECT_EQ(count_rows(pass.db, "spin_estimate"), 0);
}

TEST(Process, StoresOrbitStatesOfASpinnerAndSaysOnceThatTheOrbitIsTheMissionFiles) {
  const PassCopy pass{"nominal"};
  pass.folder.write("orbit_state.csv",
                    "t_tai_ns,x_km,y_km,z_km,vx_km_s,vy_km_s,vz_km_s\n"
                    "1795143638000000000,7000,0,0,0,7.5,0\n"
                    "1795143698000000000,6990,450,0,-0.5,7.48,0\n");
  expect_said_once(
      succeeded(pass.arguments_here()).log,
      "SPINNER: orbit states arrive: they are stored; the orbit is the mission file's");
  EXPECT_EQ(count_rows(pass.db, "orbit_state_sample"), 2);
}

TEST(Process, RefusesFilesThatWouldHurtIt) {
  std::string deep = "a";
  for (int i = 0; i < 100'000; ++i) {
    deep += ".a";
  }
  expect_refused("mission.toml", deep + " = 1\n",
                 {"mission.toml:1: tables and arrays must not stand deeper than 16"});
  const std::string oem = text_of(kPasses / "nominal" / "orbit.oem");
  const auto with_line = [&](const std::string& key, const std::string& value) {
    const std::size_t at = oem.find(key + " = ");
    return oem.substr(0, at) + key + " = " + value + oem.substr(oem.find('\n', at));
  };
  expect_refused("orbit.oem", with_line("START_TIME", "1677-01-01T00:00:00"),
                 {"orbit.oem", "must lie in 1900 to 2189"});
  expect_refused("orbit.oem", with_line("CENTER_NAME", "MARS\x1b[2J"),
                 {"CENTER_NAME = MARS\\x1b[2J: must be EARTH"});
}

TEST(Process, RefusesWhatIsNoFile) {
  const PassCopy pass{"nominal"};
  const auto pipe = pass.folder.path() / "pipe.csv";
  ASSERT_EQ(mkfifo(pipe.c_str(), 0600), 0);
  refused(arguments(pass.mission(), pipe, pass.db),
          {"pipe.csv: cannot be read: not a regular file"});
}

TEST(Process, RefusesADatabaseThatIsNotOursAndLeavesItAlone) {
  const PassCopy pass{"nominal"};
  {
    SQLite::Database foreign{pass.db.string(), SQLite::OPEN_READWRITE | SQLite::OPEN_CREATE};
    foreign.exec("CREATE TABLE letters (a TEXT)");
  }
  const std::string before = text_of(pass.db);
  refused(pass.arguments_here(), {pass.db.string()});
  EXPECT_EQ(text_of(pass.db), before);
}

TEST(Process, TakesAnEmptyTelemetryFileForRejectedInputBesideOthersOnly) {
  const PassCopy pass{"nominal"};
  pass.folder.write("empty.csv", "");
  const Ran beside = succeeded(pass.arguments_here());
  EXPECT_EQ(beside.json()["runs"][0]["input_rejected"], 1);
  const auto rows = rows_of(pass.db, "SELECT source, line, reason FROM rejected_input");
  ASSERT_EQ(rows.size(), 1U);
  EXPECT_THAT(rows[0], HasSubstr("empty.csv|1|the file is empty"));

  refused(with(pass.arguments_here(), {"--strict"}), {});
  refused(arguments(pass.mission(), pass.folder.path() / "empty.csv", pass.db),
          {"no row of telemetry", "empty.csv: empty"});
}

TEST(Process, RefusesAnArchiveWhereNoFileCanBe) {
  const std::string no_file = "takes this name for something else than a file";
  for (const auto& [db, says] : {std::pair<std::string, std::string>{"/no/folder/out.db", "/"},
                                 {"/proc/out.db", "/"},
                                 {":memory:", no_file},
                                 {"file:pass.db", no_file}}) {
    refused(arguments("nominal", db), {says});
  }
}

TEST(Process, StoresEveryKindOfImpossibleRowWithItsReasonAndKeepsTheRest) {
  const PassCopy pass{"nominal"};
  // The times of the first three are in the years 1700, 2600 (beyond 64 bits) and 2262.
  const std::vector<std::string> rows = {"-8520336000000000000,sun1",
                                         "19880899200000000000,sun1",
                                         "9223372036854775807,sun1",
                                         "-9223372036854775808,sun1",
                                         "nan,sun1",
                                         "inf,sun2",
                                         "-inf,sun2",
                                         "noon,north_in",
                                         "1795143637568806257,sun3",
                                         "1795143637568806257,",
                                         "1795143637568806257",
                                         "17951436375",
                                         "1795143637568806257,sun1,sun2"};
  pass.folder.write("bad.csv", fmt::format("t_tai_ns,channel\r\n{}\r\n", fmt::join(rows, "\r\n")));
  const Ran program = succeeded(pass.arguments_here());
  EXPECT_EQ(program.json()["runs"][0]["input_rejected"], rows.size());
  EXPECT_EQ(number_of(pass.db,
                      "SELECT count(DISTINCT line) FROM rejected_input WHERE source LIKE "
                      "'%/bad.csv' AND reason != '' AND line BETWEEN 2 AND 14"),
            static_cast<std::int64_t>(rows.size()));
  EXPECT_THAT(
      rows_of(pass.db, "SELECT reason FROM rejected_input WHERE line IN (9, 10) ORDER BY line"),
      ElementsAre(HasSubstr("noon"), HasSubstr("sun3")));
  EXPECT_THAT(program.log, HasSubstr("13 bad rows of telemetry"));
  EXPECT_EQ(product_rows(pass.db), product_rows(Processed{"nominal"}.db));
}

TEST(Process, CountsImpossibleCodedFrames) {
  const PassCopy pass{"nominal"};
  pass.folder.write("coded.csv",
                    "t_tai_ns,period_s,sun2_s,north_in_s,north_out_s,south_in_s,south_out_s\n"
                    "1795143637568985513,nan,0.07932,,,,\n"
                    "1795143637568985513,1.0,inf,,,,\n"
                    "1795143637568985513,-1.0,,,,,\n"
                    "1795143637568985513,1.0,2.5,,,,\n"
                    "1795143637568985513,1.0,0.07\n");
  succeeded(pass.arguments_here());
  EXPECT_THAT(rows_of(pass.db, "SELECT reason FROM rejected_input ORDER BY line"),
              ElementsAre(HasSubstr("period_s = \"nan\""), HasSubstr("sun2_s = \"inf\""),
                          HasSubstr("period_s = -1"), HasSubstr("sun2_s = 2.5"),
                          HasSubstr("has 3 columns, must have 7")));
}

TEST(CommandLine, IsRefusedWithTwoWhenBad) {
  for (const std::vector<std::string>& bad : std::vector<std::vector<std::string>>{
           {},
           {"process"},
           {"levitate"},
           {"process", "--mission", "", "--telemetry", "t", "--db", "d"},
           {"process", "--mission", "m", "--telemetry", "", "--db", "d"},
           {"process", "--mission", "m", "--telemetry", "t", "--db", ""},
           {"doctor", "--db", ""},
           {"simulate"},
           {"simulate", "s"},
           {"simulate", "", "--out", "o"},
           {"simulate", "s", "--out", ""},
           {"simulate", "s", "--out", "o", "--runs", "0"},
           {"simulate", "s", "--out", "o", "--jobs", "2"},
           {"simulate", "s", "--out", "o", "--publish", "--runs", "2"},
           {"simulate", "s", "--out", "o", "--runs", "2", "--plots"},
           {"simulate", "s", "--out", "o", "--speed", "2"},
           {"simulate", "s", "--out", "o", "--partition", "replay"},
           {"simulate", "s", "--publish", "--speed", "-1"},
           {"simulate", "s", "--publish", "--partition", "*"},
           {"replay", "--mission", "m", "--telemetry", "t", "--speed", "-1"},
           {"replay", "--mission", "m", "--telemetry", "t", "--speed", "nan"},
           {"replay", "--mission", "m", "--telemetry", "t", "--speed", "inf"},
           {"replay", "--mission", "m", "--telemetry", "t", "--speed", "1e-9"},
           {"replay", "--mission", "m", "--telemetry", "t", "--speed", "1000001"},
           {"replay", "--mission", "m", "--telemetry", "t", "--partition", ""},
           {"replay", "--mission", "m", "--telemetry", "t", "--partition", "li*"},
           {"serve", "--mission", "m", "--db", "d", "--partition", "liv?"},
           {"serve", "--mission", "m", "--db", "d", "--partition", "[l]ive"},
           {"serve", "--mission", "m", "--db", "d", "--domain", "999"}}) {
    SCOPED_TRACE(fmt::format("{}", fmt::join(bad, " ")));
    // The command line is checked before any file is opened.
    EXPECT_EQ(refused(bad, {"--help"}).out, "");
  }
}

TEST(CommandLine, NamesTheWordsThatItDoesNotKnowAndWhatIsMissing) {
  struct Bad {
    std::vector<std::string> words;
    std::string message;
  };
  for (const auto& [words, message] : std::vector<Bad>{
           {{"foo"},
            "not known: foo\nA subcommand is required: process, batch, serve, replay, simulate, "
            "doctor, geomag, geometry, reconstruct, compare, alerts, act\n"},
           {{"process", "--misson", "m", "--db", "d"},
            "not known: --misson m\n--mission is required\n"},
           {{"simulate", "--seed", "3", "s", "--out", "o"}, "not known: --seed s\n"}}) {
    const Ran program = refused(words, {});
    EXPECT_EQ(program.log, "spindrift: " + message + "Run with --help for more information.\n");
  }
}

TEST(CommandLine, AnswersAFailureWithOneObjectWhenAskedForJson) {
  for (const std::vector<std::string>& bad :
       std::vector<std::vector<std::string>>{{"process", "--json"},
                                             {"process", "--mission", "/no/mission.toml",
                                              "--telemetry", "t", "--db", "d", "--json"}}) {
    const Ran program = refused(bad, {});
    const std::string error = program.json().at("error");
    EXPECT_NE(error, "");
    EXPECT_THAT(program.log, HasSubstr(error));
  }
}

TEST(CommandLine, FailsWhenItsAnswerCannotBeWritten) {
  const TemporaryFolder folder;
  Program program{arguments("north-only", folder.path() / "out.db"), 0, "/dev/full"};
  EXPECT_EQ(program.exit_status(), 1);
  EXPECT_THAT(program.log(), HasSubstr("standard output"));
}

TEST(CommandLine, TellsItsVersionAndHelp) {
  EXPECT_THAT(succeeded({"--version"}).out, HasSubstr("spindrift "));
  EXPECT_THAT(succeeded({"serve", "--help"}).out, HasSubstr("--partition"));
}

}  // namespace spindrift::process_refusals_test
