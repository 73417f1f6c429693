#include "services/archive/archive.h"

#include <future>
#include <map>
#include <set>
#include <string>
#include <thread>
#include <vector>

#include "pipelines/time/utc.h"
#include "services/archive/schema.h"
#include "tests/integration/archive_fixture.h"
#include "tests/support/lines.h"
#include "tests/support/matchers.h"

namespace spindrift::archive_test {

using testing::batch_of;
using ::testing::IsSupersetOf;
using testing::pulse_at;
using testing::start_of;
using ::testing::UnorderedElementsAreArray;
using testing::with_products;
using testing::with_pulses;

class ArchiveTest : public testing::ArchiveFixture {};

/// Returns SQLite's query plan.
std::string plan_of(SQLite::Database& database, const std::string& query) {
  SQLite::Statement plan{database, "EXPLAIN QUERY PLAN " + query};
  plan.executeStep();
  return plan.getColumn(3).getString();
}

TEST_F(ArchiveTest, ANewFileHasTheTablesAndColumnsOfTheContract) {
  const std::map<std::string, std::string> contract = {
      {"spacecraft", "spacecraft_id name kind"},
      {"run",
       "run_id spacecraft_id mode software_version config_toml config_sha256 orbit_sha256 "
       "started_utc finished_utc label last_tai_ns telemetry_sha256"},
      {"pulse", "spacecraft_id t_tai_ns channel"},
      {"coded_frame",
       "spacecraft_id t_tai_ns period_s sun2_s north_in_s north_out_s south_in_s south_out_s"},
      {"gyro_sample", "spacecraft_id t_tai_ns wx_rad_s wy_rad_s wz_rad_s"},
      {"star_sample", "spacecraft_id t_tai_ns qx qy qz qw"},
      {"sun_sample", "spacecraft_id t_tai_ns sx sy sz"},
      {"magnetometer_sample", "spacecraft_id t_tai_ns bx_nt by_nt bz_nt"},
      {"orbit_state_sample", "spacecraft_id t_tai_ns x_km y_km z_km vx_km_s vy_km_s vz_km_s"},
      {"rejected_input", "run_id source session line reason samples"},
      {"pulse_use", "run_id spacecraft_id t_tai_ns channel revolution accepted rejected_by"},
      {"revolution", "run_id revolution t_tai_ns period_s"},
      {"spin_measurement", "run_id revolution quantity value unit sigma accepted rejected_by"},
      {"spin_fix",
       "run_id revolution t_tai_ns geometry_case ra_deg dec_deg sigma_deg alternate_ra_deg "
       "alternate_dec_deg resolution accepted"},
      {"spin_estimate",
       "run_id t_tai_ns estimator ra_deg dec_deg sigma_deg spin_rate_rpm sigma_rpm quality reasons "
       "status announced_utc"},
      {"spin_bias", "run_id estimator name value unit sigma observable estimated"},
      {"attitude",
       "run_id t_tai_ns source qx qy qz qw rate_x_rad_s rate_y_rad_s rate_z_rad_s sigma_deg "
       "noise_sigma_deg quality reasons status cov_xx_deg2 cov_xy_deg2 cov_xz_deg2 cov_yy_deg2 "
       "cov_yz_deg2 "
       "cov_zz_deg2 announced_utc"},
      {"gyro_bias", "run_id t_tai_ns estimator bx_deg_s by_deg_s bz_deg_s"},
      {"notice", "run_id t_tai_ns code arguments says"},
      {"reconstruction_event",
       "run_id method event t_tai_ns qx qy qz qw euler312_icrf_deg_1 euler312_icrf_deg_2 "
       "euler312_icrf_deg_3 euler312_orbit_deg_1 euler312_orbit_deg_2 euler312_orbit_deg_3 "
       "sigma_deg cov_xx_deg2 cov_xy_deg2 cov_xz_deg2 cov_yy_deg2 cov_yz_deg2 cov_zz_deg2"},
      {"alert",
       "alert_id spacecraft_id key severity state raised_tai_ns updated_tai_ns cleared_tai_ns "
       "count message evidence"},
      {"alert_transition", "alert_id t_tai_ns from_state to_state by note"},
      {"operator_action", "action_id spacecraft_id t_tai_ns made_utc by action arguments"},
      {"pass_verdict",
       "run_id spacecraft_id started_utc finished estimator quality ra_deg dec_deg qx qy qz qw "
       "sigma_deg noise_sigma_deg consider_sigma_deg start_utc end_utc contact_share why against"},
      {"separation_verdict",
       "run_id method quality t1_tai_ns qx qy qz qw sigma_deg noise_sigma_deg launcher_angle_deg "
       "why"},
      {"normal_equations", "run_id names b0 n g"},
      {"gate_transition", "run_id t_tai_ns gate open evidence"},
      {"advisory",
       "run_id t_tai_ns sensors qx qy qz qw sigma_deg rate_x_rad_s rate_y_rad_s rate_z_rad_s "
       "may_control says"}};
  const auto archive = open();

  for (const auto& [table, columns] : contract) {
    EXPECT_THAT(texts("SELECT name FROM pragma_table_info('" + table + "')"),
                IsSupersetOf(lines_of(columns, ' ')))
        << table;
  }
  EXPECT_THAT(texts("SELECT name FROM pragma_table_list WHERE type = 'table' AND NOT strict AND "
                    "name NOT LIKE 'sqlite_%'"),
              ElementsAre());
  EXPECT_EQ(number("PRAGMA user_version"), kArchiveSchemaVersion);
  EXPECT_EQ(text("PRAGMA journal_mode"), "wal");
  EXPECT_EQ(static_cast<std::size_t>(count("leap_second")), leap_seconds().size());
}

TEST_F(ArchiveTest, SamplesOfEveryKindSayWhereTheyCameFromAndLieBySpacecraftAndTime) {
  const auto archive = open();
  SQLite::Database database = reader();
  for (const std::string table : {"pulse", "coded_frame", "gyro_sample", "star_sample",
                                  "sun_sample", "magnetometer_sample", "orbit_state_sample"}) {
    EXPECT_THAT(texts("SELECT name FROM pragma_table_info('" + table + "')"),
                IsSupersetOf({"source", "session", "seq", "arrival"}))
        << table;
    EXPECT_THAT(plan_of(database, "SELECT * FROM " + table +
                                      " WHERE spacecraft_id = 'A' AND t_tai_ns BETWEEN 1 AND 2"),
                HasSubstr("(spacecraft_id=? AND t_tai_ns>? AND t_tai_ns<?)"));
  }
}

TEST_F(ArchiveTest, EdgesOfARevolutionAreFoundByAnIndex) {
  const auto archive = open();
  SQLite::Database database = reader();
  EXPECT_THAT(plan_of(database, "SELECT * FROM pulse_use WHERE run_id = 'r' AND revolution = 7"),
              HasSubstr("(run_id=? AND revolution=?)"));
}

TEST_F(ArchiveTest, TheVocabularyOfRejectionsIsThatOfThePipelines) {
  const auto archive = open();
  std::set<std::string> names;
  for (int i = 0; i < kRejections; ++i) {
    names.emplace(name_of(static_cast<Rejection>(i)));
  }
  EXPECT_THAT(texts("SELECT rejected_by FROM rejection"), UnorderedElementsAreArray(names));
}

TEST_F(ArchiveTest, RunIsKeptWithItsProvenance) {
  const auto archive = open();
  ArchiveBatch end = batch_of("run-1");
  end.finished_utc = "2026-11-20T04:00:00Z";

  commit(*archive, start_of("run-1"));
  EXPECT_EQ(number("SELECT finished_utc IS NULL FROM run"), 1);
  commit(*archive, end);

  EXPECT_EQ(text("SELECT format('%s|%s|%s|%s|%s|%s|%s|%s', run_id, spacecraft_id, kind, mode, "
                 "software_version, config_sha256, started_utc, finished_utc) FROM run JOIN "
                 "spacecraft USING (spacecraft_id)"),
            "run-1|SPINNER|spin|process|0.1.0|00ff|2026-11-20T03:00:00Z|2026-11-20T04:00:00Z");
  EXPECT_EQ(text("SELECT config_toml FROM run"), testing::kRunStart.config_toml);
  EXPECT_EQ(text("SELECT orbit_sha256 FROM run"), testing::kRunStart.orbit_sha256);
  EXPECT_EQ(texts("SELECT telemetry FROM run_telemetry ORDER BY position"),
            testing::kRunStart.telemetry);
}

TEST_F(ArchiveTest, RunHasItsLabelTheDigestOfItsTelemetryAndHowFarItReaches) {
  ArchiveBatch batch = start_of("run-1");
  batch.start->label = "second try";
  batch.start->telemetry_sha256 = "f00f";
  batch.start->orbit_sha256 = std::nullopt;
  batch.reach = {.first = tai_from_ns(5), .last = tai_from_ns(7), .contact_share = 0.25};
  ArchiveBatch later = batch_of("run-1");
  later.reach = {.first = tai_from_ns(6), .last = tai_from_ns(9), .contact_share = 0.5};
  store({batch, later});

  EXPECT_EQ(text("SELECT format('%s %s %d %d %g', label, telemetry_sha256, first_tai_ns, "
                 "last_tai_ns, contact_share) FROM run"),
            "second try f00f 5 9 0.5");
  EXPECT_EQ(number("SELECT orbit_sha256 IS NULL FROM run"), 1);
}

TEST_F(ArchiveTest, PulseThatArrivesTwiceIsStoredOnceWithItsFirstOrigin) {
  const auto archive = open();
  commit(*archive,
         {with_pulses(start_of("run-1"), {pulse_at(5, 1), pulse_at(6, 2), pulse_at(5, 3)}),
          with_pulses(batch_of("run-1"), {pulse_at(6, 4)})});

  EXPECT_EQ(text("SELECT group_concat(t_tai_ns || ':' || channel || ':' || source || ':' || "
                 "session || ':' || seq, ' ') FROM pulse"),
            "5:sun1:station:7:1 6:sun1:station:7:2");
  EXPECT_EQ(archive->statistics().rows_committed, 5U);
}

TEST_F(ArchiveTest, EdgeThatBreaksARuleIsNotPassedOverAsIfItWereStored) {
  ASSERT_TRUE(open()->close());
  SQLite::Database{path().string(), SQLite::OPEN_READWRITE}.exec(
      "ALTER TABLE pulse_use ADD COLUMN rule INTEGER CHECK (t_tai_ns <> 6)");
  const auto archive = open();
  const PulseUse good{.pulse = pulse_at(5).value, .revolution = 3, .rejected_by = std::nullopt};
  const PulseUse bad{.pulse = pulse_at(6).value, .revolution = 3, .rejected_by = std::nullopt};
  commit(*archive, with_products(start_of("run-1"), {good, good}));
  EXPECT_EQ(count("pulse_use"), 1);

  ASSERT_TRUE(archive->submit(with_products(batch_of("run-1"), {bad})));
  EXPECT_THAT(archive->flush(),
              IsRefused(ErrorCode::InvalidInput, HasSubstr("CHECK constraint failed")));
}

TEST_F(ArchiveTest, RejectedRowsOfOtherPathsAndSessionsAreOtherRows) {
  ArchiveBatch batch = start_of("run-1");
  batch.rejected = {
      {.source = "a/pulses.csv", .line = 2, .reason = "bad"},
      {.source = "b/pulses.csv", .line = 2, .reason = "bad"},
      {.source = "station", .line = 2, .reason = "bad", .session = 1},
      {.source = "station", .line = 2, .reason = "bad", .session = 18446744073709551615U},
      {.source = "station", .line = 2, .reason = "bad", .session = 1}};
  store(batch);

  EXPECT_THAT(texts("SELECT source || ' ' || session FROM rejected_input ORDER BY 1"),
              ElementsAre("a/pulses.csv 0", "b/pulses.csv 0", "station -1", "station 1"));
}

TEST_F(ArchiveTest, RejectedInputAndSourceCountsAreStoredAndTheLatestCountStands) {
  ArchiveBatch batch = start_of("run-1");
  batch.rejected = {{.source = "pulses.csv", .line = 17, .reason = "channel 'sun3'"}};
  batch.source_counts = {{.source = "station", .received = 5}};
  ArchiveBatch later = batch_of("run-1");
  later.source_counts = {
      {.source = "station", .received = 9, .gaps = 2, .duplicates = 3, .disordered = 4}};
  store({batch, later});

  EXPECT_EQ(text("SELECT source || ' ' || line || ' ' || reason FROM rejected_input"),
            "pulses.csv 17 channel 'sun3'");
  EXPECT_EQ(text("SELECT group_concat(format('%s %d %d %d %d', source, received, gaps, duplicates, "
                 "disordered)) FROM source_count"),
            "station 9 2 3 4");
}

TEST_F(ArchiveTest, BatchesAreAnnouncedInOrderAndOnlyOnceTheyCanBeRead) {
  std::vector<std::int64_t> announced;
  std::vector<std::int64_t> readable;
  ArchiveOptions options;
  options.on_committed = [&](std::span<const ArchiveBatch> batches) {
    for (const ArchiveBatch& batch : batches) {
      for (const ArrivedSample<Pulse>& sample : batch.samples.of<Pulse>()) {
        announced.push_back(tai_ns(sample.value.t));
      }
    }
    readable.push_back(count("pulse"));
    EXPECT_EQ(readable.back(), static_cast<std::int64_t>(announced.size()));
  };
  const auto archive = open(options);
  ASSERT_TRUE(archive->submit(start_of("run-1")));
  std::vector<std::int64_t> submitted;
  for (std::int64_t t_tai_ns = 0; t_tai_ns < 200; ++t_tai_ns) {
    submitted.push_back(t_tai_ns);
    ASSERT_TRUE(archive->submit(with_pulses(batch_of("run-1"), {pulse_at(t_tai_ns)})));
  }
  ASSERT_TRUE(archive->close());

  EXPECT_EQ(announced, submitted);
}

TEST_F(ArchiveTest, WhatIsQueuedDuringACommitGoesIntoTheNextOne) {
  std::promise<void> all_queued;
  std::shared_future<void> go_on = all_queued.get_future().share();
  std::vector<std::size_t> group_sizes;
  ArchiveOptions options;
  options.on_committed = [&](std::span<const ArchiveBatch> batches) {
    group_sizes.push_back(batches.size());
    go_on.wait();
  };
  const auto archive = open(options);
  ASSERT_TRUE(archive->submit(start_of("run-1")));
  // Wait until the writer has taken the first batch alone and is held there.
  while (archive->statistics().queued_batches > 0) {
    std::this_thread::yield();
  }
  for (std::int64_t t_tai_ns = 0; t_tai_ns < 100; ++t_tai_ns) {
    ASSERT_TRUE(archive->submit(with_pulses(batch_of("run-1"), {pulse_at(t_tai_ns)})));
  }
  all_queued.set_value();
  ASSERT_TRUE(archive->flush());

  EXPECT_EQ(archive->statistics().rows_committed, 101U);
  EXPECT_TRUE(archive->statistics().commit_p99_ms.has_value());
  ASSERT_TRUE(archive->close());
  EXPECT_THAT(group_sizes, ElementsAre(1, 100));
}

TEST_F(ArchiveTest, ClosedArchiveRefusesWithAReason) {
  const auto archive = open();
  ASSERT_TRUE(archive->close());

  EXPECT_THAT(archive->submit(start_of("run-1")),
              IsRefused(ErrorCode::Unavailable, HasSubstr("is closed")));
  EXPECT_TRUE(archive->close());
}

}  // namespace spindrift::archive_test
