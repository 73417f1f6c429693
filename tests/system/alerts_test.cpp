#include <SQLiteCpp/Database.h>

#include <cstdint>
#include <nlohmann/json.hpp>
#include <sstream>
#include <string>
#include <vector>

#include "tests/support/altered_text.h"
#include "tests/support/archive_rows.h"
#include "tests/support/bus_fixture.h"
#include "tests/support/eventually.h"
#include "tests/support/lines.h"
#include "tests/support/matchers.h"
#include "tests/support/on_bus.h"
#include "tests/support/pass_with.h"
#include "tests/support/processed.h"
#include "tests/support/program.h"
#include "tests/support/ran.h"
#include "tests/support/recorded_files.h"
#include "tests/support/temporary_folder.h"
#include "tests/support/text_of.h"

namespace spindrift::alerts_test {

using ::testing::Contains;

std::string nominal() { return text_of(kPasses / "nominal" / "pulses.csv"); }

const std::string kOpenKeys = "SELECT key FROM alert WHERE state <> 'cleared' ORDER BY key";

void process(const PassCopy& pass) { succeeded(pass.arguments_here()); }

void process_with(const PassCopy& pass, const std::string& pulses) {
  pass.folder.write("pulses.csv", pulses);
  process(pass);
}

/// Holds the alerts of a processed pass whose target attitude is far from the actual one.
struct OffTarget : PassWith {
  OffTarget() : PassWith{kOffTarget} {
    process(*this);
    id = rows_of(db, "SELECT alert_id FROM alert").front();
    id.pop_back();
  }
  Words alerts(const Words& words) const { return with({"alerts", "--db", db}, words); }
  /// Returns the words that change the alert.
  Words change(const Words& to) const {
    return with(alerts(to), {id, "--by", "shift", "--note", "seen"});
  }

  std::string id;
};

/// Returns the nominal pass with the edges of a channel later by so much.
std::string with_late(const std::string& channel, std::int64_t late_ns) {
  std::istringstream lines{nominal()};
  std::string altered;
  for (std::string line; std::getline(lines, line);) {
    if (const auto comma = line.find(',' + channel); comma != std::string::npos) {
      line.replace(0, comma, std::to_string(std::stoll(line) + late_ns));
    }
    altered += line + "\n";
  }
  return altered;
}

TEST(Alerts, NameTheChannelOfASpinnerThatContradictsTheOthers) {
  const PassCopy pass{"nominal"};
  process_with(pass, with_late("north_out", 30'000'000));
  EXPECT_THAT(rows_of(pass.db,
                      "SELECT key FROM alert WHERE key LIKE 'sensor.%' AND raised_tai_ns <"
                      " (SELECT min(t_tai_ns) FROM pulse) + 10000000000"),
              ElementsAre("sensor.contradicts:north_out|"));
  EXPECT_THAT(rows_of(pass.db, "SELECT DISTINCT quality FROM spin_estimate WHERE quality = 'OK'"),
              IsEmpty());
  EXPECT_THAT(rows_of(pass.db, "SELECT status FROM spin_estimate WHERE estimator = 'batch'"),
              Contains(HasSubstr("north_out wrong")));
}

TEST(Alerts, NameABeamThatIsDeadFromTheStart) {
  EXPECT_THAT(rows_of(Processed{"north-only"}.db,
                      "SELECT key FROM alert WHERE severity <> 'info' ORDER BY key"),
              ElementsAre("channel.silent:south_in|", "channel.silent:south_out|"));
}

TEST(Alerts, AreNotRaisedByRecordedPassesThatAreWell) {
  for (const std::string pass : {"nominal", "gms5", "coded"}) {
    EXPECT_THAT(rows_of(Processed{pass}.db, "SELECT key FROM alert WHERE severity <> 'info'"),
                IsEmpty())
        << pass;
  }
}

TEST(Alerts, NameAChannelThatDiesInTheMidstOfAPass) {
  const PassCopy pass{"nominal"};
  int rows = 0;
  process_with(pass, with_rows(nominal(), [&](const std::string& row) {
                 return ++rows < 1800 || row.find("north_in") == std::string::npos ? row : "";
               }));
  EXPECT_THAT(rows_of(pass.db, kOpenKeys), ElementsAre("channel.silent:north_in|"));
}

/// Two stations send the same edges, the second 5 ms later.
TEST(Alerts, SayThatEdgesComeSeveralTimes) {
  const PassCopy pass{"nominal"};
  const std::string again =
      with_rows(nominal(), [](const std::string& row) { return later_row(row, 5'000'000); });
  process_with(pass, nominal() + again.substr(again.find('\n') + 1));
  EXPECT_THAT(rows_of(pass.db, kOpenKeys), ElementsAre("spin.rejection|"));
  EXPECT_EQ(count_rows(pass.db, "pulse_use WHERE rejected_by = 'copy'"), 3600);
  EXPECT_EQ(rows_of(pass.db,
                    "SELECT quality FROM spin_estimate WHERE estimator <> 'mean' ORDER BY t_tai_ns "
                    "DESC LIMIT 2"),
            std::vector<std::string>(2, "OK|"));
}

TEST(Alerts, NameAChannelThatIsDeadFromTheStart) {
  for (const std::string dead : {"sun2", "south_out"}) {
    const PassCopy pass{"nominal"};
    process_with(pass, without_channel(dead, nominal()));
    EXPECT_THAT(rows_of(pass.db, kOpenKeys), Contains("channel.silent:" + dead + "|"));
  }
}

TEST(Alerts, AreListedAndAcknowledgedByTheirId) {
  const OffTarget pass;
  EXPECT_THAT(rows_of(pass.db, kOpenKeys), ElementsAre("spin.off_target|"));
  EXPECT_THAT(succeeded(pass.alerts({})).out, AllOf(HasSubstr("warning active spin.off_target"),
                                                    HasSubstr("process run"), HasSubstr("limit")));
  refused({"alerts", "ack", "none", "--by", "shift", "--note", "seen", "--db", pass.db},
          {"no alert 'none' is open; open: " + pass.id});
  refused({"alerts", "ack", pass.id, "--by", "shift", "--note", "seen"}, {"--db is required"});
  const auto listed = succeeded(pass.alerts({"--json"})).json();
  EXPECT_EQ(listed["alerts"][0]["state"], "active");
  EXPECT_EQ(listed["alerts"][0]["mode"], "process");
  EXPECT_TRUE(listed["warnings"].empty());
  refused({"alerts", "ack", pass.id, "--by", "", "--note", "seen", "--db", pass.db},
          {"by: must be a text, not empty"});
  succeeded(pass.change({"ack"}));
  EXPECT_THAT(rows_of(pass.db, "SELECT state, revision FROM alert"),
              ElementsAre("acknowledged|2|"));
  EXPECT_THAT(rows_of(pass.db,
                      "SELECT from_state, to_state, by, note FROM alert_transition ORDER BY "
                      "t_tai_ns DESC LIMIT 1"),
              ElementsAre("active|acknowledged|shift|seen|"));
}

TEST(Alerts, OfAPassThatIsOverAreListedToo) {
  const OffTarget pass;
  SQLite::Database{pass.db.string(), SQLite::OPEN_READWRITE, kBusy_ms}.exec(
      "UPDATE alert SET state = 'cleared', cleared_tai_ns = updated_tai_ns");
  EXPECT_THAT(succeeded(pass.alerts({})).out,
              AllOf(HasSubstr("warning cleared spin.off_target"), HasSubstr(" until ")));
}

TEST(Alerts, AreChangedInJsonWhereverTheFlagStands) {
  const OffTarget pass;
  const auto acknowledged = succeeded(pass.change({"--json", "ack"})).json();
  EXPECT_EQ(acknowledged["alert_id"], pass.id);
  EXPECT_EQ(acknowledged["state"], "acknowledged");
  EXPECT_TRUE(acknowledged["warnings"].empty());
  const auto shelved =
      succeeded(with(pass.change({"shelve"}), {"--minutes", "5", "--json"})).json();
  EXPECT_EQ(shelved["state"], "shelved");
}

TEST(Alerts, OfAProcessRunAreLeftUntilTheServiceThatHoldsTheArchiveEnds) {
  const OffTarget pass;
  Serving service{on(bus_of_its_own(), {"serve", "--mission", pass.mission(), "--db", pass.db})};
  refused(pass.change({"ack"}), {"is of a process run", "when that has ended"});
  stop_in_order(service);
}

TEST(Alerts, AreFollowedUntilASignal) {
  const OffTarget pass;
  const TemporaryFolder folder;
  const std::string out = folder.path() / "out";
  Program follow{pass.alerts({"--follow", "--json"}), 0, out};
  const auto states = [&] {
    std::vector<std::string> told;
    for (const std::string& line : lines_of(text_of(out))) {
      told.push_back(nlohmann::json::parse(line)["state"]);
    }
    return told;
  };
  ASSERT_TRUE(eventually([&] { return states().size() == 1; })) << follow.log();
  succeeded(pass.change({"ack"}));
  ASSERT_TRUE(eventually([&] { return states().size() == 2; })) << follow.log();
  EXPECT_THAT(states(), ElementsAre("active", "acknowledged"));
  stop_in_order(follow);
}

}  // namespace spindrift::alerts_test
