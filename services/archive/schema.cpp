#include "services/archive/schema.h"

#include <SQLiteCpp/Statement.h>
#include <SQLiteCpp/Transaction.h>
#include <fmt/format.h>

#include "pipelines/time/utc.h"

namespace spindrift {

namespace embedded {
extern const char* const schema_tables;
extern const char* const schema_views;
}  // namespace embedded

void make_schema(SQLite::Database& database) {
  SQLite::Transaction transaction{database, SQLite::TransactionBehavior::IMMEDIATE};
  if (database.execAndGet("PRAGMA application_id").getInt() != kArchiveApplicationId) {
    database.exec(embedded::schema_tables);
    database.exec(embedded::schema_views);
    database.exec(fmt::format("PRAGMA application_id = {}; PRAGMA user_version = {}",
                              kArchiveApplicationId, kArchiveSchemaVersion));
  }
  transaction.commit();
}

void refresh_leap_seconds(SQLite::Database& database) {
  SQLite::Statement insert{database, "INSERT OR REPLACE INTO leap_second VALUES (?, ?)"};
  for (const LeapSecond& leap : leap_seconds()) {
    insert.bind(1, tai_ns(leap.start));
    insert.bind(2, leap.tai_minus_utc_s);
    insert.exec();
    insert.reset();
  }
}

}  // namespace spindrift
