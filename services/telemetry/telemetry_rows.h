/// @file
/// Reads the rows of one telemetry file, and the bad ones with the reason.

#pragma once

#include <fmt/format.h>

#include <cstddef>
#include <cstdint>
#include <filesystem>
#include <limits>
#include <optional>
#include <string>
#include <string_view>
#include <unordered_map>
#include <utility>
#include <variant>
#include <vector>

#include "pipelines/core/expected.h"
#include "pipelines/core/shown.h"
#include "services/telemetry/csv.h"
#include "services/telemetry/likely_cause.h"
#include "services/telemetry/parse_row.h"
#include "services/telemetry/rejected_input.h"
#include "services/telemetry/spacecraft_id.h"
#include "services/telemetry/telemetry_layout.h"

namespace spindrift {

// Only a file of 280 terabytes has so many lines.
inline constexpr std::uint64_t kRowLineBits = (std::uint64_t{1} << 48U) - 1;
inline constexpr std::size_t kMostSpacecraftInFile = std::numeric_limits<std::uint16_t>::max();

inline Unexpected refused_row(std::string reason) {
  return Unexpected{{ErrorCode::InvalidInput, std::move(reason)}};
}

/// Compact, since many rows are held for sorting. `Value` is a kind of telemetry.
template <class Value>
struct TelemetryRow {
  Value value;
  std::uint64_t line : 48;
  std::uint64_t spacecraft : 16;  ///< Index among the names in its file.
};

/// Reads one file row by row in the order of its lines, in constant memory.
template <class Value>
class TelemetryRows {
 public:
  using Row = std::variant<TelemetryRow<Value>, RejectedInput>;

  /// @param spacecraft  Spacecraft of the rows, where the file does not say.
  /// @return InvalidConfiguration for what is not a readable telemetry file of this kind.
  static Expected<TelemetryRows> open(const std::filesystem::path& path, std::string spacecraft);

  /// Returns empty at the end of the file. A rejected row has the path as it was given.
  /// @return Unavailable when reading fails on the way.
  Expected<std::optional<Row>> next();

  const std::filesystem::path& path() const { return path_; }
  const std::string& spacecraft_of(const TelemetryRow<Value>& row) const {
    return spacecraft_[row.spacecraft];
  }
  std::uint64_t bytes_read() const { return lines_.bytes_read(); }

 private:
  TelemetryRows(FileLines lines, TelemetryLayout layout, std::filesystem::path path,
                std::string spacecraft)
      : lines_{std::move(lines)},
        layout_{layout},
        path_{std::move(path)},
        spacecraft_{std::move(spacecraft)} {}

  Expected<TelemetryRow<Value>> row_from(const FileLine& line);
  Expected<std::uint16_t> spacecraft_from(std::string_view field);

  FileLines lines_;
  TelemetryLayout layout_;
  std::filesystem::path path_;
  std::vector<std::string> spacecraft_;  ///< The first is for rows without a name.
  std::unordered_map<std::string, std::uint16_t> spacecraft_places_;
  std::uint16_t last_spacecraft_ = 0;
};

template <class Value>
Expected<TelemetryRows<Value>> TelemetryRows<Value>::open(const std::filesystem::path& path,
                                                          std::string spacecraft) {
  auto opened = open_telemetry(path);
  if (!opened) {
    return Unexpected{std::move(opened.error())};
  }
  const TelemetryLayout& layout = opened->layout;
  if (layout.kind != TelemetryKind{Kind<Value>{}}) {
    return Unexpected{{ErrorCode::InvalidConfiguration,
                       fmt::format("{}: holds {} telemetry, must hold {}", shown(path.string()),
                                   name_of(layout.kind), Telemetry<Value>::kName)}};
  }
  return TelemetryRows{std::move(opened->lines), layout, path, std::move(spacecraft)};
}

template <class Value>
Expected<std::optional<typename TelemetryRows<Value>::Row>> TelemetryRows<Value>::next() {
  FileLine line{};
  const auto more = lines_.next(line);
  if (!more) {
    return Unexpected{more.error()};
  }
  if (!*more) {
    return std::nullopt;
  }
  auto row = row_from(line);
  if (!row) {
    return RejectedInput{.source = shown(path_.string()),
                         .line = line.number,
                         .reason = std::move(row.error().message)};
  }
  return *row;
}

template <class Value>
Expected<TelemetryRow<Value>> TelemetryRows<Value>::row_from(const FileLine& line) {
  if (line.too_long) {
    return refused_row(fmt::format("row {}: too long for telemetry", quoted(line.text)));
  }
  CsvFields fields{line.text};
  if (fields.count() != layout_.columns) {
    return refused_row(fmt::format("row {}: has {} columns, must have {} as the header{}",
                                   quoted(line.text), fields.count(), layout_.columns,
                                   likely_separator(line.text, layout_.columns)));
  }
  TelemetryRow<Value> row{
      .value = {}, .line = static_cast<std::uint64_t>(line.number) & kRowLineBits, .spacecraft = 0};
  if (layout_.spacecraft_column) {
    const auto spacecraft = spacecraft_from(fields.remove(*layout_.spacecraft_column));
    if (!spacecraft) {
      return Unexpected{spacecraft.error()};
    }
    row.spacecraft = *spacecraft;
  }
  return parse_row(fields.fields(), row.value).map([&row] { return row; });
}

template <class Value>
Expected<std::uint16_t> TelemetryRows<Value>::spacecraft_from(std::string_view field) {
  if (field == spacecraft_[last_spacecraft_]) {
    return last_spacecraft_;
  }
  if (!is_spacecraft_id(field)) {
    return refused_row(
        fmt::format("spacecraft = {}: must be {}", quoted(field), kSpacecraftIdAllowed));
  }
  const auto known = spacecraft_places_.find(std::string{field});
  if (known != spacecraft_places_.end()) {
    last_spacecraft_ = known->second;
    return last_spacecraft_;
  }
  if (spacecraft_.size() > kMostSpacecraftInFile) {
    return refused_row(fmt::format("spacecraft = {}: more than {} are named in this file",
                                   quoted(field), kMostSpacecraftInFile));
  }
  last_spacecraft_ = static_cast<std::uint16_t>(spacecraft_.size());
  spacecraft_places_.emplace(field, last_spacecraft_);
  spacecraft_.emplace_back(field);
  return last_spacecraft_;
}

}  // namespace spindrift
