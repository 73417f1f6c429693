/// @file
/// The lines of a text file one by one.

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
  std::int64_t number;    ///< From 1.
  std::string_view text;  ///< Without its end, CR LF or LF; good until the next line is read.
  bool too_long;          ///< Only the beginning of the line stands in `text`.
};

/// In constant memory. Empty lines and a byte order mark are passed over; the last line needs no
/// end.
class FileLines {
 public:
  static constexpr std::size_t kLongestLine = 1024;

  explicit FileLines(InputFile file) : file_{std::move(file)} {}

  /// False at the end of the file.
  /// @return Unavailable when reading fails on the way.
  Expected<bool> next(FileLine& line);

  /// Of the file, from its beginning.
  std::uint64_t bytes_read() const { return bytes_read_; }

 private:
  static constexpr std::size_t kReadAtOnce = std::size_t{256} * 1024;

  Expected<bool> next_raw(FileLine& line);
  Expected<void> skip_rest_of_long_line();
  Expected<void> read_more();

  InputFile file_;
  std::vector<char> buffer_;
  std::string_view rest_;  ///< Of the buffer: read and not yet given.
  bool ended_ = false;     ///< There is nothing behind `rest_`.
  bool in_long_line_ = false;
  std::int64_t number_ = 0;
  std::uint64_t bytes_read_ = 0;
};

}  // namespace spindrift
