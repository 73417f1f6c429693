/// @file
/// A connection to the archive for repeated reading.

#pragma once

#include <SQLiteCpp/Database.h>
#include <SQLiteCpp/Exception.h>
#include <sys/types.h>

#include <filesystem>
#include <optional>
#include <type_traits>
#include <utility>

#include "pipelines/core/expected.h"
#include "services/archive/connection.h"

namespace spindrift {

/// Keeps a connection open; reopens it when another file is at the path. For one thread.
class KeptConnection {
 public:
  explicit KeptConnection(std::filesystem::path archive) : path_{std::move(archive)} {}

  /// Returns the result of `read`; parameters and errors as read_archive.
  template <class Read>
  auto read(const Read& read) -> Expected<std::invoke_result_t<Read, SQLite::Database&>> {
    if (const auto open = follow(); !open) {
      return Unexpected{open.error()};
    }
    try {
      return read(*database_);
    } catch (const SQLite::Exception& exception) {
      database_.reset();
      return Unexpected{archive_error(path_.string(), exception)};
    }
  }

 private:
  using Identity = std::pair<dev_t, ino_t>;
  Expected<void> follow();

  std::filesystem::path path_;
  Identity file_ = {};
  std::optional<SQLite::Database> database_;
};

}  // namespace spindrift
