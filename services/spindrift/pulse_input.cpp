#include "services/spindrift/pulse_input.h"

#include <fmt/format.h>
#include <spdlog/spdlog.h>

#include <algorithm>
#include <cstddef>

#include "services/telemetry_files/telemetry_files.h"

namespace spindrift {
namespace {

constexpr std::size_t kRowsShown = 5;

}  // namespace

Expected<PulseTelemetry> load_pulses(std::span<const std::filesystem::path> paths,
                                     const std::string& spacecraft) {
  const auto files = scan_telemetry(paths);
  if (!files) {
    return Unexpected{files.error()};
  }
  for (const TelemetryFile& file : *files) {
    if (file.kind != TelemetryKind::Pulses) {
      spdlog::warn("{}: {} telemetry is left out: this version processes pulses",
                   file.path.string(), name_of(file.kind));
    }
  }
  auto telemetry = read_pulses(*files, spacecraft);
  if (telemetry && telemetry->samples.empty() && telemetry->rejected.empty()) {
    return Unexpected{{ErrorCode::InvalidConfiguration,
                       "no row of pulses in the telemetry: files with the header "
                       "'t_tai_ns,channel' and rows are needed"}};
  }
  return telemetry;
}

std::string bad_rows(const std::vector<RejectedInput>& rejected) {
  std::string text = fmt::format("{} bad rows of telemetry", rejected.size());
  for (std::size_t i = 0; i < std::min(rejected.size(), kRowsShown); ++i) {
    text += fmt::format("\n  {}:{}: {}", rejected[i].source, rejected[i].line, rejected[i].reason);
  }
  return rejected.size() > kRowsShown ? text + "\n  ..." : text;
}

}  // namespace spindrift
