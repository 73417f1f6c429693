#include "services/archive/store.h"

#include <SQLiteCpp/Backup.h>
#include <SQLiteCpp/Exception.h>
#include <fmt/chrono.h>
#include <fmt/format.h>
#include <sqlite3.h>

#include <chrono>
#include <string>
#include <system_error>
#include <utility>

#include "services/archive/connection.h"
#include "services/base/contained.h"

namespace spindrift {

Expected<std::unique_ptr<Store>> Store::open(const std::filesystem::path& path) {
  auto file = ArchiveFile::hold(path);
  if (!file) {
    return Unexpected{file.error()};
  }
  if (auto own = OwnLog::refuse_other(path); !own) {
    return Unexpected{own.error()};
  }
  OwnLog log{path};
  auto database = open_for_writing(path, log);
  if (!database) {
    return Unexpected{database.error()};
  }
  try {
    return std::unique_ptr<Store>{
        new Store{std::move(*file), std::move(*database), std::move(log)}};
  } catch (const SQLite::Exception& exception) {
    return Unexpected{archive_error(path.string(), exception)};
  }
}

Store::Store(ArchiveFile file, SQLite::Database database, OwnLog log)
    : file_{std::move(file)},
      database_{std::move(database)},
      log_{std::move(log)},
      checkpointer_{database_},
      writer_{database_},
      bytes_{database_, "SELECT page_count * page_size FROM pragma_page_count, pragma_page_size"} {
  file_.note_log();
}

Expected<void> Store::write(std::span<const ArchiveBatch> batches) {
  return writer_.write(batches).map([this] {
    // What cannot be noted now is noted with the next commit.
    static_cast<void>(contained("noting the log", [this] {
      file_.note_bytes(bytes());
      log_.note(database_);
    }));
  });
}

std::int64_t Store::bytes() {
  bytes_.tryReset();
  bytes_.executeStep();
  const std::int64_t bytes = bytes_.getColumn(0).getInt64();
  bytes_.reset();
  return bytes;
}

double Store::log_mib() const {
  constexpr double kFramesPerMib = 256.0;
  return checkpointer_.log_frames() / kFramesPerMib;
}

Expected<void> Store::undamaged() {
  try {
    auto whole = file_.undamaged([this] { return bytes(); });
    if (!whole) {
      leave_alone_when_closed();
    }
    return whole;
  } catch (const SQLite::Exception& exception) {
    bytes_.tryReset();
    return Unexpected{archive_error(database_.getFilename(), exception)};
  }
}

Expected<std::filesystem::path> Store::copy() {
  std::filesystem::path copy = fmt::format("{}.rescued-{:%Y%m%dT%H%M%SZ}", database_.getFilename(),
                                           fmt::gmtime(std::chrono::system_clock::now()));
  std::error_code not_there;
  if (std::filesystem::exists(copy, not_there)) {
    return Unexpected{
        {ErrorCode::Unavailable, fmt::format("archive {}: {} stands in the way of a copy",
                                             database_.getFilename(), copy.string())}};
  }
  try {
    SQLite::Database made{copy.string(), SQLite::OPEN_READWRITE | SQLite::OPEN_CREATE};
    SQLite::Backup{made, database_}.executeStep();
    leave_alone_when_closed();
    return copy;
  } catch (const SQLite::Exception& exception) {
    std::filesystem::remove(copy, not_there);
    return Unexpected{archive_error(copy.string(), exception)};
  }
}

// On closing SQLite would otherwise carry the log over and remove the file at the log's name.
void Store::leave_alone_when_closed() {
  sqlite3_db_config(database_.getHandle(), SQLITE_DBCONFIG_NO_CKPT_ON_CLOSE, 1, nullptr);
}

}  // namespace spindrift
