#include "services/simulation/pass_files.h"

#include <fmt/format.h>

#include <algorithm>
#include <chrono>
#include <iterator>
#include <string>
#include <string_view>
#include <system_error>
#include <utility>
#include <variant>

#include "pipelines/core/shown.h"
#include "pipelines/ephemeris/oem_writer.h"
#include "services/base/input_file.h"
#include "services/mission/mission_orbit.h"
#include "services/simulation/output_file.h"
#include "services/telemetry/telemetry_layout.h"
#include "services/telemetry/telemetry_row.h"

namespace spindrift {
namespace {

constexpr std::chrono::seconds kOrbitStep{60};
constexpr std::chrono::minutes kOrbitBefore{10};
// The program warns of an orbit that ends within a day after the pass.
constexpr std::chrono::hours kOrbitBehind{36};
constexpr std::size_t kBlock = 1U << 20U;

/// Copies in blocks, as an orbit file may be too large for memory.
Expected<void> copy_orbit(const std::filesystem::path& from, const std::filesystem::path& to) {
  auto source = InputFile::open(from, kMostOrbitBytes);
  auto file = source ? OutputFile::create(to) : Unexpected{std::move(source.error())};
  if (!file) {
    return Unexpected{std::move(file.error())};
  }
  std::string block(kBlock, '\0');
  for (;;) {
    const auto size = source->read(block);
    if (!size) {
      return Unexpected{size.error()};
    }
    if (*size == 0) {
      return file->commit();
    }
    if (auto written = file->write(std::string_view{block}.substr(0, *size)); !written) {
      return written;
    }
  }
}

Expected<void> write_orbit(const std::filesystem::path& path, const Scenario& scenario) {
  if (scenario.oem) {
    return copy_orbit(*scenario.oem, path);
  }
  const TaiTime end = shifted(scenario.start, scenario.duration_s);
  TaiTime from = scenario.start - kOrbitBefore;
  TaiTime to = end + kOrbitBehind;
  if (const OrbitEphemeris* const ephemeris = scenario.orbit.ephemeris()) {
    // The written orbit stays within the segments in which the pass begins and ends.
    for (const OemSegment& segment : ephemeris->segments()) {
      const auto holds = [&](TaiTime t) {
        return segment.usable_from <= t && t <= segment.usable_to;
      };
      from = holds(scenario.start) ? std::max(from, segment.usable_from) : from;
      to = holds(end) ? std::min(to, segment.usable_to) : to;
    }
  }
  return sampled_orbit(scenario.orbit, from, to, kOrbitStep)
      .and_then([&](const std::vector<EphemerisPoint>& points) {
        return write_file(path, oem_text(scenario.spacecraft_id, scenario.start, points));
      });
}

/// Writes the rows in blocks: a long pass is larger as text than as values.
template <class Value>
Expected<void> write_rows(const std::filesystem::path& path, const PlacedOfKind<Value>& rows) {
  auto file = OutputFile::create(path);
  if (!file) {
    return Unexpected{std::move(file.error())};
  }
  std::string text = header_of<Value>() + '\n';
  for (const Placed<Value>& row : rows) {
    append_row(row.value, text);
    if (text.size() >= kBlock) {
      if (auto written = file->write(text); !written) {
        return written;
      }
      text.clear();
    }
  }
  return file->write(text).and_then([&] { return file->commit(); });
}

std::filesystem::path path_in(const std::filesystem::path& folder, const TelemetryKind& kind) {
  std::string name{name_of(kind)};
  std::replace(name.begin(), name.end(), ' ', '_');
  return folder / (name + ".csv");
}

/// Makes the folder; refuses one that holds telemetry not of this pass.
Expected<void> prepare(const std::filesystem::path& folder,
                       const std::vector<std::filesystem::path>& telemetry) {
  std::error_code failure;
  std::filesystem::create_directories(folder, failure);
  const std::filesystem::directory_iterator entries{folder, failure};
  if (failure) {
    const bool full = failure == std::errc::no_space_on_device;
    return Unexpected{
        {full ? ErrorCode::Unavailable : ErrorCode::InvalidConfiguration,
         fmt::format("{}: cannot be made or read: {}", shown(folder.string()), failure.message())}};
  }
  for (const auto& entry : entries) {
    if (entry.path().extension() == ".csv" &&
        std::find(telemetry.begin(), telemetry.end(), entry.path()) == telemetry.end()) {
      return Unexpected{
          {ErrorCode::InvalidConfiguration,
           fmt::format("{}: is not of this pass; a folder given as telemetry means every *.csv in "
                       "it: remove it, or choose another --out",
                       shown(entry.path().string()))}};
    }
  }
  return {};
}

}  // namespace

Expected<std::vector<std::filesystem::path>> write_pass(const std::filesystem::path& folder,
                                                        const Scenario& scenario,
                                                        const SimulatedPass& pass) {
  std::vector<std::filesystem::path> paths;
  for (const TelemetryKind& kind : pass.kinds) {
    paths.push_back(path_in(folder, kind));
  }
  const std::string truth = pass.truth.dump(1) + '\n';
  auto written = prepare(folder, paths);
  for (const TelemetryKind& kind : pass.kinds) {
    written = written.and_then([&] {
      return std::visit(
          [&]<class Value>(Kind<Value>) {
            return write_rows(path_in(folder, kind), pass.telemetry.of<Value>());
          },
          kind);
    });
  }
  paths.push_back(folder / "orbit.oem");
  written = written.and_then([&] { return write_orbit(paths.back(), scenario); });
  for (const auto& [name, text] :
       {std::pair{"truth.json", &truth}, std::pair{"mission.toml", &pass.mission_toml}}) {
    paths.push_back(folder / name);
    written = written.and_then([&, whole = text] { return write_file(paths.back(), *whole); });
  }
  return written.map([&] { return std::move(paths); });
}

}  // namespace spindrift
