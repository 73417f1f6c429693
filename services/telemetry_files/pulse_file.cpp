#include "services/telemetry_files/pulse_file.h"

#include <fmt/format.h>

#include <algorithm>
#include <charconv>
#include <cstdint>
#include <system_error>
#include <utility>

#include "services/ingest/spacecraft_id.h"
#include "services/ingest/telemetry_time.h"

namespace spindrift {
namespace {

Unexpected refused(std::string reason) {
  return Unexpected{{ErrorCode::InvalidInput, std::move(reason)}};
}

Expected<TaiTime> time_from(std::string_view field) {
  std::int64_t t_tai_ns = 0;
  const char* const end = field.data() + field.size();
  const auto [stop, failure] = std::from_chars(field.data(), end, t_tai_ns);
  if (failure == std::errc::invalid_argument || stop != end) {
    return refused(fmt::format("t_tai_ns = {}: must be an integer", quoted(field)));
  }
  const TaiTime t = tai_from_ns(t_tai_ns);
  if (failure != std::errc{} || !is_telemetry_time(t)) {
    return refused(fmt::format("t_tai_ns = {}: must lie in the years 1972 to 2099, [{}, {}) ns",
                               quoted(field), tai_ns(kEarliestTelemetry),
                               tai_ns(kLatestTelemetry)));
  }
  return t;
}

Expected<PulseChannel> channel_from(std::string_view field) {
  const auto channel = pulse_channel_from(field);
  if (!channel) {
    return refused(fmt::format("channel = {}: must be one of {}", quoted(field),
                               fmt::join(kPulseChannelNames, ", ")));
  }
  return *channel;
}

}  // namespace

Expected<PulseFile> PulseFile::open(const std::filesystem::path& path, std::string spacecraft) {
  auto lines = CsvLines::open(path);
  if (!lines) {
    return Unexpected{std::move(lines.error())};
  }
  const auto layout = read_layout(*lines, path);
  if (!layout) {
    return Unexpected{layout.error()};
  }
  if (layout->kind != TelemetryKind::Pulses) {
    return Unexpected{{ErrorCode::InvalidConfiguration,
                       fmt::format("{}: holds {} telemetry, must hold {}", path.string(),
                                   name_of(layout->kind), name_of(TelemetryKind::Pulses))}};
  }
  return PulseFile{std::move(*lines), *layout, path, std::move(spacecraft)};
}

Expected<std::optional<PulseRow>> PulseFile::next() {
  CsvLine line{};
  const auto more = lines_.next(line);
  if (!more) {
    return Unexpected{more.error()};
  }
  if (!*more) {
    return std::nullopt;
  }
  auto sample = sample_from(line);
  if (!sample) {
    return RejectedInput{
        .source = path_.string(), .line = line.number, .reason = std::move(sample.error().message)};
  }
  return std::move(*sample);
}

Expected<PulseSample> PulseFile::sample_from(const CsvLine& line) const {
  if (line.too_long) {
    return refused(fmt::format("row {}: too long for telemetry", quoted(line.text)));
  }
  std::vector<std::string_view> fields = csv_fields(line.text);
  if (fields.size() != layout_.columns) {
    return refused(fmt::format("row {}: has {} columns, must have {} as the header",
                               quoted(line.text), fields.size(), layout_.columns));
  }
  std::string_view spacecraft = spacecraft_;
  if (layout_.spacecraft_column) {
    const auto column = fields.begin() + static_cast<std::ptrdiff_t>(*layout_.spacecraft_column);
    spacecraft = *column;
    fields.erase(column);
    if (!is_spacecraft_id(spacecraft)) {
      return refused(
          fmt::format("spacecraft = {}: must be {}", quoted(spacecraft), kSpacecraftIdAllowed));
    }
  }
  const auto t = time_from(fields[0]);
  if (!t) {
    return Unexpected{t.error()};
  }
  const auto channel = channel_from(fields[1]);
  if (!channel) {
    return Unexpected{channel.error()};
  }
  return PulseSample{.spacecraft = std::string{spacecraft},
                     .origin = {.source = path_.filename().string(),
                                .seq = static_cast<std::uint64_t>(line.number)},
                     .pulse = {.t = *t, .channel = *channel}};
}

Expected<PulseTelemetry> read_pulses(std::span<const TelemetryFile> files,
                                     const std::string& spacecraft) {
  PulseTelemetry all;
  for (const TelemetryFile& file : files) {
    if (file.kind != TelemetryKind::Pulses) {
      continue;
    }
    auto rows = PulseFile::open(file.path, spacecraft);
    if (!rows) {
      return Unexpected{std::move(rows.error())};
    }
    for (;;) {
      auto row = rows->next();
      if (!row) {
        return Unexpected{std::move(row.error())};
      }
      if (!*row) {
        break;
      }
      if (auto* const sample = std::get_if<PulseSample>(&**row)) {
        all.samples.push_back(std::move(*sample));
      } else {
        all.rejected.push_back(std::get<RejectedInput>(std::move(**row)));
      }
    }
  }
  std::stable_sort(all.samples.begin(), all.samples.end(),
                   [](const auto& a, const auto& b) { return a.pulse < b.pulse; });
  return all;
}

}  // namespace spindrift
