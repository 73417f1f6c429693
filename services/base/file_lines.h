/// @file
/// Reads a text file line by line.

#pragma once

#include <cstddef>
#include <cstdint>
#include <string_view>
#include <utility>
#include <vector>

#include "pipelines/core/expected.h"
#include "services/base/input_file.h"

namespace spindrift {

struct FileLine {
  std::int64_t number;    ///< Counted from 1.
  std::string_view text;  ///< Without CR LF or LF; valid until the next line is read.
  bool too_long;          ///< `text` has only the beginning of the line.
};

/// Uses constant memory. It skips empty lines and a byte order mark; the last line may lack a line
/// end.
class FileLines {
 public:
  static constexpr std::size_t kLongestLine = 1024;

  explicit FileLines(InputFile file) : file_{std::move(file)} {}

  /// Returns false at the end of the file.
  /// @return Unavailable when reading fails on the way.
  Expected<bool> next(FileLine& line);

  /// Counts from the beginning of the file.
  std::uint64_t bytes_read() const { return bytes_read_; }

 private:
  static constexpr std::size_t kReadAtOnce = std::size_t{256} * 1024;

  Expected<bool> next_raw(FileLine& line);
  Expected<void> skip_rest_of_long_line();
  Expected<void> read_more();

  InputFile file_;
  std::vector<char> buffer_;
  std::string_view rest_;  ///< Part of the buffer not yet returned.
  bool ended_ = false;     ///< The file has nothing after `rest_`.
  bool in_long_line_ = false;
  std::int64_t number_ = 0;
  std::uint64_t bytes_read_ = 0;
};

}  // namespace spindrift
