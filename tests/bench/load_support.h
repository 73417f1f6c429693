/// @file
/// Functions shared by the programs that put load on a running service.

#pragma once

#include <fmt/format.h>

#include <cstdlib>
#include <filesystem>
#include <string>
#include <utility>
#include <variant>
#include <vector>

#include "pipelines/core/expected.h"
#include "services/telemetry/telemetry_files.h"
#include "services/telemetry/telemetry_stream.h"

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

using AnySample = TelemetryKinds::Of<std::variant, TelemetrySample>;

/// Returns the samples of a file or folder in order of time, of the named spacecraft if there are
/// several.
inline std::vector<AnySample> read_samples(const std::string& path, const std::string& spacecraft) {
  const std::vector<std::filesystem::path> paths{path};
  const std::vector<TelemetryFile> files = or_exit(scan_telemetry(paths));
  TelemetryStream stream = or_exit(TelemetryStream::open(files, spacecraft));
  std::vector<AnySample> samples;
  for (SampleBatch batch = or_exit(stream.next()); !is_empty(batch);
       batch = or_exit(stream.next())) {
    in_order_of_arrival(batch.samples, [&](const auto& sample) {
      if (sample.spacecraft == spacecraft) {
        samples.emplace_back(sample);
      }
    });
  }
  return samples;
}

/// Returns the pulses of a file in order of time.
inline std::vector<Pulse> read_pulses(const std::string& path) {
  std::vector<Pulse> pulses;
  for (const AnySample& sample : read_samples(path, "LOAD")) {
    pulses.push_back(std::get<TelemetrySample<Pulse>>(sample).value);
  }
  return pulses;
}

}  // namespace spindrift::bench
