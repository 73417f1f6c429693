/// @file
/// An archive's file, open for writing, and all that hangs on the connection.

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
#include "services/archive/records.h"

namespace spindrift {

/// Of the writer thread.
class Store {
 public:
  /// @return as ArchiveFile::hold and open_for_writing.
  static Expected<std::unique_ptr<Store>> open(const std::filesystem::path& path);

  /// @return as BatchWriter::write.
  Expected<void> write(std::span<const ArchiveBatch> batches) { return writer_.write(batches); }

  const ArchiveFile& file() const { return file_; }

  /// As ArchiveFile::undamaged. What is damaged is not written any more, nor when it is closed.
  Expected<void> undamaged();

  /// All that is committed as a new file beside the archive, whatever has become of its names. What
  /// has a copy is left alone when it is closed.
  /// @return where it is.
  Expected<std::filesystem::path> copy();

 private:
  /// @throws SQLite::Exception
  Store(ArchiveFile file, SQLite::Database database);
  void leave_alone_when_closed();

  // Destroyed from the last to the first.
  ArchiveFile file_;
  SQLite::Database database_;
  Checkpointer checkpointer_;
  BatchWriter writer_;
  SQLite::Statement bytes_;
};

}  // namespace spindrift
