/// @file
/// Lines and fields of the plain CSV of telemetry: no quotes, no escapes.

#pragma once

#include <algorithm>
#include <array>
#include <cstddef>
#include <cstdint>
#include <filesystem>
#include <fstream>
#include <span>
#include <string>
#include <string_view>
#include <vector>

#include "pipelines/core/expected.h"

namespace spindrift {

/// The fields of a line, in its own memory: "a,,b" has three.
class CsvFields {
 public:
  explicit CsvFields(std::string_view line);

  /// All of the line.
  std::size_t count() const { return count_; }

  /// The first kMost of them at most; no telemetry has more columns.
  std::span<const std::string_view> fields() const {
    return {fields_.data(), std::min(count_, kMost)};
  }

  /// Takes one of `fields()` out; those behind it move up.
  std::string_view remove(std::size_t column);

  friend bool operator==(const CsvFields& a, const CsvFields& b) {
    return std::ranges::equal(a.fields(), b.fields()) && a.count_ == b.count_;
  }

 private:
  static constexpr std::size_t kMost = 8;

  std::array<std::string_view, kMost> fields_;
  std::size_t count_ = 0;
};

/// Text of unknown origin in quotes, for messages: shortened, other than printable ASCII as \xNN.
std::string quoted(std::string_view text);

struct CsvLine {
  std::int64_t number;    ///< From 1.
  std::string_view text;  ///< Without its end, CR LF or LF; good until the next line is read.
  bool too_long;          ///< Only the beginning of the line stands in `text`.
};

/// The lines of a file one by one, in constant memory. Empty lines and a byte order mark are
/// passed over; the last line needs no end.
class CsvLines {
 public:
  /// @return InvalidConfiguration with the path and the reason for what is not a regular file that
  ///         can be read.
  static Expected<CsvLines> open(const std::filesystem::path& path);

  /// False at the end of the file.
  /// @return Unavailable when reading fails on the way.
  Expected<bool> next(CsvLine& line);

  /// Of the file, from its beginning.
  std::uint64_t bytes_read() const { return bytes_read_; }

 private:
  static constexpr std::size_t kLongestLine = 1024;
  static constexpr std::size_t kReadAtOnce = std::size_t{256} * 1024;

  CsvLines(std::filesystem::path path, std::ifstream file)
      : path_{std::move(path)}, file_{std::move(file)} {}

  Expected<bool> next_raw(CsvLine& line);
  Expected<void> skip_rest_of_long_line();
  Expected<void> read_more();

  std::filesystem::path path_;
  std::ifstream file_;
  std::vector<char> buffer_;
  std::string_view rest_;  ///< Of the buffer: read and not yet given.
  bool ended_ = false;     ///< There is nothing behind `rest_`.
  bool in_long_line_ = false;
  std::int64_t number_ = 0;
  std::uint64_t bytes_read_ = 0;
};

}  // namespace spindrift
