/// @file
/// Opens the file of an archive, and converts SQLite's exceptions to errors.

#pragma once

#include <SQLiteCpp/Database.h>
#include <SQLiteCpp/Exception.h>

#include <filesystem>
#include <string>
#include <string_view>
#include <type_traits>

#include "pipelines/core/expected.h"

namespace spindrift {

class OwnLog;

/// Checks the header of the file without changing anything. An absent or empty file is accepted,
/// since it may become an archive. @return InvalidConfiguration, with advice, when `path` is not an
/// archive or has another schema than this program's.
Expected<void> refuse_foreign_file(const std::filesystem::path& path);

/// Length of the part of the header that identifies an archive.
inline constexpr int kHeaderBytes = 72;

/// Returns whether the header is that of an archive with this program's schema.
bool is_header_of_archive(std::string_view header);

/// Returns InvalidConfiguration with `path` as given and why no archive can be there.
Unexpected no_archive_at(const std::filesystem::path& path, std::string_view why);

/// @return InvalidConfiguration when `path` exists and is not a regular file, or is a name that
/// SQLite does not take for a file: ":memory:" or a URI with "file:".
Expected<void> refuse_no_file(const std::filesystem::path& path);

/// Opens the one connection that writes; creates the file if absent. It uses WAL with a sync at
/// every commit. The caller must hold the archive's WriteLock, and `log` must have been made
/// before.
/// @return InvalidConfiguration when the file is not an archive or has another schema (the file is
/// then untouched); Unavailable when it cannot be opened.
Expected<SQLite::Database> open_for_writing(const std::filesystem::path& path, const OwnLog& log);

/// Opens a connection that cannot write, for use by one thread. When nobody writes the archive and
/// no file may be created beside it, the archive is read as immutable.
/// @return InvalidConfiguration when there is no such file, it is not an archive or has another
/// schema; Unavailable when it cannot be opened.
Expected<SQLite::Database> open_for_reading(const std::filesystem::path& path);

/// Opens an archive that nobody writes for reading, with errors as open_for_reading. It creates no
/// files beside it, which a read-only connection could not remove. If somebody starts to write
/// meanwhile, the data read may be inconsistent.
Expected<SQLite::Database> open_at_rest(const std::filesystem::path& path);

std::filesystem::path log_of(const std::filesystem::path& archive);

/// Returns InvalidInput when a row violates the schema and a retry is useless, and Unavailable
/// otherwise (disk full, I/O error, busy).
Error archive_error(const std::string& path, const SQLite::Exception& exception);

/// Returns the result of `read`, called with a connection of its own.
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
