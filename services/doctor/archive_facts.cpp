#include <SQLiteCpp/Statement.h>
#include <fmt/format.h>
#include <sqlite3.h>
#include <sys/stat.h>

#include <fstream>
#include <iterator>
#include <system_error>

#include "pipelines/core/shown.h"
#include "services/archive/connection.h"
#include "services/doctor/archive.h"

namespace spindrift::doctor {
namespace {

// In larger archives reading all rows and comparing all indices takes too long.
constexpr std::uint64_t kLarge_bytes = 1ULL << 30U;

std::uint64_t size_of(const std::filesystem::path& path) {
  std::error_code absent;
  const std::uintmax_t size = std::filesystem::file_size(path, absent);
  return absent ? 0 : size;
}

/// Reads the kernel's list of locks, because trying the lock could block a service that starts at
/// this moment.
bool is_locked(const std::filesystem::path& path) {
  struct stat status {};
  if (stat(path.c_str(), &status) != 0) {
    return false;
  }
  const std::string inode = fmt::format(":{} ", status.st_ino);
  std::ifstream locks{"/proc/locks"};
  for (std::string line; std::getline(locks, line);) {
    if (line.find("FLOCK") != std::string::npos && line.find(inode) != std::string::npos) {
      return true;
    }
  }
  return false;
}

std::optional<std::string> writer_of(const std::filesystem::path& archive) {
  const std::filesystem::path lock = archive.string() + ".lock";
  if (!is_locked(lock)) {
    return std::nullopt;
  }
  std::ifstream file{lock, std::ios::binary};
  return shown(std::string{std::istreambuf_iterator<char>{file}, {}});
}

/// Returns empty when SQLite finds no damage.
std::vector<std::string> damages_of(SQLite::Database& database, bool everything) {
  SQLite::Statement check{database,
                          everything ? "PRAGMA integrity_check(10)" : "PRAGMA quick_check(10)"};
  std::vector<std::string> damages;
  try {
    while (check.executeStep()) {
      damages.push_back(check.getColumn(0).getString());
    }
  } catch (const SQLite::Exception& exception) {
    // The check stops at an unreadable page, which is a finding too.
    if (exception.getErrorCode() != SQLITE_CORRUPT) {
      throw;
    }
    damages.emplace_back(exception.what());
  }
  return damages == std::vector<std::string>{"ok"} ? std::vector<std::string>{} : damages;
}

/// @throws SQLite::Exception
ArchiveContent read_content(SQLite::Database& database, bool everything) {
  const auto number = [&](const char* query) { return database.execAndGet(query).getInt64(); };
  ArchiveContent content{.damages = damages_of(database, everything),
                         .looked_at_everything = everything};
  // Queries of a damaged database would fail.
  if (content.damages.empty()) {
    content.orphans = number("SELECT count(*) FROM pragma_foreign_key_check");
    content.unfinished_runs = number("SELECT count(*) FROM run WHERE finished_utc IS NULL");
    content.tai_minus_utc_s =
        static_cast<int>(number("SELECT coalesce(max(tai_minus_utc_s), 0) FROM leap_second"));
  }
  return content;
}

Expected<ArchiveContent> content_of(const std::filesystem::path& path, bool everything) {
  const bool at_rest = !std::filesystem::exists(log_of(path));
  auto database = at_rest ? open_at_rest(path) : open_for_reading(path);
  if (!database) {
    return Unexpected{database.error()};
  }
  Expected<ArchiveContent> content;
  try {
    content = read_content(*database, everything);
  } catch (const SQLite::Exception& exception) {
    content = Unexpected{archive_error(path.string(), exception)};
  }
  // A writer has started meanwhile, so the data may be inconsistent.
  return at_rest && std::filesystem::exists(log_of(path)) ? content_of(path, everything) : content;
}

}  // namespace

ArchiveFacts archive_facts(const std::filesystem::path& path) {
  ArchiveFacts facts{.path = path.string(),
                     .exists = size_of(path) > 0,
                     .bytes = size_of(path),
                     .wal_bytes = size_of(log_of(path)),
                     .writer = writer_of(path),
                     .content = ArchiveContent{}};
  if (const auto named = refuse_no_file(path); !named) {
    facts.content = Unexpected{named.error()};
  } else if (facts.exists) {
    facts.content = content_of(path, facts.bytes + facts.wal_bytes < kLarge_bytes);
  }
  return facts;
}

}  // namespace spindrift::doctor
