/// @file
/// Lines and fields of the plain CSV of telemetry: no quotes, no escapes.

#pragma once

#include <array>
#include <cstdint>
#include <filesystem>
#include <fstream>
#include <string>
#include <string_view>
#include <vector>

#include "pipelines/core/expected.h"

namespace spindrift {

/// "a,,b" has three fields.
std::vector<std::string_view> csv_fields(std::string_view line);

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
  /// can
  ///         be read.
  static Expected<CsvLines> open(const std::filesystem::path& path);

  /// False at the end of the file.
  /// @return Unavailable when reading fails on the way.
  Expected<bool> next(CsvLine& line);

 private:
  static constexpr std::size_t kLongestLine = 1024;

  CsvLines(std::filesystem::path path, std::ifstream file)
      : path_{std::move(path)}, file_{std::move(file)} {}

  std::filesystem::path path_;
  std::ifstream file_;
  std::array<char, kLongestLine + 1> buffer_{};
  std::int64_t number_ = 0;
};

}  // namespace spindrift
