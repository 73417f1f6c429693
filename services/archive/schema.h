/// @file
/// The archive's tables: which version a file has, and bringing it forward to this program's.

#pragma once

#include <SQLiteCpp/Database.h>

#include <cstdint>

#include "pipelines/core/expected.h"

namespace spindrift {

/// Stands in the header of every archive: "spdr".
inline constexpr std::int32_t kArchiveApplicationId = 0x73706472;

/// The version that this program writes: how many migrations it carries.
int archive_schema_version();

/// Applies the migrations that `database`, an archive or empty, lacks, each in a transaction of its
/// own. The first one makes it an archive.
/// @return InvalidConfiguration, with its version, when the archive is newer than this program or
///         has a version that none can have.
/// @throws SQLite::Exception
Expected<void> migrate(SQLite::Database& database);

/// Writes the leap seconds this program knows, for the views in UTC.
/// @throws SQLite::Exception
void refresh_leap_seconds(SQLite::Database& database);

}  // namespace spindrift
