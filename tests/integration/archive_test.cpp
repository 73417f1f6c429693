#include "services/archive/archive.h"

#include <SQLiteCpp/Exception.h>
#include <SQLiteCpp/Statement.h>
#include <fcntl.h>
#include <fmt/format.h>
#include <gmock/gmock.h>
#include <gtest/gtest.h>
#include <sys/wait.h>
#include <unistd.h>

#include <array>
#include <chrono>
#include <csignal>
#include <fstream>
#include <future>
#include <iterator>
#include <map>
#include <numbers>
#include <random>
#include <string>
#include <thread>
#include <utility>
#include <vector>

#include "pipelines/frames/celestial.h"
#include "pipelines/time/utc.h"
#include "services/archive/recent_durations.h"
#include "services/archive/schema.h"
#include "tests/integration/archive_fixture.h"

namespace spindrift {

namespace embedded {
extern const char* const schema_0001_tables;
}

namespace {

using testing::batch_of;
using ::testing::ElementsAre;
using ::testing::HasSubstr;
using ::testing::IsSupersetOf;
using testing::pulse_at;
using testing::start_of;

constexpr double kRadPerDeg = std::numbers::pi / 180.0;
// The product of a few doubles near 1, and degrees of a circle: a few ulps of 360.
constexpr double kDegTolerance = 1e-12;

class ArchiveTest : public testing::ArchiveFixture {};
using Archive = spindrift::Archive;

std::vector<std::string> column(SQLite::Database& database, const std::string& query) {
  std::vector<std::string> values;
  SQLite::Statement statement{database, query};
  while (statement.executeStep()) {
    values.push_back(statement.getColumn(0).getString());
  }
  return values;
}

std::string bytes_of(const std::filesystem::path& path) {
  std::ifstream file{path, std::ios::binary};
  return {std::istreambuf_iterator<char>{file}, {}};
}

std::size_t files_in(const std::filesystem::path& directory) {
  return static_cast<std::size_t>(
      std::distance(std::filesystem::directory_iterator{directory}, {}));
}

SpinFix fix_at(double ra_deg, double dec_deg) {
  const double east_sigma_rad = 0.03 * kRadPerDeg;
  const double north_sigma_rad = 0.04 * kRadPerDeg;
  return {
      .revolution = 12,
      .t = tai_from_ns(1'000'000'000),
      .geometry_case = 3,
      .axis_icrf = direction_icrf({.ra_rad = ra_deg * kRadPerDeg, .dec_rad = dec_deg * kRadPerDeg}),
      .covariance_rad2 =
          Eigen::Vector2d{east_sigma_rad * east_sigma_rad, north_sigma_rad * north_sigma_rad}
              .asDiagonal(),
      .alternate_axes_icrf = {},
      .resolution = Resolution::Geometry,
      .norm = 1.0,
      .accepted = true};
}

SpinEstimate estimate_at(std::int64_t t_tai_ns, SpinEstimator estimator, double dec_deg) {
  return {.t = tai_from_ns(t_tai_ns),
          .estimator = estimator,
          .axis_icrf = direction_icrf({.ra_rad = 1.0, .dec_rad = dec_deg * kRadPerDeg}),
          .covariance_rad2 = Eigen::Matrix2d{{4e-8, 1e-8}, {1e-8, 5e-8}},
          .spin_rate_rad_s = 100.0 * std::numbers::pi / 30.0,
          .spin_rate_sigma_rad_s = 0.01 * std::numbers::pi / 30.0,
          .status = "OK"};
}

TEST_F(ArchiveTest, ANewFileHasTheTablesAndColumnsOfTheContract) {
  const std::map<std::string, std::vector<std::string>> contract = {
      {"spacecraft", {"spacecraft_id", "name", "kind"}},
      {"run",
       {"run_id", "spacecraft_id", "mode", "software_version", "config_toml", "config_sha256",
        "orbit_sha256", "telemetry", "started_utc", "finished_utc"}},
      {"pulse", {"spacecraft_id", "t_tai_ns", "channel"}},
      {"coded_frame",
       {"spacecraft_id", "t_tai_ns", "period_s", "sun2_s", "north_in_s", "north_out_s",
        "south_in_s", "south_out_s"}},
      {"gyro_sample", {"spacecraft_id", "t_tai_ns", "wx_rad_s", "wy_rad_s", "wz_rad_s"}},
      {"star_sample", {"spacecraft_id", "t_tai_ns", "qx", "qy", "qz", "qw"}},
      {"sun_sample", {"spacecraft_id", "t_tai_ns", "sx", "sy", "sz"}},
      {"magnetometer_sample", {"spacecraft_id", "t_tai_ns", "bx_nt", "by_nt", "bz_nt"}},
      {"rejected_input", {"run_id", "source", "session", "line", "reason"}},
      {"pulse_use",
       {"run_id", "spacecraft_id", "t_tai_ns", "channel", "revolution", "accepted", "rejected_by"}},
      {"revolution", {"run_id", "revolution", "t_tai_ns", "period_s"}},
      {"spin_measurement",
       {"run_id", "revolution", "quantity", "value", "unit", "sigma", "accepted", "rejected_by"}},
      {"spin_fix",
       {"run_id", "revolution", "t_tai_ns", "geometry_case", "ra_deg", "dec_deg", "sigma_deg",
        "alternate_ra_deg", "alternate_dec_deg", "resolution", "accepted"}},
      {"spin_estimate",
       {"run_id", "t_tai_ns", "estimator", "ra_deg", "dec_deg", "sigma_deg", "spin_rate_rpm",
        "sigma_rpm", "status"}},
      {"spin_bias", {"run_id", "estimator", "name", "value", "unit", "sigma", "observable"}},
      {"attitude", {"run_id", "t_tai_ns", "source", "qx", "qy", "qz", "qw", "sigma_deg"}},
      {"reconstruction_event",
       {"run_id", "method", "event", "t_tai_ns", "qx", "qy", "qz", "qw", "euler312_icrf_deg_1",
        "euler312_icrf_deg_2", "euler312_icrf_deg_3", "euler312_orbit_deg_1",
        "euler312_orbit_deg_2", "euler312_orbit_deg_3", "sigma_deg"}},
      {"alert",
       {"alert_id", "spacecraft_id", "key", "severity", "state", "raised_tai_ns", "updated_tai_ns",
        "cleared_tai_ns", "count", "message", "evidence"}},
      {"alert_transition", {"alert_id", "t_tai_ns", "from_state", "to_state", "by", "note"}}};
  const auto archive = open();

  SQLite::Database database = reader();
  for (const auto& [table, columns] : contract) {
    EXPECT_THAT(column(database, "SELECT name FROM pragma_table_info('" + table + "')"),
                IsSupersetOf(columns))
        << table;
  }
  EXPECT_THAT(column(database,
                     "SELECT name FROM pragma_table_list"
                     " WHERE type = 'table' AND NOT strict AND name NOT LIKE 'sqlite_%'"),
              ElementsAre());
  EXPECT_EQ(number("PRAGMA user_version"), archive_schema_version());
  EXPECT_EQ(text("PRAGMA journal_mode"), "wal");
  EXPECT_EQ(static_cast<std::size_t>(number("SELECT count(*) FROM leap_second")),
            leap_seconds().size());
}

TEST_F(ArchiveTest, RunIsKeptWithItsProvenance) {
  const auto archive = open();
  ArchiveBatch end = batch_of("run-1");
  end.finished_utc = "2026-11-20T04:00:00Z";

  ASSERT_TRUE(archive->submit(start_of("run-1")));
  ASSERT_TRUE(archive->flush());
  EXPECT_EQ(number("SELECT finished_utc IS NULL FROM run"), 1);
  ASSERT_TRUE(archive->submit(end));
  ASSERT_TRUE(archive->flush());

  EXPECT_EQ(text("SELECT format('%s|%s|%s|%s|%s|%s|%s|%s', run_id, spacecraft_id, kind, mode,"
                 " software_version, config_sha256, started_utc, finished_utc)"
                 " FROM run JOIN spacecraft USING (spacecraft_id)"),
            "run-1|SPINNER|spin|process|0.1.0|00ff|2026-11-20T03:00:00Z|2026-11-20T04:00:00Z");
  EXPECT_EQ(text("SELECT config_toml FROM run"), testing::kRunStart.config_toml);
  EXPECT_EQ(text("SELECT orbit_sha256 FROM run"), testing::kRunStart.orbit_sha256);
  EXPECT_EQ(text("SELECT telemetry FROM run"), testing::kRunStart.telemetry);
}

TEST_F(ArchiveTest, RunWithoutAnOrbitFileHasNoDigestOfOne) {
  const auto archive = open();
  ArchiveBatch batch = start_of("run-1");
  batch.start->orbit_sha256 = std::nullopt;
  ASSERT_TRUE(archive->submit(batch));
  ASSERT_TRUE(archive->flush());

  EXPECT_EQ(number("SELECT orbit_sha256 IS NULL FROM run"), 1);
}

TEST_F(ArchiveTest, PulseThatArrivesTwiceIsStoredOnceWithItsFirstOrigin) {
  const auto archive = open();
  ArchiveBatch batch = start_of("run-1");
  batch.pulses = {pulse_at(5, 1), pulse_at(6, 2), pulse_at(5, 3)};
  ArchiveBatch again = batch_of("run-1");
  again.pulses = {pulse_at(6, 4)};

  ASSERT_TRUE(archive->submit(batch));
  ASSERT_TRUE(archive->submit(again));
  ASSERT_TRUE(archive->flush());

  EXPECT_EQ(text("SELECT group_concat(t_tai_ns || ':' || channel || ':' || source || ':' ||"
                 " session || ':' || seq, ' ') FROM pulse"),
            "5:sun1:station:7:1 6:sun1:station:7:2");
  EXPECT_EQ(archive->statistics().rows_committed, 5U);
}

TEST_F(ArchiveTest, ProductsOfTwoRunsStandSideBySide) {
  const auto archive = open();
  for (const std::string run_id : {"run-1", "run-2"}) {
    ArchiveBatch batch = start_of(run_id);
    batch.products = {fix_at(100.0, -55.0)};
    ASSERT_TRUE(archive->submit(batch));
  }
  ASSERT_TRUE(archive->flush());

  EXPECT_EQ(number("SELECT count(*) FROM spin_fix WHERE revolution = 12"), 2);
}

TEST_F(ArchiveTest, SpinFixIsStoredInDegreesWithItsCovariance) {
  const auto archive = open();
  ArchiveBatch batch = start_of("run-1");
  batch.products = {fix_at(100.0, -55.0)};
  ASSERT_TRUE(archive->submit(batch));
  ASSERT_TRUE(archive->flush());

  EXPECT_NEAR(real("SELECT ra_deg FROM spin_fix"), 100.0, kDegTolerance);
  EXPECT_NEAR(real("SELECT dec_deg FROM spin_fix"), -55.0, kDegTolerance);
  EXPECT_NEAR(real("SELECT sigma_deg FROM spin_fix"), 0.05, kDegTolerance);
  EXPECT_NEAR(real("SELECT cov_east_east_deg2 FROM spin_fix"), 0.0009, kDegTolerance);
  EXPECT_NEAR(real("SELECT cov_north_north_deg2 FROM spin_fix"), 0.0016, kDegTolerance);
  EXPECT_EQ(text("SELECT format('%d %d %d %s %g %d', revolution, t_tai_ns, geometry_case,"
                 " resolution, norm, accepted) FROM spin_fix"),
            "12 1000000000 3 GEOMETRY 1 1");
  EXPECT_EQ(number("SELECT alternate_ra_deg IS NULL AND alternate_dec_deg IS NULL FROM spin_fix"),
            1);
}

TEST_F(ArchiveTest, AmbiguousFixKeepsBothCandidates) {
  const auto archive = open();
  SpinFix fix = fix_at(100.0, -55.0);
  fix.alternate_axes_icrf = {fix_at(310.0, 20.0).axis_icrf};
  fix.resolution = Resolution::Ambiguous;
  ArchiveBatch batch = start_of("run-1");
  batch.products = {fix};
  ASSERT_TRUE(archive->submit(batch));
  ASSERT_TRUE(archive->flush());

  EXPECT_NEAR(real("SELECT alternate_ra_deg FROM spin_fix"), 310.0, kDegTolerance);
  EXPECT_NEAR(real("SELECT alternate_dec_deg FROM spin_fix"), 20.0, kDegTolerance);
  EXPECT_EQ(text("SELECT resolution FROM spin_fix"), "AMBIGUOUS");
}

TEST_F(ArchiveTest, RightAscensionStaysBelowAFullTurn) {
  const auto archive = open();
  ArchiveBatch batch = start_of("run-1");
  for (const double y : {-1e-15, -4.5e-16, -1e-16, -1e-18, -0.0, 0.0, 1e-18}) {
    SpinFix fix = fix_at(0.0, 0.0);
    fix.revolution = static_cast<std::int64_t>(batch.products.size());
    fix.axis_icrf = {1.0, y, 0.0};
    batch.products.emplace_back(fix);
  }
  ASSERT_TRUE(archive->submit(batch));
  ASSERT_TRUE(archive->flush()) << archive->statistics().failure->message;

  EXPECT_EQ(number("SELECT count(*) FROM spin_fix WHERE ra_deg >= 0 AND ra_deg < 360"), 7);
}

TEST_F(ArchiveTest, MeasurementsAreStoredInDegreesAndThePeriodInSeconds) {
  const auto archive = open();
  ArchiveBatch batch = start_of("run-1");
  batch.products = {RevolutionProduct{.revolution = 4, .t_sun1 = tai_from_ns(77), .period_s = 0.6},
                    SpinMeasurement{.revolution = 4,
                                    .quantity = SpinQuantity::Period,
                                    .value = 0.6,
                                    .sigma = 1e-4,
                                    .rejected_by = std::nullopt},
                    SpinMeasurement{.revolution = 4,
                                    .quantity = SpinQuantity::SunAngle,
                                    .value = std::numbers::pi / 3.0,
                                    .sigma = std::numbers::pi / 1800.0,
                                    .rejected_by = Rejection::SunAngle}};
  ASSERT_TRUE(archive->submit(batch));
  ASSERT_TRUE(archive->flush());

  EXPECT_EQ(text("SELECT format('%d %d %g', revolution, t_tai_ns, period_s) FROM revolution"),
            "4 77 0.6");
  EXPECT_EQ(text("SELECT group_concat(format('%s %.9g %s %.9g %d %s', quantity, value, unit,"
                 " sigma, accepted, ifnull(rejected_by, '-')), '; ') FROM spin_measurement"),
            "period 0.6 s 0.0001 1 -; sun_angle 60 deg 0.1 0 sun_angle");
}

TEST_F(ArchiveTest, WhatBecameOfEveryEdgeIsStored) {
  const auto archive = open();
  ArchiveBatch batch = start_of("run-1");
  batch.pulses = {pulse_at(5, 1), pulse_at(6, 2)};
  batch.products = {
      PulseUse{.pulse = batch.pulses[0].pulse, .revolution = 3, .rejected_by = std::nullopt},
      PulseUse{.pulse = batch.pulses[1].pulse,
               .revolution = std::nullopt,
               .rejected_by = Rejection::Unassociated}};
  ASSERT_TRUE(archive->submit(batch));
  ASSERT_TRUE(archive->flush());

  EXPECT_EQ(text("SELECT group_concat(format('%s %d %s %s %d %s', spacecraft_id, t_tai_ns, channel,"
                 " ifnull(revolution, '-'), accepted, ifnull(rejected_by, '-')), '; ')"
                 " FROM pulse_use"),
            "SPINNER 5 sun1 3 1 -; SPINNER 6 sun1 - 0 unassociated");
  EXPECT_EQ(text("SELECT rejected_by || ' ' || source || ' ' || seq FROM rejected_pulse"),
            "unassociated station 2");
}

TEST_F(ArchiveTest, EdgeThatBreaksARuleIsNotPassedOverAsIfItWereStored) {
  ASSERT_TRUE(open()->close());
  SQLite::Database{path().string(), SQLite::OPEN_READWRITE}.exec(
      "ALTER TABLE pulse_use ADD COLUMN rule INTEGER CHECK (t_tai_ns <> 6)");
  const auto archive = open();
  const PulseUse good{.pulse = pulse_at(5).pulse, .revolution = 3, .rejected_by = std::nullopt};
  const PulseUse bad{.pulse = pulse_at(6).pulse, .revolution = 3, .rejected_by = std::nullopt};
  ArchiveBatch batch = start_of("run-1");
  batch.products = {good, good};
  ASSERT_TRUE(archive->submit(batch));
  ASSERT_TRUE(archive->flush());
  EXPECT_EQ(number("SELECT count(*) FROM pulse_use"), 1);

  batch = batch_of("run-1");
  batch.products = {bad};
  ASSERT_TRUE(archive->submit(batch));
  const auto flushed = archive->flush();
  ASSERT_FALSE(flushed);
  EXPECT_EQ(flushed.error().code, ErrorCode::InvalidInput);
  EXPECT_THAT(flushed.error().message, HasSubstr("CHECK constraint failed"));
}

TEST_F(ArchiveTest, RejectedRowsOfOtherPathsAndSessionsAreOtherRows) {
  const auto archive = open();
  ArchiveBatch batch = start_of("run-1");
  batch.rejected = {
      {.source = "a/pulses.csv", .line = 2, .reason = "bad"},
      {.source = "b/pulses.csv", .line = 2, .reason = "bad"},
      {.source = "station", .line = 2, .reason = "bad", .session = 1},
      {.source = "station", .line = 2, .reason = "bad", .session = 18446744073709551615U},
      {.source = "station", .line = 2, .reason = "bad", .session = 1}};
  ASSERT_TRUE(archive->submit(batch));
  ASSERT_TRUE(archive->flush());

  SQLite::Database database = reader();
  EXPECT_THAT(column(database, "SELECT source || ' ' || session FROM rejected_input ORDER BY 1"),
              ElementsAre("a/pulses.csv 0", "b/pulses.csv 0", "station -1", "station 1"));
}

TEST_F(ArchiveTest, RejectedInputAndSourceCountsAreStoredAndTheLatestCountStands) {
  const auto archive = open();
  ArchiveBatch batch = start_of("run-1");
  batch.rejected = {{.source = "pulses.csv", .line = 17, .reason = "channel 'sun3'"}};
  batch.source_counts = {{.source = "station", .received = 5}};
  ArchiveBatch later = batch_of("run-1");
  later.source_counts = {
      {.source = "station", .received = 9, .gaps = 2, .duplicates = 3, .disordered = 4}};
  ASSERT_TRUE(archive->submit(batch));
  ASSERT_TRUE(archive->submit(later));
  ASSERT_TRUE(archive->flush());

  EXPECT_EQ(text("SELECT source || ' ' || line || ' ' || reason FROM rejected_input"),
            "pulses.csv 17 channel 'sun3'");
  EXPECT_EQ(text("SELECT group_concat(format('%s %d %d %d %d', source, received, gaps,"
                 " duplicates, disordered)) FROM source_count"),
            "station 9 2 3 4");
}

TEST_F(ArchiveTest, EstimateIsStoredInDegreesAndTurnsPerMinute) {
  constexpr double kDeg2PerRad2 = 1.0 / (kRadPerDeg * kRadPerDeg);
  const auto archive = open();
  ArchiveBatch batch = start_of("run-1");
  batch.products = {estimate_at(9, SpinEstimator::Mean, 30.0)};
  ASSERT_TRUE(archive->submit(batch));
  ASSERT_TRUE(archive->flush());

  EXPECT_NEAR(real("SELECT dec_deg FROM spin_estimate"), 30.0, kDegTolerance);
  EXPECT_NEAR(real("SELECT sigma_deg FROM spin_estimate"), 3e-4 / kRadPerDeg, kDegTolerance);
  EXPECT_NEAR(real("SELECT cov_east_north_deg2 FROM spin_estimate"), 1e-8 * kDeg2PerRad2,
              kDegTolerance);
  EXPECT_NEAR(real("SELECT spin_rate_rpm FROM spin_estimate"), 100.0, 1e-12);
  EXPECT_NEAR(real("SELECT sigma_rpm FROM spin_estimate"), 0.01, 1e-12);
}

TEST_F(ArchiveTest, AnswerOfAPassIsTheLastEstimateOfEachEstimator) {
  const auto archive = open();
  ArchiveBatch batch = start_of("run-1");
  batch.products = {
      estimate_at(10, SpinEstimator::Mean, 1.0), estimate_at(30, SpinEstimator::Mean, 3.0),
      estimate_at(20, SpinEstimator::Mean, 2.0), estimate_at(15, SpinEstimator::Batch, 4.0)};
  ASSERT_TRUE(archive->submit(batch));
  ASSERT_TRUE(archive->flush());

  SQLite::Database database = reader();
  EXPECT_THAT(column(database,
                     "SELECT format('%s %s %d %.6f', spacecraft_id, estimator, t_tai_ns, dec_deg)"
                     " FROM pass_answer ORDER BY estimator"),
              ElementsAre("SPINNER batch 15 4.000000", "SPINNER mean 30 3.000000"));
}

TEST_F(ArchiveTest, UtcOfTheViewsIsThatOfFormatUtc) {
  constexpr std::int64_t kSecond_ns = 1'000'000'000;
  std::vector<std::int64_t> times_ns;
  for (const LeapSecond& leap : leap_seconds()) {
    for (const std::int64_t offset_ns : {-kSecond_ns - 1, -kSecond_ns, -kSecond_ns / 2,
                                         std::int64_t{-1}, std::int64_t{0}, kSecond_ns}) {
      times_ns.push_back(tai_ns(leap.start) + offset_ns);
    }
  }
  times_ns.erase(times_ns.begin(), times_ns.begin() + 4);  // Before 1972 there is no UTC here.
  std::mt19937_64 rng{1972};
  std::uniform_int_distribution<std::int64_t> until_2040_ns{times_ns.front(),
                                                            2'208'988'800 * kSecond_ns};
  while (times_ns.size() < 1000) {
    times_ns.push_back(until_2040_ns(rng));
  }
  ArchiveBatch batch = start_of("run-1");
  for (const std::int64_t t_tai_ns : times_ns) {
    batch.pulses.push_back(pulse_at(t_tai_ns));
  }
  const auto archive = open();
  ASSERT_TRUE(archive->submit(batch));
  ASSERT_TRUE(archive->flush());

  SQLite::Database database = reader();
  SQLite::Statement rows{database, "SELECT t_tai_ns, utc FROM pulse_utc"};
  std::size_t compared = 0;
  while (rows.executeStep()) {
    const std::int64_t t_tai_ns = rows.getColumn(0).getInt64();
    EXPECT_EQ(rows.getColumn(1).getString(), format_utc(tai_from_ns(t_tai_ns), 3)) << t_tai_ns;
    ++compared;
  }
  EXPECT_EQ(compared, times_ns.size());
}

TEST_F(ArchiveTest, EveryViewOfAPersonHasItsUtc) {
  constexpr std::int64_t kNewYear2017_ns = 1'483'228'837'000'000'000;
  const auto archive = open();
  ArchiveBatch batch = start_of("run-1");
  SpinFix fix = fix_at(100.0, -55.0);
  fix.t = tai_from_ns(kNewYear2017_ns);
  batch.products = {RevolutionProduct{.revolution = 12, .t_sun1 = fix.t, .period_s = 0.6},
                    SpinMeasurement{.revolution = 12,
                                    .quantity = SpinQuantity::Period,
                                    .value = 0.6,
                                    .sigma = 1e-4,
                                    .rejected_by = std::nullopt},
                    fix, estimate_at(kNewYear2017_ns, SpinEstimator::Mean, 1.0)};
  ASSERT_TRUE(archive->submit(batch));
  ASSERT_TRUE(archive->flush());

  for (const std::string view : {"revolution_utc", "spin_measurement_utc", "spin_fix_utc",
                                 "spin_estimate_utc", "pass_answer"}) {
    EXPECT_EQ(text("SELECT utc FROM " + view), "2017-01-01T00:00:00.000Z") << view;
  }
}

TEST_F(ArchiveTest, BatchesAreAnnouncedInOrderAndOnlyOnceTheyCanBeRead) {
  std::vector<std::int64_t> announced;
  std::vector<std::int64_t> readable;
  ArchiveOptions options;
  options.on_committed = [&](std::span<const ArchiveBatch> batches) {
    for (const ArchiveBatch& batch : batches) {
      for (const PulseSample& sample : batch.pulses) {
        announced.push_back(tai_ns(sample.pulse.t));
      }
    }
    readable.push_back(number("SELECT count(*) FROM pulse"));
    EXPECT_EQ(readable.back(), static_cast<std::int64_t>(announced.size()));
  };
  const auto archive = open(options);
  ASSERT_TRUE(archive->submit(start_of("run-1")));
  std::vector<std::int64_t> submitted;
  for (std::int64_t t_tai_ns = 0; t_tai_ns < 200; ++t_tai_ns) {
    ArchiveBatch batch = batch_of("run-1");
    batch.pulses = {pulse_at(t_tai_ns)};
    submitted.push_back(t_tai_ns);
    ASSERT_TRUE(archive->submit(batch));
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
  // The first batch alone, so that the writer is held before the others come.
  while (archive->statistics().queued_batches > 0) {
    std::this_thread::yield();
  }
  for (std::int64_t t_tai_ns = 0; t_tai_ns < 100; ++t_tai_ns) {
    ArchiveBatch batch = batch_of("run-1");
    batch.pulses = {pulse_at(t_tai_ns)};
    ASSERT_TRUE(archive->submit(batch));
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

  const auto refused = archive->submit(start_of("run-1"));
  ASSERT_FALSE(refused);
  EXPECT_THAT(refused.error().message, HasSubstr("is closed"));
  EXPECT_TRUE(archive->close());
}

TEST_F(ArchiveTest, SecondWriterIsRefusedWithTheHolderNamed) {
  const auto archive = open();
  const std::filesystem::path link = directory() / "link.db";
  std::filesystem::create_symlink(path(), link);

  for (const std::filesystem::path& name : {path(), link}) {
    const auto second = Archive::open(name, {});
    ASSERT_FALSE(second);
    EXPECT_EQ(second.error().code, ErrorCode::Unavailable);
    EXPECT_THAT(second.error().message,
                HasSubstr("is being written by pid " + std::to_string(getpid()) + " ("));
  }
}

TEST_F(ArchiveTest, LockOfAKilledWriterBlocksNobody) {
  std::array<int, 2> ready{};
  ASSERT_EQ(pipe(ready.data()), 0);
  const pid_t child = fork();
  if (child == 0) {
    const auto archive = open();
    static_cast<void>(write(ready[1], "!", 1));
    pause();
    _exit(0);
  }
  close(ready[1]);
  char byte = 0;
  ASSERT_EQ(read(ready[0], &byte, 1), 1);
  close(ready[0]);

  const auto refused = Archive::open(path(), {});
  ASSERT_FALSE(refused);
  EXPECT_THAT(refused.error().message, HasSubstr("pid " + std::to_string(child)));

  ASSERT_EQ(kill(child, SIGKILL), 0);
  ASSERT_EQ(waitpid(child, nullptr, 0), child);
  EXPECT_TRUE(std::filesystem::exists(path().string() + ".lock"));
  EXPECT_TRUE(Archive::open(path(), {}));
}

TEST_F(ArchiveTest, FileThatIsNotSqliteIsRefusedAndLeftUntouched) {
  for (const std::string& content :
       {std::string{"t_tai_ns,channel\n1,sun1\n"}, std::string{"SQLite format 3\0", 16},
        std::string(4096, 'x')}) {
    std::ofstream{path(), std::ios::binary | std::ios::trunc} << content;

    const auto archive = Archive::open(path(), {});
    ASSERT_FALSE(archive);
    EXPECT_EQ(archive.error().code, ErrorCode::InvalidConfiguration);
    EXPECT_THAT(archive.error().message, HasSubstr("is not an archive"));
    EXPECT_EQ(bytes_of(path()), content);
    EXPECT_EQ(files_in(directory()), 1U);
  }
}

TEST_F(ArchiveTest, DatabaseOfAnotherProgramIsRefusedAndLeftUntouched) {
  SQLite::Database{path().string(), SQLite::OPEN_READWRITE | SQLite::OPEN_CREATE}.exec(
      "PRAGMA application_id = 42; PRAGMA journal_mode = WAL; CREATE TABLE pulse (x)");
  const std::string before = bytes_of(path());

  for (const auto& error : {Archive::open(path(), {}).error(), open_for_reading(path()).error()}) {
    EXPECT_EQ(error.code, ErrorCode::InvalidConfiguration);
    EXPECT_THAT(error.message, HasSubstr("application_id 42"));
  }
  EXPECT_EQ(bytes_of(path()), before);
  EXPECT_EQ(files_in(directory()), 1U);
}

TEST_F(ArchiveTest, NewerSchemaIsRefusedWithBothVersions) {
  ASSERT_TRUE(open()->close());
  SQLite::Database{path().string(), SQLite::OPEN_READWRITE}.exec("PRAGMA user_version = 99");

  const auto archive = Archive::open(path(), {});
  ASSERT_FALSE(archive);
  EXPECT_EQ(archive.error().code, ErrorCode::InvalidConfiguration);
  EXPECT_THAT(archive.error().message, HasSubstr("schema version 99"));
  EXPECT_THAT(archive.error().message,
              HasSubstr("writes version " + std::to_string(archive_schema_version())));
}

TEST_F(ArchiveTest, SchemaVersionThatNoArchiveHasIsRefused) {
  ASSERT_TRUE(open()->close());
  for (const std::string version : {"0", "-1", "-2147483648"}) {
    SQLite::Database{path().string(), SQLite::OPEN_READWRITE}.exec("PRAGMA user_version = " +
                                                                   version);
    const auto archive = Archive::open(path(), {});
    ASSERT_FALSE(archive);
    EXPECT_EQ(archive.error().code, ErrorCode::InvalidConfiguration);
    EXPECT_THAT(archive.error().message, HasSubstr("schema version " + version + ", which no"));
  }
}

TEST_F(ArchiveTest, EmptyFileBecomesAnArchive) {
  std::ofstream{path()}.close();
  ASSERT_TRUE(open()->close());
  EXPECT_EQ(number("PRAGMA application_id"), kArchiveApplicationId);
}

TEST_F(ArchiveTest, OlderSchemaIsBroughtForwardWithItsRows) {
  {
    SQLite::Database old{path().string(), SQLite::OPEN_READWRITE | SQLite::OPEN_CREATE};
    old.exec("PRAGMA application_id = " + std::to_string(kArchiveApplicationId));
    old.exec(embedded::schema_0001_tables);
    old.exec(
        "PRAGMA user_version = 1; INSERT INTO spacecraft VALUES ('OLD', 'Old', 'spin');"
        "INSERT INTO pulse VALUES ('OLD', 1000000000, 'sun2', 'station', 7, 3)");
  }
  ASSERT_TRUE(open()->close());

  EXPECT_EQ(number("PRAGMA user_version"), archive_schema_version());
  EXPECT_EQ(text("SELECT name FROM spacecraft"), "Old");
  EXPECT_EQ(text("SELECT spacecraft_id || channel || source || session || seq FROM pulse"),
            "OLDsun2station73");
  EXPECT_EQ(number("SELECT count(*) FROM pulse_utc WHERE arrival IS NULL"), 1);
  EXPECT_EQ(number("SELECT count(*) FROM pass_answer"), 0);
}

TEST_F(ArchiveTest, TablesOfEveryEdgeTakeNoOtherNamesThanThoseOfTheContract) {
  ASSERT_TRUE(open()->close());
  SQLite::Database raw{path().string(), SQLite::OPEN_READWRITE};
  raw.exec("INSERT INTO spacecraft VALUES ('A', 'A', 'spin')");
  const std::string run =
      "INSERT INTO run VALUES ('r', 'A', 'live', '', '', '', NULL, '', '', NULL, 0, 0)";
  raw.exec(run);
  const auto takes = [&raw](const std::string& values) {
    return raw.tryExec("INSERT INTO " + values) == SQLite::OK;
  };
  for (const char* channel :
       {"sun1", "sun2", "north_in", "north_out", "south_in", "south_out", "Sun1", "", "sun"}) {
    const bool known = pulse_channel_from(channel).has_value();
    EXPECT_EQ(takes(fmt::format("pulse VALUES ('A', 1, '{}', '', 0, 0, 0)", channel)), known);
    EXPECT_EQ(takes(fmt::format("pulse_use VALUES ('r', 'A', 1, '{}', 1, 1, NULL)", channel)),
              known);
  }
  EXPECT_TRUE(takes("spin_measurement VALUES ('r', 1, 'mixed_azimuth', 1, 'deg', 1, 1, NULL)"));
  EXPECT_FALSE(takes("spin_measurement VALUES ('r', 1, 'azimuth', 1, 'deg', 1, 1, NULL)"));
  EXPECT_TRUE(
      takes("spin_fix VALUES ('r', 1, 1, 1, 1, 1, 1, 1, 0, 1, NULL, NULL, 'AMBIGUOUS', 1, 1)"));
  EXPECT_FALSE(takes("spin_fix VALUES ('r', 2, 1, 1, 1, 1, 1, 1, 0, 1, NULL, NULL, 'NONE', 1, 1)"));
  EXPECT_TRUE(takes("spin_estimate VALUES ('r', 1, 'batch', 1, 1, 1, 1, 0, 1, 1, 1, 'OK')"));
  EXPECT_FALSE(takes("spin_estimate VALUES ('r', 1, 'mode', 1, 1, 1, 1, 0, 1, 1, 1, 'OK')"));
}

TEST_F(ArchiveTest, PathThatCannotBeThatOfAFileIsRefusedAndLeavesNoLock) {
  const std::filesystem::path folder = directory() / "folder";
  std::filesystem::create_directory(folder);
  std::ofstream{directory() / "file"}.close();
  const std::vector<std::pair<std::filesystem::path, std::string>> cases = {
      {"", "archive \"\": must be the path of a file"},
      {folder, "is a directory, must be a file"},
      {"/dev/null", "is not a regular file"},
      {directory() / "absent" / "pass.db", "there is no directory " + directory().string()},
      {directory() / "file" / "pass.db", "there is no directory " + directory().string()},
      {directory() / "absent/", "there is no directory " + directory().string()}};
  for (const auto& [bad, message] : cases) {
    const auto archive = Archive::open(bad, {});
    ASSERT_FALSE(archive) << bad;
    EXPECT_EQ(archive.error().code, ErrorCode::InvalidConfiguration) << bad;
    EXPECT_THAT(archive.error().message, HasSubstr(message));
    EXPECT_FALSE(std::filesystem::exists(bad.string() + ".lock"));
  }
  EXPECT_EQ(files_in(directory()), 2U);
  EXPECT_EQ(files_in(folder), 0U);
}

TEST_F(ArchiveTest, RelativePathIsThatOfTheSameFile) {
  const auto archive = open();
  const auto again = Archive::open(std::filesystem::relative(path()), {});
  ASSERT_FALSE(again);
  EXPECT_THAT(again.error().message, HasSubstr("is being written by"));
}

TEST_F(ArchiveTest, FolderThatTakesNoFilesIsAnError) {
  const auto archive = Archive::open("/proc/pass.db", {});
  ASSERT_FALSE(archive);
  EXPECT_EQ(archive.error().code, ErrorCode::InvalidConfiguration);
  EXPECT_THAT(archive.error().message, HasSubstr("cannot lock /proc/pass.db.lock"));
}

TEST_F(ArchiveTest, ReaderSeesWhatIsCommittedAndCannotWrite) {
  const auto archive = open();
  ASSERT_TRUE(archive->submit(start_of("run-1")));
  ASSERT_TRUE(archive->flush());

  SQLite::Database database = reader();
  EXPECT_EQ(database.execAndGet("SELECT count(*) FROM run").getInt(), 1);
  EXPECT_THROW(database.exec("DELETE FROM run"), SQLite::Exception);
}

// A process that lost its lock would see another one's sqlite3 delete the log under its feet.
TEST_F(ArchiveTest, LookingAtTheFileLeavesItsWriterTheLocks) {
  constexpr off_t kSqliteSharedFirst = 0x40000002;
  const auto archive = open();
  EXPECT_EQ(number("SELECT count(*) FROM run"), 0);
  EXPECT_FALSE(Archive::open(path(), {}));

  // NOLINTNEXTLINE(cppcoreguidelines-pro-type-vararg): POSIX has no other open
  const int probe = ::open(path().c_str(), O_RDWR | O_CLOEXEC);
  struct flock wanted {};
  wanted.l_type = F_WRLCK;
  wanted.l_whence = SEEK_SET;
  wanted.l_start = kSqliteSharedFirst;
  wanted.l_len = 1;
  // NOLINTNEXTLINE(cppcoreguidelines-pro-type-vararg): nor another fcntl
  ASSERT_EQ(fcntl(probe, F_OFD_GETLK, &wanted), 0);
  EXPECT_EQ(wanted.l_type, F_RDLCK);
  ::close(probe);
}

TEST_F(ArchiveTest, TwoArchivesMergeByNaturalKey) {
  const std::filesystem::path other = directory() / "other.db";
  for (const auto& [name, run_id, first_ns] :
       {std::tuple{path(), "run-1", 0}, std::tuple{other, "run-2", 5}}) {
    auto archive = Archive::open(name, {});
    ASSERT_TRUE(archive) << archive.error().message;
    ArchiveBatch batch = start_of(run_id);
    batch.products = {fix_at(100.0, -55.0)};
    for (int i = 0; i < 10; ++i) {
      batch.pulses.push_back(pulse_at(first_ns + i));
    }
    ASSERT_TRUE((*archive)->submit(batch));
    ASSERT_TRUE((*archive)->close());
  }

  SQLite::Database database{path().string(), SQLite::OPEN_READWRITE};
  database.exec("PRAGMA foreign_keys = ON; ATTACH '" + other.string() + "' AS other");
  for (const std::string table : {"spacecraft", "run", "pulse", "spin_fix"}) {
    database.exec(fmt::format("INSERT OR IGNORE INTO {0} SELECT * FROM other.{0}", table));
  }
  EXPECT_EQ(number("SELECT count(*) FROM pulse"), 15);
  EXPECT_EQ(number("SELECT count(*) FROM spin_fix"), 2);
}

TEST(RecentDurations, P99IsTheSmallestThatNinetyNinePercentDoNotExceed) {
  RecentDurations durations{1000};
  EXPECT_FALSE(durations.p99_ms());
  for (int i = 1; i <= 200; ++i) {
    durations.add(i);
  }
  EXPECT_EQ(durations.p99_ms(), 198.0);
}

TEST(RecentDurations, OldestAreForgottenFirst) {
  RecentDurations durations{2};
  for (const double duration_ms : {9.0, 1.0, 2.0}) {
    durations.add(duration_ms);
  }
  EXPECT_EQ(durations.p99_ms(), 2.0);
}

}  // namespace
}  // namespace spindrift
