#include <functional>
#include <new>
#include <stdexcept>
#include <string>
#include <utility>
#include <vector>

#include "services/alerts/alert_desk.h"
#include "services/archive/verdict.h"
#include "services/mission/mission.h"
#include "services/processor/processor.h"
#include "services/processor/what_is_thrown.h"
#include "tests/integration/archive_fixture.h"
#include "tests/support/archive_rows.h"
#include "tests/support/matchers.h"
#include "tests/support/recorded_edges.h"
#include "tests/support/samples.h"
#include "tests/support/test_paths.h"

namespace spindrift::run_fault_test {

const std::filesystem::path kPass = recorded_passes() / "nominal";
constexpr std::size_t kEdges = 240;
/// Index of the edge at which the computation fails.
constexpr std::size_t kBad = 203;

testing::Samples edges_of(const std::string& spacecraft) {
  return testing::edges_of(kPass, kEdges, spacecraft);
}

/// Gives an edge an impossible channel, as after a memory fault. The archive has the right one, but
/// the tables of the computation have no place for it.
void spoil(PassInput& input, TaiTime bad) {
  for (Placed<Pulse>& placed : input.values.of<Pulse>()) {
    if (placed.value.t == bad) {
      placed.value.channel = static_cast<PulseChannel>(kPulseChannels);
    }
  }
}

struct RunFaults : testing::ArchiveFixture {
  std::filesystem::path db(const std::string& name) const { return directory() / (name + ".db"); }

  static std::vector<Mission> missions() {
    std::vector<Mission> missions(2, load_mission(kPass / "mission.toml").value());
    missions[0].spacecraft_id = "FAILS";
    missions[1].spacecraft_id = "SOUND";
    return missions;
  }

  /// Sends `at_once` edges of each spacecraft at a time, after those that are stored.
  /// @param on_submit Supervises the batches.
  static void serve(
      const std::filesystem::path& db, std::size_t at_once, bool stored,
      std::function<void(ArchiveBatch&)> on_submit = [](auto& /*batch*/) {}) {
    const testing::Samples fails = edges_of("FAILS");
    const testing::Samples sound = edges_of("SOUND");
    const auto archive = Archive::open(db, {.on_submit = std::move(on_submit)}).value();
    Processor processor = testing::live_processor(missions());
    const auto work = [&](Routed routed) {
      testing::submit(*archive, std::move(routed.samples));
      for (PassInput& input : routed.work) {
        if (processor.spacecraft().at(input.spacecraft) == "FAILS") {
          spoil(input, fails[kBad].value.t);
        }
        testing::submit(*archive, processor.compute(input));
      }
    };
    if (stored) {
      work(processor.go_on(db).value().routed);
    } else {
      testing::submit(*archive, processor.begin());
      for (std::size_t i = 0; i < kEdges; i += at_once) {
        for (const auto& edges : {fails, sound}) {
          work(processor.route(
              testing::batch_of_samples<Pulse>(testing::part_of(edges, i, i + at_once))));
        }
      }
    }
    testing::submit(*archive, processor.finish());
    ASSERT_TRUE(archive->close());
  }

  static std::int64_t count_of(const std::filesystem::path& db, const std::string& spacecraft,
                               const std::string& rows) {
    return count_rows(db, "run JOIN " + rows + " WHERE run.spacecraft_id = '" + spacecraft + "'");
  }
};

TEST_F(RunFaults, AreOfOneSpacecraftAndMakeItsAnswerDoubtful) {
  AlertDesk desk{missions(), RunMode::Live};
  serve(db("served"), 60, false, [&](ArchiveBatch& batch) { desk.evaluate(batch); });
  for (const std::string spacecraft : {"FAILS", "SOUND"}) {
    EXPECT_EQ(count_of(db("served"), spacecraft, "pulse USING (spacecraft_id)"), kEdges);
  }
  EXPECT_EQ(number_of(db("served"), "SELECT count(*) FROM run WHERE finished_utc IS NOT NULL"), 2);
  EXPECT_THAT(
      rows_of(db("served"),
              "SELECT spacecraft_id, t_tai_ns FROM run_fault JOIN run USING (run_id)"),
      ElementsAre("FAILS|" + std::to_string(tai_ns(edges_of("FAILS")[kBad].value.t)) + "|"));
  const auto fixes = [&](const std::string& spacecraft) {
    return count_of(db("served"), spacecraft, "spin_fix USING (run_id)");
  };
  EXPECT_GT(fixes("FAILS"), 20);
  EXPECT_GT(fixes("SOUND"), fixes("FAILS"));
  // The failure is also visible to clients that read the answers only.
  EXPECT_EQ(
      number_of(db("served"),
                "SELECT count(*) FROM spin_estimate JOIN run USING (run_id) WHERE spacecraft_id = "
                "'FAILS' AND quality = 'DOUBTFUL' AND reasons LIKE '%computing_failed%'"),
      2);
  const std::string verdict =
      rows_of(db("served"),
              "SELECT quality, estimator, why FROM pass_verdict WHERE spacecraft_id = 'FAILS'")
          .at(0);
  EXPECT_THAT(verdict, StartsWith("DOUBTFUL|sequential|computing failed at 20"));
  EXPECT_NE(
      rows_of(db("served"), "SELECT quality FROM pass_verdict WHERE spacecraft_id = 'SOUND'").at(0),
      "DOUBTFUL|");
}

TEST_F(RunFaults, ComeAtTheSamePlaceHoweverTheSamplesComeAndAfterARestart) {
  serve(db("few"), 7, false);
  serve(db("many"), kEdges, false);
  EXPECT_EQ(all_rows(db("few")), all_rows(db("many")));
  const std::vector<std::string> before = all_rows(db("few"));
  serve(db("few"), 7, true);
  EXPECT_EQ(all_rows(db("few")), before);
}

TEST(WhatIsThrown, IsAValueButForMemoryAtItsEnd) {
  EXPECT_FALSE(what_is_thrown([] {}));
  EXPECT_EQ(what_is_thrown([] { throw std::domain_error{"no such angle"}; }), "no such angle");
  EXPECT_THROW(what_is_thrown([] { throw std::bad_alloc{}; }), std::bad_alloc);
}

}  // namespace spindrift::run_fault_test
