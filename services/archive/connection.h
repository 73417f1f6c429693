/// @file
/// Opening an archive's file, and SQLite's exceptions as errors.

#pragma once

#include <SQLiteCpp/Database.h>
#include <SQLiteCpp/Exception.h>

#include <filesystem>
#include <string>
#include <string_view>
#include <type_traits>

#include "pipelines/core/expected.h"

namespace spindrift {

/// Looks at the head of the file and touches nothing. A file that is absent or empty may become
/// an archive.
/// @return InvalidConfiguration when `path` is not an archive, or one with other tables than this
///         program's, saying what to do.
Expected<void> refuse_foreign_file(const std::filesystem::path& path);

/// What of the head of a file tells whether it is an archive.
inline constexpr int kHeaderBytes = 72;

/// Of this program's schema.
bool is_header_of_archive(std::string_view header);

/// InvalidConfiguration: `path` as it was given, and why no archive can be there.
Unexpected no_archive_at(const std::filesystem::path& path, std::string_view why);

/// @return InvalidConfiguration for what is there and no file, and for a name that SQLite takes for
///         something else: ":memory:", and "file:" as a URI.
Expected<void> refuse_no_file(const std::filesystem::path& path);

/// The one connection that writes: made if absent, WAL with a sync at every commit. Its caller
/// holds the archive's WriteLock.
/// @return InvalidConfiguration when the file is not an archive or has another schema, which leaves
///         it untouched; Unavailable when it cannot be opened.
Expected<SQLite::Database> open_for_writing(const std::filesystem::path& path);

/// A connection that cannot write, for one thread. Where no file may be made beside an archive that
/// nobody writes, it is read as one that does not change.
/// @return InvalidConfiguration when there is no such file, it is not an archive or has another
///         schema; Unavailable when it cannot be opened.
Expected<SQLite::Database> open_for_reading(const std::filesystem::path& path);

/// Likewise, for an archive that nobody writes: leaves nothing beside it, as an ordinary connection
/// that may not tidy up would. What is read while somebody begins to write may be half old.
Expected<SQLite::Database> open_at_rest(const std::filesystem::path& path);

/// Where SQLite keeps what is committed and not yet in the archive's file.
std::filesystem::path log_of(const std::filesystem::path& archive);

/// InvalidInput when a row breaks a rule of the schema and trying again is no use; Unavailable
/// otherwise (disk full, I/O error, busy).
Error archive_error(const std::string& path, const SQLite::Exception& exception);

/// What `read` finds in an archive, by a connection of its own.
/// @param read Takes an SQLite::Database&; may throw SQLite::Exception.
/// @return As open_for_reading; Unavailable when reading fails.
template <class Read>
auto read_archive(const std::filesystem::path& path, const Read& read)
    -> Expected<std::invoke_result_t<Read, SQLite::Database&>> {
  auto database = open_for_reading(path);
  if (!database) {
    return Unexpected{database.error()};
  }
  try {
    return read(*database);
  } catch (const SQLite::Exception& exception) {
    return Unexpected{archive_error(path.string(), exception)};
  }
}

}  // namespace spindrift
