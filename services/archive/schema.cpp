#include "services/archive/schema.h"

#include <SQLiteCpp/Statement.h>
#include <SQLiteCpp/Transaction.h>
#include <fmt/format.h>

#include <array>
#include <cstddef>

#include "pipelines/time/utc.h"

namespace spindrift {

namespace embedded {
extern const char* const schema_0001_tables;
extern const char* const schema_0002_views;
extern const char* const schema_0003_restart;
extern const char* const schema_0004_quick_checks;
extern const char* const schema_0005_fix_candidates;
extern const char* const schema_0006_time_order;
extern const char* const schema_0007_batch;
extern const char* const schema_0008_coning;
extern const char* const schema_0009_quick_answers;
extern const char* const schema_0010_estimated_biases;
extern const char* const schema_0011_consider_sigma;
extern const char* const schema_0012_rate_drift;
}  // namespace embedded

namespace {

constexpr std::size_t kMigrations = 12;

std::array<const char*, kMigrations> migrations() {
  return {embedded::schema_0001_tables,         embedded::schema_0002_views,
          embedded::schema_0003_restart,        embedded::schema_0004_quick_checks,
          embedded::schema_0005_fix_candidates, embedded::schema_0006_time_order,
          embedded::schema_0007_batch,          embedded::schema_0008_coning,
          embedded::schema_0009_quick_answers,  embedded::schema_0010_estimated_biases,
          embedded::schema_0011_consider_sigma, embedded::schema_0012_rate_drift};
}

}  // namespace

int archive_schema_version() { return static_cast<int>(kMigrations); }

Expected<void> migrate(SQLite::Database& database) {
  const int version = database.execAndGet("PRAGMA user_version").getInt();
  if (version > archive_schema_version()) {
    return Unexpected{
        {ErrorCode::InvalidConfiguration,
         fmt::format("archive {} has schema version {}, this program writes version {}: it needs "
                     "the newer program",
                     database.getFilename(), version, archive_schema_version())}};
  }
  const bool is_archive =
      database.execAndGet("PRAGMA application_id").getInt() == kArchiveApplicationId;
  if (is_archive && version < 1) {
    return Unexpected{
        {ErrorCode::InvalidConfiguration,
         fmt::format("archive {} has schema version {}, which no archive has: it is damaged; "
                     "restore a copy of it or use another file",
                     database.getFilename(), version)}};
  }
  const auto all = migrations();
  for (auto next = static_cast<std::size_t>(version); next < all.size(); ++next) {
    SQLite::Transaction transaction{database, SQLite::TransactionBehavior::IMMEDIATE};
    database.exec(all.at(next));
    database.exec(fmt::format("PRAGMA application_id = {}; PRAGMA user_version = {}",
                              kArchiveApplicationId, next + 1));
    transaction.commit();
  }
  return {};
}

void refresh_leap_seconds(SQLite::Database& database) {
  SQLite::Transaction transaction{database, SQLite::TransactionBehavior::IMMEDIATE};
  SQLite::Statement insert{database, "INSERT OR REPLACE INTO leap_second VALUES (?, ?)"};
  for (const LeapSecond& leap : leap_seconds()) {
    insert.bind(1, tai_ns(leap.start));
    insert.bind(2, leap.tai_minus_utc_s);
    insert.exec();
    insert.reset();
  }
  transaction.commit();
}

}  // namespace spindrift
