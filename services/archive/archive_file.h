/// @file
/// The file that the connection of an archive has open, and whether its names still lead to it.

#pragma once

#include <sys/types.h>

#include <array>
#include <cstdint>
#include <filesystem>
#include <optional>
#include <utility>

#include "pipelines/core/expected.h"

namespace spindrift {

/// An open file outlives its name: what is deleted, moved away or replaced is still there for
/// SQLite, which stores on and notices nothing, and gone for everybody else.
///
/// SQLite opens the file later and closes it earlier than this: to close any descriptor of a file
/// drops the locks that SQLite has on it (https://www.sqlite.org/howtocorrupt.html section 2.2).
class ArchiveFile {
 public:
  /// Keeps others from writing it by another of its names, a hard link or a new one.
  /// @param path Where an empty file is made if there is none.
  /// @return Unavailable, naming the holder, when somebody writes it.
  static Expected<ArchiveFile> hold(const std::filesystem::path& path);

  ArchiveFile(ArchiveFile&& other) noexcept;
  ArchiveFile& operator=(ArchiveFile&&) = delete;
  ArchiveFile(const ArchiveFile&) = delete;
  ArchiveFile& operator=(const ArchiveFile&) = delete;
  ~ArchiveFile();

  /// Once SQLite has made the log and the log's index beside it.
  void note_log();

  /// @return Unavailable, saying what happened, when one of the names leads to nothing or to
  ///         something else.
  Expected<void> in_place() const;

  /// @param most_bytes More than which nobody has stored.
  /// @return Unavailable, now and ever after, when the file itself was truncated or overwritten.
  Expected<void> undamaged(std::int64_t most_bytes);

  /// One of its names where something else stands; not what a reader makes where the log or its
  /// index is missing.
  std::optional<std::filesystem::path> in_the_way() const;

  /// Removes what stands at the names of the log, if that is its own: it must not be taken for that
  /// of another file. For one of which there is a copy.
  void take_log_away() const;

  /// Gives its names, and its permissions, to `copy`. Of `in_the_way` there is none.
  /// @return Unavailable when something else has come to stand at the name.
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
  std::array<Name, 3> names_;  ///< The archive, its log, the log's index.
  std::int64_t seen_bytes_ = 0;
  std::optional<Error> damage_;
};

}  // namespace spindrift
