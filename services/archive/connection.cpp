#include "services/archive/connection.h"

#include <SQLiteCpp/Transaction.h>
#include <fmt/format.h>
#include <sqlite3.h>

#include <cstdint>
#include <string>
#include <string_view>
#include <system_error>
#include <utility>

#include "services/archive/own_log.h"
#include "services/archive/schema.h"

namespace spindrift {
namespace {

constexpr int kBusyTimeout_ms = 5000;

// Layout of the header: https://www.sqlite.org/fileformat.html section 1.3.
constexpr std::string_view kMagic{"SQLite format 3\0", 16};
constexpr std::size_t kUserVersionOffset = 60;
constexpr std::size_t kApplicationIdOffset = 68;
static_assert(kHeaderBytes == kApplicationIdOffset + 4);

std::int32_t number_at(std::string_view header, std::size_t offset) {
  std::uint32_t value = 0;
  for (const char byte : header.substr(offset, 4)) {
    value = value << 8U | static_cast<unsigned char>(byte);
  }
  return static_cast<std::int32_t>(value);
}

void distrust(SQLite::Database& database) {
  database.exec("PRAGMA trusted_schema = OFF; PRAGMA cell_size_check = ON");
  sqlite3_db_config(database.getHandle(), SQLITE_DBCONFIG_DEFENSIVE, 1, nullptr);
}

// Turns off SQLite's count of its memory, which nobody reads and which takes a mutex at every
// allocation. Works only before SQLite is first used; later it changes nothing.
void do_not_count_memory() {
  static const int status = sqlite3_config(SQLITE_CONFIG_MEMSTATUS, 0);
  static_cast<void>(status);
}

// Reads through SQLite's own file handle, because closing another descriptor would drop the POSIX
// locks that a connection of this process holds on the file
// (https://www.sqlite.org/howtocorrupt.html section 2.2). SQL is avoided because it would create
// files beside a foreign database.
Expected<std::string> header_of(const std::filesystem::path& path) {
  try {
    const SQLite::Database database{path.string(), SQLite::OPEN_READONLY};
    sqlite3_file* file = nullptr;
    sqlite3_file_control(database.getHandle(), "main", SQLITE_FCNTL_FILE_POINTER, &file);
    std::string header(kHeaderBytes, '\0');
    const int status = file->pMethods->xRead(file, header.data(), kHeaderBytes, 0);
    if (status != SQLITE_OK && status != SQLITE_IOERR_SHORT_READ) {
      throw SQLite::Exception{sqlite3_errstr(status), status};
    }
    return header;
  } catch (const SQLite::Exception& exception) {
    return Unexpected{archive_error(path.string(), exception)};
  }
}

/// Says why there is nothing to read, which SQLite would not; empty when there is something.
std::string_view why_nothing_to_read(const std::filesystem::path& path) {
  std::error_code unknown;
  const std::filesystem::file_status status = std::filesystem::status(path, unknown);
  if (status.type() == std::filesystem::file_type::not_found) {
    return "no such file";
  }
  return std::filesystem::is_regular_file(status) && std::filesystem::is_empty(path, unknown)
             ? "the file is empty"
             : "";
}

bool is_empty_or_absent(const std::filesystem::path& path) {
  std::error_code absent;
  const std::uintmax_t size = std::filesystem::file_size(path, absent);
  return absent || size == 0;
}

/// Returns `path` as an SQLite URI for a file that nobody changes while it is read.
std::string immutable_uri(const std::filesystem::path& path) {
  std::string uri = "file:";
  for (const char c : path.string()) {
    uri += c == '%' || c == '?' || c == '#' ? fmt::format("%{:02X}", static_cast<unsigned char>(c))
                                            : std::string{c};
  }
  return uri + "?immutable=1";
}

Expected<void> refuse_unreadable(const std::filesystem::path& path) {
  if (auto named = refuse_no_file(path); !named) {
    return named;
  }
  if (const std::string_view why = why_nothing_to_read(path); !why.empty()) {
    return Unexpected{{ErrorCode::InvalidConfiguration,
                       fmt::format("there is no archive {}: {}", path.string(), why)}};
  }
  return refuse_foreign_file(path);
}

}  // namespace

bool is_header_of_archive(std::string_view header) {
  return header.starts_with(kMagic) &&
         number_at(header, kApplicationIdOffset) == kArchiveApplicationId &&
         number_at(header, kUserVersionOffset) == kArchiveSchemaVersion;
}

Unexpected no_archive_at(const std::filesystem::path& path, std::string_view why) {
  return Unexpected{
      {ErrorCode::InvalidConfiguration, fmt::format("archive \"{}\": {}", path.string(), why)}};
}

Expected<void> refuse_no_file(const std::filesystem::path& path) {
  const std::string name = path.string();
  if (name.starts_with(":") || name.starts_with("file:")) {
    return no_archive_at(
        path,
        "SQLite takes this name for something else than a file; an archive is a file, of another "
        "name or with ./ before it");
  }
  std::error_code unknown;  // The caller gets an error when it opens the file.
  const auto status = std::filesystem::status(path, unknown);
  if (std::filesystem::is_directory(status)) {
    return no_archive_at(path, "is a directory, must be a file");
  }
  if (std::filesystem::exists(status) && !std::filesystem::is_regular_file(status)) {
    return no_archive_at(path, "is not a regular file");
  }
  return {};
}

Expected<void> refuse_foreign_file(const std::filesystem::path& path) {
  do_not_count_memory();
  if (is_empty_or_absent(path)) {
    return {};
  }
  const auto header = header_of(path);
  if (!header) {
    return Unexpected{header.error()};
  }
  if (!header->starts_with(kMagic)) {
    return Unexpected{{ErrorCode::InvalidConfiguration,
                       fmt::format("{} is not an archive: it is not an SQLite file; it was left "
                                   "untouched",
                                   path.string())}};
  }
  const std::int32_t application_id = number_at(*header, kApplicationIdOffset);
  if (application_id != kArchiveApplicationId) {
    return Unexpected{{ErrorCode::InvalidConfiguration,
                       fmt::format("{} is not an archive: it is an SQLite file with application_id "
                                   "{}, an archive has {}; it was left untouched",
                                   path.string(), application_id, kArchiveApplicationId)}};
  }
  const std::int32_t version = number_at(*header, kUserVersionOffset);
  if (version != kArchiveSchemaVersion) {
    return Unexpected{
        {ErrorCode::InvalidConfiguration,
         fmt::format("archive {} has schema version {}, this program reads and writes version {} "
                     "only: keep the file for the program that made it, and process its telemetry "
                     "again into a new one",
                     path.string(), version, kArchiveSchemaVersion)}};
  }
  return {};
}

Error archive_error(const std::string& path, const SQLite::Exception& exception) {
  const int code = exception.getErrorCode();
  const bool broken_rule = code == SQLITE_CONSTRAINT || code == SQLITE_MISMATCH;
  return {broken_rule ? ErrorCode::InvalidInput : ErrorCode::Unavailable,
          fmt::format("archive {}: {} (SQLite code {})", path, exception.what(),
                      exception.getExtendedErrorCode())};
}

Expected<SQLite::Database> open_for_writing(const std::filesystem::path& path, const OwnLog& log) {
  if (const auto ours = refuse_foreign_file(path); !ours) {
    return Unexpected{ours.error()};
  }
  try {
    // NOMUTEX, because each connection is used from one thread at a time, and a mutex in every call
    // of SQLite would take a sixth of the time for a row.
    SQLite::Database database{path.string(),
                              SQLite::OPEN_READWRITE | SQLite::OPEN_CREATE | SQLite::OPEN_NOMUTEX,
                              kBusyTimeout_ms};
    distrust(database);
    // Done before the switch to WAL, so that the application id of a new archive is in the file
    // itself and not only in the log.
    make_schema(database);
    const std::string journal = database.execAndGet("PRAGMA journal_mode = WAL").getString();
    if (journal != "wal") {
      return Unexpected{{ErrorCode::Unavailable,
                         fmt::format("archive {}: its file system allows no write-ahead log, only "
                                     "journal_mode {}",
                                     path.string(), journal)}};
    }
    // The cache holds the pages that a hundred spacecraft append to.
    database.exec(
        "PRAGMA synchronous = FULL; PRAGMA foreign_keys = ON; PRAGMA journal_size_limit = "
        "268435456; PRAGMA cache_size = -65536");
    SQLite::Transaction first{database, SQLite::TransactionBehavior::IMMEDIATE};
    log.expect_new(database);
    refresh_leap_seconds(database);
    first.commit();
    return database;
  } catch (const SQLite::Exception& exception) {
    return Unexpected{archive_error(path.string(), exception)};
  }
}

Expected<SQLite::Database> open_at_rest(const std::filesystem::path& path) {
  if (const auto readable = refuse_unreadable(path); !readable) {
    return Unexpected{readable.error()};
  }
  try {
    SQLite::Database database{immutable_uri(path), SQLite::OPEN_READONLY | SQLite::OPEN_URI};
    distrust(database);
    return database;
  } catch (const SQLite::Exception& exception) {
    return Unexpected{archive_error(path.string(), exception)};
  }
}

Expected<SQLite::Database> open_for_reading(const std::filesystem::path& path) {
  if (const auto readable = refuse_unreadable(path); !readable) {
    return Unexpected{readable.error()};
  }
  try {
    SQLite::Database database{path.string(), SQLite::OPEN_READONLY, kBusyTimeout_ms};
    distrust(database);
    database.execAndGet("SELECT count(*) FROM sqlite_schema");  // Also reads the log.
    return database;
  } catch (const SQLite::Exception& exception) {
    // The index of the log is missing beside the archive and cannot be created.
    const int code = exception.getErrorCode();
    const bool cannot_index = code == SQLITE_CANTOPEN || code == SQLITE_READONLY;
    if (cannot_index && is_empty_or_absent(log_of(path))) {
      return open_at_rest(path);
    }
    if (cannot_index) {
      return Unexpected{
          {ErrorCode::Unavailable,
           fmt::format("archive {}: its newest rows stand in {}, which cannot be read in a folder "
                       "where no file may be made: copy both to another folder, and read there",
                       path.string(), log_of(path).string())}};
    }
    return Unexpected{archive_error(path.string(), exception)};
  }
}

std::filesystem::path log_of(const std::filesystem::path& archive) {
  return archive.string() + "-wal";
}

}  // namespace spindrift
