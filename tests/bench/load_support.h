/// @file
/// What the programs that put a running service under load share.

#pragma once

#include <fmt/format.h>

#include <cstdlib>
#include <filesystem>
#include <string>
#include <utility>
#include <vector>

#include "pipelines/core/expected.h"
#include "services/telemetry_files/telemetry_files.h"
#include "services/telemetry_files/telemetry_stream.h"

namespace spindrift::bench {

template <class T>
T or_exit(Expected<T> value) {
  if (!value) {
    fmt::print(stderr, "{}\n", value.error().message);
    std::exit(1);
  }
  if constexpr (!std::is_void_v<T>) {
    return std::move(*value);
  }
}

/// The pulses of a file in order of time.
inline std::vector<Pulse> read_pulses(const std::string& path) {
  const std::vector<std::filesystem::path> paths{path};
  const std::vector<TelemetryFile> files = or_exit(scan_telemetry(paths));
  TelemetryStream stream = or_exit(TelemetryStream::open(files, "LOAD"));
  std::vector<Pulse> pulses;
  for (SampleBatch batch = or_exit(stream.next()); !batch.samples.of<Pulse>().empty();
       batch = or_exit(stream.next())) {
    for (const TelemetrySample<Pulse>& sample : batch.samples.of<Pulse>()) {
      pulses.push_back(sample.value);
    }
  }
  return pulses;
}

}  // namespace spindrift::bench
