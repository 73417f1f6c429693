/// @file
/// The archive's tables and views: made once, when the file is new.

#pragma once

#include <SQLiteCpp/Database.h>

#include <cstdint>

namespace spindrift {

/// Stands in the header of every archive: "spdr".
inline constexpr std::int32_t kArchiveApplicationId = 0x73706472;

/// PRAGMA user_version of the archives of this program. Whoever changes a table or view raises it.
inline constexpr int kArchiveSchemaVersion = 30;

/// Makes `database` an archive, all of it or nothing, unless it is one already.
/// @throws SQLite::Exception
void make_schema(SQLite::Database& database);

/// Writes the leap seconds this program knows, for the views in UTC.
/// @throws SQLite::Exception
void refresh_leap_seconds(SQLite::Database& database);

}  // namespace spindrift
