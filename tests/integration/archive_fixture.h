/// @file
/// An archive in a temporary folder with sample content and queries on its file.

#pragma once

#include <SQLiteCpp/Database.h>
#include <SQLiteCpp/Statement.h>
#include <gtest/gtest.h>

#include <cstdint>
#include <filesystem>
#include <map>
#include <memory>
#include <numbers>
#include <stdexcept>
#include <string>
#include <utility>
#include <variant>
#include <vector>

#include "pipelines/frames/angle.h"
#include "pipelines/frames/celestial.h"
#include "pipelines/statistics/significance.h"
#include "services/archive/archive.h"
#include "services/archive/connection.h"
#include "tests/support/outcome.h"
#include "tests/support/temporary_folder.h"

namespace spindrift::testing {

inline const RunStart kRunStart{.spacecraft_kind = SpacecraftKind::Spin,
                                .mode = RunMode::Process,
                                .software_version = "0.1.0",
                                .config_toml = "[spacecraft]\nid = \"SPINNER\"\n",
                                .config_sha256 = "00ff",
                                .orbit_sha256 = "0ff0",
                                .telemetry = {"a/pulses.csv", "b/pulses.csv"},
                                .started_utc = "2026-11-20T03:00:00Z"};

inline ArchiveBatch batch_of(const std::string& run_id) {
  return {.run_id = run_id, .spacecraft_id = "SPINNER"};
}

inline ArchiveBatch start_of(const std::string& run_id) {
  ArchiveBatch batch = batch_of(run_id);
  batch.start = kRunStart;
  return batch;
}

inline ArchiveBatch with_products(ArchiveBatch batch, std::vector<Product> products) {
  batch.products = std::move(products);
  return batch;
}

inline ArchiveBatch with_pulses(ArchiveBatch batch, std::vector<ArrivedSample<Pulse>> pulses) {
  batch.samples.of<Pulse>() = std::move(pulses);
  return batch;
}

/// Returns a batch of run-1 that goes on from an instant.
inline ArchiveBatch going_on_from(std::int64_t t_tai_ns) {
  ArchiveBatch batch = batch_of("run-1");
  batch.continuation = Continuation{.t = tai_from_ns(t_tai_ns)};
  return batch;
}

inline ArrivedSample<Pulse> pulse_at(std::int64_t t_tai_ns, std::uint64_t seq = 0) {
  return {.spacecraft = "SPINNER",
          .origin = {.source = "station", .session = 7, .seq = seq},
          .value = {.t = tai_from_ns(t_tai_ns), .channel = PulseChannel::Sun1}};
}

inline SpinEstimate estimate_at(std::int64_t t_tai_ns, SpinEstimator estimator, double dec_deg) {
  return {.t = tai_from_ns(t_tai_ns),
          .estimator = estimator,
          .axis_icrf = direction_icrf({.ra_rad = 1.0, .dec_rad = dec_deg * kRadPerDeg}),
          .covariance_rad2 = Eigen::Matrix2d{{4e-8, 1e-8}, {1e-8, 5e-8}},
          .spin_rate_rad_s = 100.0 * std::numbers::pi / 30.0,
          .spin_rate_sigma_rad_s = 0.01 * std::numbers::pi / 30.0,
          .assessment = {Quality::Ok}};
}

inline AttitudeEstimate attitude_at(std::int64_t t_tai_ns, Quality quality) {
  return {
      .t = tai_from_ns(t_tai_ns),
      .q_icrf_body = Eigen::Quaterniond{0.5, -0.5, 0.1, 0.7},
      .rate_body_rad_s = Eigen::Vector3d{0.25, -0.5, 1.0},
      .covariance_rad2 = Eigen::Vector3d{4.0, 16.0, 16.0}.asDiagonal() * (kRadPerDeg * kRadPerDeg),
      .assessment = {quality, {{ReasonCode::SensorGated, {{"sensor", std::string{"sun"}}}}}}};
}

/// Returns the first column of every row.
inline std::vector<std::string> column(SQLite::Database& database, const std::string& query) {
  std::vector<std::string> values;
  SQLite::Statement statement{database, query};
  while (statement.executeStep()) {
    values.push_back(statement.getColumn(0).getString());
  }
  return values;
}

class ArchiveFixture : public ::testing::Test {
 protected:
  const std::filesystem::path& directory() const { return folder_.path(); }
  std::filesystem::path path() const { return folder_.path() / "pass.db"; }

  std::unique_ptr<Archive> open(ArchiveOptions options = {}) const {
    return value_or_throw(Archive::open(path(), std::move(options)));
  }

  /// Commits the batches, each with the answer in force behind it as supervision adds it, through
  /// an archive that is opened for them and closed again.
  void store(const std::vector<ArchiveBatch>& batches) {
    const auto archive = open();
    for (const ArchiveBatch& batch : batches) {
      expect(archive->submit(with_answer(batch)));
    }
    expect(archive->close());
  }
  void store(const ArchiveBatch& batch) { store(std::vector{batch}); }
  /// Commits the first products of run-1.
  void store_run(std::vector<Product> products) {
    store(with_products(start_of("run-1"), std::move(products)));
  }
  /// Commits further products of run-1.
  void store_more(std::vector<Product> products) {
    store(with_products(batch_of("run-1"), std::move(products)));
  }
  /// Commits the batches through an open archive.
  void commit(Archive& archive, const std::vector<ArchiveBatch>& batches) {
    for (const ArchiveBatch& batch : batches) {
      expect(archive.submit(with_answer(batch)));
    }
    expect(archive.flush());
  }
  void commit(Archive& archive, const ArchiveBatch& batch) { commit(archive, std::vector{batch}); }

  SQLite::Database reader() const { return value_or_throw(open_for_reading(path())); }

  std::int64_t number(const std::string& query) const {
    return reader().execAndGet(query).getInt64();
  }
  /// @param from Table, with what joins and restricts its rows.
  std::int64_t count(const std::string& from) const {
    return number("SELECT count(*) FROM " + from);
  }
  double real(const std::string& query) const { return reader().execAndGet(query).getDouble(); }
  std::string text(const std::string& query) const {
    return reader().execAndGet(query).getString();
  }
  /// Returns the first column of every row.
  std::vector<std::string> texts(const std::string& query) const {
    SQLite::Database database = reader();
    return column(database, query);
  }

 private:
  static void expect(const Expected<void>& done) {
    if (!done) {
      throw std::runtime_error{done.error().message};
    }
  }

  ArchiveBatch with_answer(ArchiveBatch batch) {
    SpinAnswers& answers = answers_.try_emplace(batch.run_id, kContradictionSigmas).first->second;
    for (const OperatorAction& action : batch.actions) {
      if (action.action == "mark_manoeuvre") {
        answers.note_manoeuvre(action.t.value());
      }
    }
    bool may_change = false;
    for (const Product& product : batch.products) {
      if (const auto* const estimate = std::get_if<SpinEstimate>(&product)) {
        answers.take(*estimate);
        may_change = true;
      }
    }
    if (may_change) {
      batch.products.emplace_back(*answers.in_force());
    }
    return batch;
  }

  TemporaryFolder folder_;
  std::map<std::string, SpinAnswers> answers_;  ///< Answers by run.
};

}  // namespace spindrift::testing
