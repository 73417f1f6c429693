/// @file
/// The file of an archive, open for writing, with everything that uses the connection.

#pragma once

#include <SQLiteCpp/Database.h>
#include <SQLiteCpp/Statement.h>

#include <filesystem>
#include <memory>
#include <span>

#include "pipelines/core/expected.h"
#include "services/archive/archive_file.h"
#include "services/archive/batch_writer.h"
#include "services/archive/checkpointer.h"
#include "services/archive/own_log.h"
#include "services/archive/records.h"

namespace spindrift {

/// Owns the connection that writes an archive; used by the writer thread only.
class Store {
 public:
  /// @return Errors as ArchiveFile::hold and open_for_writing.
  static Expected<std::unique_ptr<Store>> open(const std::filesystem::path& path);

  /// @return Errors as BatchWriter::write.
  Expected<void> write(std::span<const ArchiveBatch> batches);

  /// Returns the length of the write-ahead log after the last commit.
  double log_mib() const;

  const ArchiveFile& file() const { return file_; }

  /// Checks as ArchiveFile::undamaged. A damaged file is not written, not even on closing.
  Expected<void> undamaged();

  /// Copies all that is committed into a new file beside the archive, even if the archive's name is
  /// gone. After that, closing leaves the log alone. @return Path of the copy.
  Expected<std::filesystem::path> copy();

 private:
  /// @throws SQLite::Exception
  Store(ArchiveFile file, SQLite::Database database, OwnLog log);
  std::int64_t bytes();
  void leave_alone_when_closed();

  // The order matters: members are destroyed from the last to the first.
  ArchiveFile file_;
  SQLite::Database database_;
  OwnLog log_;
  Checkpointer checkpointer_;
  BatchWriter writer_;
  SQLite::Statement bytes_;
};

}  // namespace spindrift
