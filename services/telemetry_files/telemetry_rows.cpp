#include "services/telemetry_files/telemetry_rows.h"

#include <fmt/format.h>

#include <limits>
#include <type_traits>
#include <utility>

#include "services/ingest/spacecraft_id.h"
#include "services/telemetry_files/parse_row.h"

namespace spindrift {
namespace {

// Of a file of 280 terabytes.
constexpr std::uint64_t kLineBits = (std::uint64_t{1} << 48U) - 1;
constexpr std::size_t kMostSpacecraft = std::numeric_limits<std::uint16_t>::max();

Unexpected refused(std::string reason) {
  return Unexpected{{ErrorCode::InvalidInput, std::move(reason)}};
}

template <class Value>
constexpr TelemetryKind kKindOf =
    std::is_same_v<Value, Pulse> ? TelemetryKind::Pulses : TelemetryKind::Coded;

}  // namespace

template <class Value>
Expected<TelemetryRows<Value>> TelemetryRows<Value>::open(const std::filesystem::path& path,
                                                          std::string spacecraft) {
  auto opened = open_telemetry(path);
  if (!opened) {
    return Unexpected{std::move(opened.error())};
  }
  const TelemetryLayout& layout = opened->layout;
  if (layout.kind != kKindOf<Value>) {
    return Unexpected{{ErrorCode::InvalidConfiguration,
                       fmt::format("{}: holds {} telemetry, must hold {}", path.string(),
                                   name_of(layout.kind), name_of(kKindOf<Value>))}};
  }
  return TelemetryRows{std::move(opened->lines), layout, path, std::move(spacecraft)};
}

template <class Value>
Expected<std::optional<typename TelemetryRows<Value>::Row>> TelemetryRows<Value>::next() {
  CsvLine line{};
  const auto more = lines_.next(line);
  if (!more) {
    return Unexpected{more.error()};
  }
  if (!*more) {
    return std::nullopt;
  }
  auto row = row_from(line);
  if (!row) {
    return RejectedInput{
        .source = path_.string(), .line = line.number, .reason = std::move(row.error().message)};
  }
  return *row;
}

template <class Value>
Expected<TelemetryRow<Value>> TelemetryRows<Value>::row_from(const CsvLine& line) {
  if (line.too_long) {
    return refused(fmt::format("row {}: too long for telemetry", quoted(line.text)));
  }
  CsvFields fields{line.text};
  if (fields.count() != layout_.columns) {
    return refused(fmt::format("row {}: has {} columns, must have {} as the header",
                               quoted(line.text), fields.count(), layout_.columns));
  }
  TelemetryRow<Value> row{
      .value = {}, .line = static_cast<std::uint64_t>(line.number) & kLineBits, .spacecraft = 0};
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
    return refused(fmt::format("spacecraft = {}: must be {}", quoted(field), kSpacecraftIdAllowed));
  }
  const auto known = spacecraft_places_.find(std::string{field});
  if (known != spacecraft_places_.end()) {
    last_spacecraft_ = known->second;
    return last_spacecraft_;
  }
  if (spacecraft_.size() > kMostSpacecraft) {
    return refused(fmt::format("spacecraft = {}: more than {} are named in this file",
                               quoted(field), kMostSpacecraft));
  }
  last_spacecraft_ = static_cast<std::uint16_t>(spacecraft_.size());
  spacecraft_places_.emplace(field, last_spacecraft_);
  spacecraft_.emplace_back(field);
  return last_spacecraft_;
}

template class TelemetryRows<Pulse>;
template class TelemetryRows<CodedFrame>;

}  // namespace spindrift
