/// @file
/// Checks that the names of an archive's files still lead to the files that SQLite has open.

#pragma once

#include <sys/types.h>

#include <array>
#include <cstdint>
#include <filesystem>
#include <functional>
#include <optional>
#include <utility>

#include "pipelines/core/expected.h"

namespace spindrift {

/// Holds the file of an archive. An open file outlives its name: after it is deleted, moved away or
/// replaced, SQLite keeps storing in it and notices nothing, while nobody else can reach it. SQLite
/// must open the file after this object does and close it before: closing any descriptor drops
/// SQLite's locks on the file (https://www.sqlite.org/howtocorrupt.html section 2.2).
class ArchiveFile {
 public:
  /// Locks the file itself, so that others cannot write it under another name.
  /// @param path An empty file is created there if there is none.
  /// @return Unavailable, naming the holder, when the file is locked.
  static Expected<ArchiveFile> hold(const std::filesystem::path& path);

  ArchiveFile(ArchiveFile&& other) noexcept;
  ArchiveFile& operator=(ArchiveFile&&) = delete;
  ArchiveFile(const ArchiveFile&) = delete;
  ArchiveFile& operator=(const ArchiveFile&) = delete;
  ~ArchiveFile();

  /// Notes the identity of the log and its index, once SQLite has created them.
  void note_log();

  /// @return Unavailable, with the reason, when a name leads to no file or to another file.
  Expected<void> in_place() const;

  /// Notes a size that the database has by SQLite, which the file reaches with a checkpoint: a
  /// larger one, or after VACUUM by another program a smaller one. To be called after each commit.
  void note_bytes(std::int64_t sqlite_bytes);

  /// @param sqlite_bytes Returns the size that the database has by SQLite.
  /// @return Unavailable, now and ever after, when the file itself was truncated or overwritten.
  Expected<void> undamaged(const std::function<std::int64_t()>& sqlite_bytes);

  /// Returns a name that another file occupies. An empty log or an index that a reader creates in
  /// place of a missing one does not count.
  std::optional<std::filesystem::path> in_the_way() const;

  /// Removes the log and its index if they are this archive's own, so that they are not taken for
  /// those of another file. To be called only when there is a copy.
  void take_log_away() const;

  /// Moves `copy` to the archive's name, if `in_the_way` is empty; keeps the permissions.
  /// @return Unavailable when another file has appeared at the name.
  Expected<void> give_way_to(const std::filesystem::path& copy) const;

 private:
  using Identity = std::pair<dev_t, ino_t>;
  struct Name {
    std::filesystem::path path;
    std::optional<Identity> file;
  };

  ArchiveFile(int file, const std::filesystem::path& path, const Identity& identity);

  static std::optional<Identity> identity_at(const std::filesystem::path& path);

  int file_;
  std::array<Name, 3> names_;     ///< The archive, its log and the log's index.
  std::int64_t least_bytes_ = 0;  ///< Since the file was seen last.
  std::int64_t most_bytes_ = 0;   ///< Since the file is held.
  std::optional<Error> damage_;
};

}  // namespace spindrift
