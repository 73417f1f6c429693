/// @file
/// The rows of one telemetry file: values in little memory, and rows that are none with the reason.

#pragma once

#include <cstdint>
#include <filesystem>
#include <optional>
#include <string>
#include <string_view>
#include <unordered_map>
#include <variant>
#include <vector>

#include "pipelines/core/expected.h"
#include "pipelines/spin/types/coded_frame.h"
#include "pipelines/spin/types/pulse.h"
#include "services/ingest/rejected_input.h"
#include "services/telemetry_files/csv.h"
#include "services/telemetry_files/telemetry_kind.h"

namespace spindrift {

/// What many of are held while they are sorted. `Value`: Pulse or CodedFrame.
template <class Value>
struct TelemetryRow {
  Value value;
  std::uint64_t line : 48;
  std::uint64_t spacecraft : 16;  ///< Which of the names of its file.
};

/// One file, row by row in the order of its lines, in constant memory.
template <class Value>
class TelemetryRows {
 public:
  using Row = std::variant<TelemetryRow<Value>, RejectedInput>;

  /// @param spacecraft  Of the rows, where the file does not say.
  /// @return InvalidConfiguration for what is not a readable telemetry file of this kind.
  static Expected<TelemetryRows> open(const std::filesystem::path& path, std::string spacecraft);

  /// Empty at the end of the file. A rejected row has the path as it was given.
  /// @return Unavailable when reading fails on the way.
  Expected<std::optional<Row>> next();

  const std::filesystem::path& path() const { return path_; }
  const std::string& spacecraft_of(const TelemetryRow<Value>& row) const {
    return spacecraft_[row.spacecraft];
  }
  std::uint64_t bytes_read() const { return lines_.bytes_read(); }

 private:
  TelemetryRows(CsvLines lines, TelemetryLayout layout, std::filesystem::path path,
                std::string spacecraft)
      : lines_{std::move(lines)},
        layout_{layout},
        path_{std::move(path)},
        spacecraft_{std::move(spacecraft)} {}

  Expected<TelemetryRow<Value>> row_from(const CsvLine& line);
  Expected<std::uint16_t> spacecraft_from(std::string_view field);

  CsvLines lines_;
  TelemetryLayout layout_;
  std::filesystem::path path_;
  std::vector<std::string> spacecraft_;  ///< The first: of the rows, where the file does not say.
  std::unordered_map<std::string, std::uint16_t> spacecraft_places_;
  std::uint16_t last_spacecraft_ = 0;
};

extern template class TelemetryRows<Pulse>;
extern template class TelemetryRows<CodedFrame>;

}  // namespace spindrift
