/// @file
/// The tables and views of an archive, created when the file is new.

#pragma once

#include <SQLiteCpp/Database.h>

#include <cstdint>

namespace spindrift {

/// Application id in the header of every archive: "spdr".
inline constexpr std::int32_t kArchiveApplicationId = 0x73706472;

/// PRAGMA user_version of the archives, to be raised with every change of a table or view.
inline constexpr int kArchiveSchemaVersion = 37;

/// Creates tables and views in `database` in one transaction, unless it is an archive already.
/// @throws SQLite::Exception
void make_schema(SQLite::Database& database);

/// Writes the leap seconds that this program knows, in the transaction of the caller; the views use
/// them for UTC. @throws SQLite::Exception
void refresh_leap_seconds(SQLite::Database& database);

}  // namespace spindrift
