/// @file
/// Ties the write-ahead log to its archive, so that the log of another file is not taken for it.

#pragma once

#include <SQLiteCpp/Database.h>

#include <cstdint>
#include <filesystem>
#include <optional>

#include "pipelines/core/expected.h"

namespace spindrift {

/// SQLite carries over any sound log that stands at the name of a file's log, and mixes two
/// archives where a killed program's file was replaced. The header of a log has a salt, which is
/// random in a new log and rises by one whenever the log begins anew. The archive therefore stores
/// the salt of its log, and the one before: as long as that row is in the log only, the file still
/// has the one before.
class OwnLog {
 public:
  /// @return InvalidConfiguration, with advice, when a log stands beside the archive that is not
  /// its own. Both files are untouched.
  static Expected<void> refuse_other(const std::filesystem::path& archive);

  /// To be made before the first commit, in which `expect_new` must be called.
  explicit OwnLog(const std::filesystem::path& archive);

  /// Prepares for the salt of a new log, unless the log goes on. @throws SQLite::Exception
  void expect_new(SQLite::Database& database) const;

  /// Stores the salt of the log, if it has begun anew. To be called after each commit.
  /// @throws SQLite::Exception
  void note(SQLite::Database& database);

 private:
  std::filesystem::path log_;
  std::optional<std::uint32_t> seen_;  ///< Salt of the log when last looked at.
  bool is_noted_ = false;              ///< Whether the archive has it.
};

}  // namespace spindrift
