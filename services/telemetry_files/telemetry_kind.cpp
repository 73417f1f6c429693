#include "services/telemetry_files/telemetry_kind.h"

#include <fmt/format.h>

#include <algorithm>
#include <array>
#include <string>
#include <string_view>
#include <utility>
#include <vector>

namespace spindrift {
namespace {

struct KindHeader {
  std::string_view name;
  std::string_view header;
};

/// By value of TelemetryKind.
constexpr std::array<KindHeader, 6> kKinds = {
    {{"pulses", "t_tai_ns,channel"},
     {"coded", "t_tai_ns,period_s,sun2_s,north_in_s,north_out_s,south_in_s,south_out_s"},
     {"gyro", "t_tai_ns,wx_rad_s,wy_rad_s,wz_rad_s"},
     {"star", "t_tai_ns,qx,qy,qz,qw"},
     {"sun", "t_tai_ns,sx,sy,sz"},
     {"magnetometer", "t_tai_ns,bx_nt,by_nt,bz_nt"}}};

std::string all_headers() {
  std::string all;
  for (const KindHeader& kind : kKinds) {
    all += fmt::format("{}\"{}\" ({})", all.empty() ? "" : ", ", kind.header, kind.name);
  }
  return all;
}

Expected<TelemetryLayout> read_layout(CsvLines& lines, const std::filesystem::path& path) {
  CsvLine header{};
  const auto there = lines.next(header);
  if (!there) {
    return Unexpected{there.error()};
  }
  if (!*there) {
    return Unexpected{{ErrorCode::InvalidConfiguration,
                       fmt::format("{}: is empty: must begin with a header line, one of {}",
                                   path.string(), all_headers())}};
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
  const auto* const kind = std::find_if(kKinds.begin(), kKinds.end(), [&](const KindHeader& known) {
    return CsvFields{known.header} == columns;
  });
  if (kind == kKinds.end()) {
    return Unexpected{
        {ErrorCode::InvalidConfiguration,
         fmt::format("{}:{}: header {}: must be one of {}; a column spacecraft may be added",
                     path.string(), header.number, quoted(header.text), all_headers())}};
  }
  return TelemetryLayout{.kind = static_cast<TelemetryKind>(kind - kKinds.begin()),
                         .columns = count,
                         .spacecraft_column = spacecraft_column};
}

}  // namespace

std::string_view name_of(TelemetryKind kind) {
  return kKinds.at(static_cast<std::size_t>(kind)).name;
}

Expected<OpenTelemetry> open_telemetry(const std::filesystem::path& path) {
  auto lines = CsvLines::open(path);
  if (!lines) {
    return Unexpected{std::move(lines.error())};
  }
  return read_layout(*lines, path).map([&](const TelemetryLayout& layout) {
    return OpenTelemetry{.lines = std::move(*lines), .layout = layout};
  });
}

}  // namespace spindrift
