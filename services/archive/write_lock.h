/// @file
/// The right to write an archive: one holder at a time on this host, across processes.

#pragma once

#include <filesystem>

#include "pipelines/core/expected.h"

namespace spindrift {

/// A lock on the file ARCHIVE.lock, which names the holder for people. The kernel drops the lock
/// with its process, so the lock file of a killed process blocks nobody.
class WriteLock {
 public:
  /// @return Unavailable, naming the holder (pid, command, host, since), when there is one.
  static Expected<WriteLock> acquire(const std::filesystem::path& archive);

  WriteLock(WriteLock&& other) noexcept;
  WriteLock& operator=(WriteLock&&) = delete;
  WriteLock(const WriteLock&) = delete;
  WriteLock& operator=(const WriteLock&) = delete;
  ~WriteLock();

 private:
  explicit WriteLock(int file) : file_{file} {}
  int file_;
};

}  // namespace spindrift
