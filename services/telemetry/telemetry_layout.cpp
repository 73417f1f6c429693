#include "services/telemetry/telemetry_layout.h"

#include <fmt/format.h>

#include <algorithm>
#include <string>
#include <string_view>
#include <utility>

#include "pipelines/core/shown.h"
#include "services/telemetry/likely_cause.h"

namespace spindrift {
namespace {

std::string all_headers() {
  std::string all;
  TelemetryKinds::for_each([&all]<class Value>(Kind<Value> /*kind*/) {
    all += fmt::format("{}\"{}\" ({})", all.empty() ? "" : ", ", header_of<Value>(),
                       Telemetry<Value>::kName);
  });
  return all;
}

/// Returns empty when no kind has these columns.
std::optional<TelemetryKind> kind_of(const CsvFields& columns) {
  std::optional<TelemetryKind> found;
  TelemetryKinds::for_each([&]<class Value>(Kind<Value> kind) {
    if (CsvFields{header_of<Value>()} == columns) {
      found = kind;
    }
  });
  return found;
}

Expected<TelemetryLayout> read_layout(FileLines& lines, const std::filesystem::path& path) {
  FileLine header{};
  const auto there = lines.next(header);
  if (!there) {
    return Unexpected{there.error()};
  }
  if (!*there) {
    return Unexpected{{ErrorCode::InvalidConfiguration,
                       fmt::format("{}: is empty: must begin with a header line, one of {}",
                                   shown(path.string()), all_headers())}};
  }
  CsvFields columns{header.text};
  const std::size_t count = columns.count();
  std::optional<std::size_t> spacecraft_column;
  const auto names = columns.fields();
  if (const auto found = std::find(names.begin(), names.end(), "spacecraft");
      found != names.end()) {
    spacecraft_column = static_cast<std::size_t>(found - names.begin());
    columns.remove(*spacecraft_column);
  }
  const auto kind = kind_of(columns);
  if (!kind) {
    return Unexpected{
        {ErrorCode::InvalidConfiguration,
         fmt::format("{}:{}: header {}: must be one of {}; a column spacecraft may be added{}",
                     shown(path.string()), header.number, quoted(header.text), all_headers(),
                     likely_separator(header.text, count))}};
  }
  return TelemetryLayout{.kind = *kind, .columns = count, .spacecraft_column = spacecraft_column};
}

}  // namespace

Expected<OpenTelemetry> open_telemetry(const std::filesystem::path& path) {
  auto file = InputFile::open(path);
  if (!file) {
    return Unexpected{std::move(file.error())};
  }
  FileLines lines{std::move(*file)};
  return read_layout(lines, path).map([&](const TelemetryLayout& layout) {
    return OpenTelemetry{.lines = std::move(lines), .layout = layout};
  });
}

}  // namespace spindrift
