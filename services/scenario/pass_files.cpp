#include "services/scenario/pass_files.h"

#include <fmt/format.h>

#include <algorithm>
#include <array>
#include <chrono>
#include <iterator>
#include <string>
#include <system_error>
#include <utility>

#include "pipelines/ephemeris/oem_writer.h"
#include "pipelines/ground_model/coded_telemetry.h"
#include "services/scenario/output_file.h"
#include "services/scenario/truth_text.h"

namespace spindrift {
namespace {

constexpr std::chrono::seconds kOrbitStep{60};
constexpr std::chrono::minutes kOrbitMargin{10};
constexpr std::size_t kBlock = 1U << 20U;

Expected<std::string> orbit_text(const Scenario& scenario) {
  if (scenario.oem_text) {
    return *scenario.oem_text;
  }
  const TaiTime start = scenario.truth.start;
  return sampled_orbit(scenario.orbit, start - kOrbitMargin,
                       shifted(start, scenario.duration_s) + kOrbitMargin, kOrbitStep)
      .map([&](const std::vector<EphemerisPoint>& points) {
        return oem_text(scenario.spacecraft_id, start, points);
      });
}

void append_row(const ReceivedPulse& received, std::string& text) {
  fmt::format_to(std::back_inserter(text), "{},{}\n", tai_ns(received.pulse.t),
                 name_of(received.pulse.channel));
}

void append_interval(const std::optional<double>& interval_s, std::string& text) {
  text += ',';
  if (interval_s) {
    fmt::format_to(std::back_inserter(text), "{:.9f}", *interval_s);
  }
}

void append_row(const CodedFrame& frame, std::string& text) {
  fmt::format_to(std::back_inserter(text), "{}", tai_ns(frame.t));
  append_interval(frame.period_s, text);
  for (std::size_t channel = index_of(PulseChannel::Sun2); channel < kPulseChannels; ++channel) {
    append_interval(frame.delay_s.at(channel), text);
  }
  text += '\n';
}

/// The rows in blocks: a long pass is larger as text than as values.
template <class Rows>
Expected<void> write_rows(const std::filesystem::path& path, std::string text, const Rows& rows) {
  auto file = OutputFile::create(path);
  if (!file) {
    return Unexpected{std::move(file.error())};
  }
  for (const auto& row : rows) {
    append_row(row, text);
    if (text.size() >= kBlock) {
      if (auto written = file->write(text); !written) {
        return written;
      }
      text.clear();
    }
  }
  return file->write(text).and_then([&] { return file->commit(); });
}

Expected<void> write_telemetry(const std::filesystem::path& path, const Scenario& scenario,
                               const SimulatedPass& pass) {
  if (path.filename() == "pulses.csv") {
    return write_rows(path, "t_tai_ns,channel\n", pass.received.pulses);
  }
  return write_rows(path,
                    "t_tai_ns,period_s,sun2_s,north_in_s,north_out_s,south_in_s,south_out_s\n",
                    coded_telemetry(pass.received, scenario.telemetry.coded_resolution_s));
}

std::vector<std::filesystem::path> telemetry_paths(const std::filesystem::path& folder,
                                                   const SimulatedTelemetry& kinds) {
  std::vector<std::filesystem::path> paths;
  if (kinds.pulses) {
    paths.push_back(folder / "pulses.csv");
  }
  if (kinds.coded) {
    paths.push_back(folder / "coded.csv");
  }
  return paths;
}

/// Makes the folder; refuses one with telemetry that is not of this pass.
Expected<void> prepare(const std::filesystem::path& folder,
                       const std::vector<std::filesystem::path>& telemetry) {
  std::error_code failure;
  std::filesystem::create_directories(folder, failure);
  const std::filesystem::directory_iterator entries{folder, failure};
  if (failure) {
    const bool full = failure == std::errc::no_space_on_device;
    return Unexpected{
        {full ? ErrorCode::Unavailable : ErrorCode::InvalidConfiguration,
         fmt::format("{}: cannot be made or read: {}", folder.string(), failure.message())}};
  }
  for (const auto& entry : entries) {
    if (entry.path().extension() == ".csv" &&
        std::find(telemetry.begin(), telemetry.end(), entry.path()) == telemetry.end()) {
      return Unexpected{
          {ErrorCode::InvalidConfiguration,
           fmt::format("{}: is not of this pass; a folder given as telemetry means every *.csv in "
                       "it: remove it, or choose another --out",
                       entry.path().string())}};
    }
  }
  return {};
}

}  // namespace

Expected<std::vector<std::filesystem::path>> write_pass(const std::filesystem::path& folder,
                                                        const Scenario& scenario,
                                                        const SimulatedPass& pass) {
  const auto orbit = orbit_text(scenario);
  const auto truth = truth_text(scenario, pass);
  if (!orbit || !truth) {
    return Unexpected{orbit ? truth.error() : orbit.error()};
  }
  std::vector<std::filesystem::path> paths = telemetry_paths(folder, scenario.telemetry);
  auto written = prepare(folder, paths);
  for (const auto& path : paths) {
    written = written.and_then([&] { return write_telemetry(path, scenario, pass); });
  }
  for (const auto& [name, text] : {std::pair{"orbit.oem", &*orbit},
                                   {"truth.json", &*truth},
                                   {"mission.toml", &scenario.mission_toml}}) {
    paths.push_back(folder / name);
    written = written.and_then([&, whole = text] { return write_file(paths.back(), *whole); });
  }
  return written.map([&] { return std::move(paths); });
}

}  // namespace spindrift
