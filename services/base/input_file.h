/// @file
/// An input file given by the user.
///
/// Only regular files are accepted: a device has no end, opening a pipe may block for ever, and
/// files of /proc and /sys report no size.

#pragma once

#include <cstddef>
#include <cstdint>
#include <cstdio>
#include <filesystem>
#include <limits>
#include <memory>
#include <span>
#include <string>
#include <utility>

#include "pipelines/core/expected.h"

namespace spindrift {

/// Size limit for text files, far more than anybody writes by hand.
inline constexpr std::uint64_t kMostTextBytes = std::uint64_t{64} << 20U;

class InputFile {
 public:
  /// @return InvalidConfiguration with path and reason for what is not a regular file that can be
  ///         read, or is larger than `most_bytes`.
  static Expected<InputFile> open(
      const std::filesystem::path& path,
      std::uint64_t most_bytes = std::numeric_limits<std::uint64_t>::max());

  /// Size in bytes at opening.
  std::uint64_t size() const { return size_; }

  /// Fills `buffer` unless the file ends. @return The number of bytes read; Unavailable when
  /// reading fails.
  Expected<std::size_t> read(std::span<char> buffer);

  /// Returns to the beginning of the file. @return Unavailable when that fails.
  Expected<void> rewind();

 private:
  struct Close {
    void operator()(std::FILE* file) const { static_cast<void>(std::fclose(file)); }
  };

  InputFile(std::filesystem::path path, std::FILE* file, std::uint64_t size)
      : path_{std::move(path)}, file_{file}, size_{size} {}

  Unexpected failed() const;

  std::filesystem::path path_;
  std::unique_ptr<std::FILE, Close> file_;
  std::uint64_t size_;
};

/// Reads a whole file. @return The errors of InputFile.
Expected<std::string> read_text_file(const std::filesystem::path& path,
                                     std::uint64_t most_bytes = kMostTextBytes);

}  // namespace spindrift
