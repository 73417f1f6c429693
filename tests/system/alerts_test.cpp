#include <SQLiteCpp/Database.h>
#include <gmock/gmock.h>
#include <gtest/gtest.h>

#include <csignal>
#include <fstream>
#include <nlohmann/json.hpp>
#include <sstream>
#include <string>
#include <vector>

#include "tests/support/archive_rows.h"
#include "tests/support/bus_fixture.h"
#include "tests/support/eventually.h"
#include "tests/support/processed_pass.h"
#include "tests/support/program.h"
#include "tests/support/recorded_files.h"
#include "tests/support/temporary_folder.h"
#include "tests/support/text_of.h"

namespace spindrift::alerts_test {

using ::testing::AllOf;
using ::testing::Contains;
using ::testing::ElementsAre;
using ::testing::HasSubstr;

const std::string kOpenKeys = "SELECT key FROM alert WHERE state <> 'cleared' ORDER BY key";

void process(const PassCopy& pass) {
  Program program{pass.arguments_here()};
  ASSERT_EQ(program.exit_status(), 0) << program.log();
}

/// Holds a pass whose target attitude is far from the actual one.
struct OffTarget : PassCopy {
  OffTarget() : PassCopy{"nominal"} {
    std::ofstream{folder.path() / "mission.toml", std::ios::app}
        << "\n[spin.target]\nra_deg = 10.0\ndec_deg = 20.0\n";
  }
};

TEST(Alerts, AreNotRaisedByRecordedPassesThatAreWell) {
  for (const std::string pass : {"nominal", "north-only", "gms5", "coded"}) {
    const TemporaryFolder folder;
    const auto db = folder.path() / "out.db";
    Program program{arguments(pass, db)};
    ASSERT_EQ(program.exit_status(), 0) << program.log();
    EXPECT_EQ(rows_of(db, "SELECT key FROM alert WHERE severity <> 'info'"),
              std::vector<std::string>{})
        << pass;
  }
}

TEST(Alerts, NameAChannelThatDiesInTheMidstOfAPass) {
  const PassCopy pass{"nominal"};
  std::ifstream whole{kPasses / "nominal" / "pulses.csv"};
  std::ofstream dead{pass.folder.path() / "pulses.csv"};
  int rows = 0;
  for (std::string row; std::getline(whole, row); ++rows) {
    if (rows < 1800 || row.find("north_in") == std::string::npos) {
      dead << row << "\n";
    }
  }
  dead.close();
  process(pass);
  EXPECT_THAT(rows_of(pass.db, kOpenKeys), ElementsAre("channel.silent:north_in|"));
}

/// Two stations send the same edges, the second 5 ms later.
TEST(Alerts, SayThatEdgesComeSeveralTimes) {
  constexpr std::int64_t kBehind_ns = 5'000'000;
  const PassCopy pass{"nominal"};
  std::istringstream rows{text_of(kPasses / "nominal" / "pulses.csv")};
  std::ofstream twice{pass.folder.path() / "pulses.csv", std::ios::app};
  std::string row;
  std::getline(rows, row);
  while (std::getline(rows, row)) {
    const auto comma = row.find(',');
    twice << std::stoll(row.substr(0, comma)) + kBehind_ns << row.substr(comma) << "\n";
  }
  twice.close();
  process(pass);
  EXPECT_THAT(rows_of(pass.db, kOpenKeys), ElementsAre("spin.rejection|"));
  EXPECT_EQ(number_of(pass.db, "SELECT count(*) FROM pulse_use WHERE rejected_by = 'copy'"), 3600);
  EXPECT_EQ(rows_of(pass.db,
                    "SELECT quality FROM spin_estimate WHERE estimator <> 'mean' ORDER BY t_tai_ns "
                    "DESC LIMIT 2"),
            std::vector<std::string>(2, "OK|"));
}

TEST(Alerts, NameAChannelThatIsDeadFromTheStart) {
  for (const std::string dead : {"sun2", "south_out"}) {
    const PassCopy pass{"nominal"};
    std::ofstream{pass.folder.path() / "pulses.csv"}
        << without_channel(dead, text_of(kPasses / "nominal" / "pulses.csv"));
    process(pass);
    EXPECT_THAT(rows_of(pass.db, kOpenKeys), Contains("channel.silent:" + dead + "|"));
  }
}

TEST(Alerts, AreListedAndAcknowledgedByTheirId) {
  const OffTarget pass;
  process(pass);
  EXPECT_THAT(rows_of(pass.db, kOpenKeys), ElementsAre("spin.off_target|"));
  const std::string id = rows_of(pass.db, "SELECT alert_id FROM alert").front();
  const auto ask = [&](std::vector<std::string> arguments) {
    arguments.insert(arguments.begin(), "alerts");
    arguments.insert(arguments.end(), {"--db", pass.db.string()});
    return arguments;
  };
  Program list{ask({})};
  EXPECT_EQ(list.exit_status(), 0) << list.log();
  EXPECT_THAT(list.out(), AllOf(HasSubstr("warning active spin.off_target"),
                                HasSubstr("process run"), HasSubstr("limit")));

  Program unknown{ask({"ack", "none", "--by", "shift", "--note", "seen"})};
  EXPECT_EQ(unknown.exit_status(), 2);
  EXPECT_THAT(unknown.log(), HasSubstr("no alert 'none' is open; open: " + id.substr(0, 16)));
  Program nowhere{{"alerts", "ack", id.substr(0, 16), "--by", "shift", "--note", "seen"}};
  EXPECT_EQ(nowhere.exit_status(), 2);
  EXPECT_THAT(nowhere.log(), HasSubstr("--db is required"));
  Program listed{ask({"--json"})};
  EXPECT_EQ(listed.exit_status(), 0) << listed.log();
  EXPECT_EQ(nlohmann::json::parse(listed.out())["alerts"][0]["state"], "active");
  EXPECT_EQ(nlohmann::json::parse(listed.out())["alerts"][0]["mode"], "process");
  EXPECT_TRUE(nlohmann::json::parse(listed.out())["warnings"].empty());
  Program nobody{ask({"ack", id.substr(0, 16), "--by", "", "--note", "seen"})};
  EXPECT_EQ(nobody.exit_status(), 2);
  EXPECT_THAT(nobody.log(), HasSubstr("by: must be a text, not empty"));
  Program known{{"alerts", "--db", pass.db.string(), "ack", id.substr(0, 16), "--by", "shift",
                 "--note", "seen"}};
  EXPECT_EQ(known.exit_status(), 0) << known.log();
  EXPECT_EQ(rows_of(pass.db, "SELECT state, revision FROM alert"),
            std::vector<std::string>{"acknowledged|2|"});
  EXPECT_EQ(rows_of(pass.db,
                    "SELECT from_state, to_state, by, note FROM alert_transition"
                    " ORDER BY t_tai_ns DESC LIMIT 1"),
            std::vector<std::string>{"active|acknowledged|shift|seen|"});
}

TEST(Alerts, OfAPassThatIsOverAreListedToo) {
  const OffTarget pass;
  process(pass);
  SQLite::Database{pass.db.string(), SQLite::OPEN_READWRITE, kBusy_ms}.exec(
      "UPDATE alert SET state = 'cleared', cleared_tai_ns = updated_tai_ns");
  Program list{{"alerts", "--db", pass.db.string()}};
  EXPECT_EQ(list.exit_status(), 0) << list.log();
  EXPECT_THAT(list.out(),
              AllOf(HasSubstr("warning cleared spin.off_target"), HasSubstr(" until ")));
}

TEST(Alerts, AreChangedInJsonWhereverTheFlagStands) {
  const OffTarget pass;
  process(pass);
  const std::string id = rows_of(pass.db, "SELECT alert_id FROM alert").front().substr(0, 16);
  Program ack{
      {"alerts", "--db", pass.db.string(), "--json", "ack", id, "--by", "shift", "--note", "seen"}};
  EXPECT_EQ(ack.exit_status(), 0) << ack.log();
  auto changed = nlohmann::json::parse(ack.out());
  EXPECT_EQ(changed["alert_id"], id);
  EXPECT_EQ(changed["state"], "acknowledged");
  EXPECT_TRUE(changed["warnings"].empty());
  Program shelve{{"alerts", "--db", pass.db.string(), "shelve", id, "--by", "shift", "--note",
                  "seen", "--minutes", "5", "--json"}};
  EXPECT_EQ(shelve.exit_status(), 0) << shelve.log();
  changed = nlohmann::json::parse(shelve.out());
  EXPECT_EQ(changed["state"], "shelved");
}

TEST(Alerts, OfAProcessRunAreLeftUntilTheServiceThatHoldsTheArchiveEnds) {
  const OffTarget pass;
  process(pass);
  const std::string id = rows_of(pass.db, "SELECT alert_id FROM alert").front().substr(0, 16);
  const bus::BusConfig bus = bus_of_its_own();
  Program service{{"serve", "--mission", (pass.folder.path() / "mission.toml").string(), "--db",
                   pass.db.string(), "--domain", std::to_string(bus.domain), "--partition",
                   bus.partition}};
  ASSERT_TRUE(service.says("ready")) << service.log();
  Program ack{{"alerts", "--db", pass.db.string(), "ack", id, "--by", "shift", "--note", "seen"}};
  EXPECT_EQ(ack.exit_status(), 2);
  EXPECT_THAT(ack.log(), AllOf(HasSubstr("is of a process run"), HasSubstr("when that has ended")));
  service.signal(SIGTERM);
  EXPECT_EQ(service.exit_status(), 0);
}

TEST(Alerts, AreFollowedUntilASignal) {
  const OffTarget pass;
  process(pass);
  const std::string row = rows_of(pass.db, "SELECT alert_id FROM alert").front();
  const std::string id = row.substr(0, row.size() - 1);
  const TemporaryFolder folder;
  const std::string out = (folder.path() / "out").string();
  Program follow{{"alerts", "--db", pass.db.string(), "--follow", "--json"}, 0, out};
  const auto lines = [&] {
    std::vector<std::string> states;
    std::istringstream text{text_of(out)};
    for (std::string line; std::getline(text, line);) {
      states.push_back(nlohmann::json::parse(line)["state"]);
    }
    return states;
  };
  ASSERT_TRUE(eventually([&] { return lines().size() == 1; })) << follow.log();
  Program ack{{"alerts", "--db", pass.db.string(), "ack", id, "--by", "shift", "--note", "seen"}};
  ASSERT_EQ(ack.exit_status(), 0) << ack.log();
  ASSERT_TRUE(eventually([&] { return lines().size() == 2; })) << follow.log();
  EXPECT_THAT(lines(), ElementsAre("active", "acknowledged"));
  follow.signal(SIGTERM);
  EXPECT_EQ(follow.exit_status(), 0) << follow.log();
}

}  // namespace spindrift::alerts_test
