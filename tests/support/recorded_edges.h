/// @file
/// Recorded edges as a processor takes them, and processors for them.

#pragma once

#include <gtest/gtest.h>

#include <algorithm>
#include <filesystem>
#include <string>
#include <utility>
#include <vector>

#include "services/archive/archive.h"
#include "services/mission/mission.h"
#include "services/processor/processor.h"
#include "services/telemetry/telemetry_files.h"
#include "services/telemetry/telemetry_stream.h"
#include "tests/support/test_paths.h"

namespace spindrift::testing {

using Samples = std::vector<TelemetrySample<Pulse>>;

/// Returns the first edges of a pass in order of time, under the name of a spacecraft.
inline Samples edges_of(const std::filesystem::path& pass, std::size_t count,
                        const std::string& spacecraft = "SPINNER") {
  const std::vector<TelemetryFile> files{{.path = pass / "pulses.csv", .kind = Kind<Pulse>{}}};
  auto stream = TelemetryStream::open(files, spacecraft).value();
  Samples all;
  for (auto batch = stream.next().value(); !is_empty(batch) && all.size() < count;
       batch = stream.next().value()) {
    const Samples& some = batch.samples.of<Pulse>();
    all.insert(all.end(), some.begin(), some.end());
  }
  all.resize(std::min(all.size(), count));
  return all;
}

/// Returns the samples from place `first` to before `last`.
inline Samples part_of(const Samples& all, std::size_t first, std::size_t last) {
  const auto place = [&](std::size_t i) { return all.begin() + static_cast<std::ptrdiff_t>(i); };
  return {place(first), place(std::min(last, all.size()))};
}

/// Returns the processor of a live service for spacecraft of these missions.
inline Processor live_processor(std::vector<Mission> missions) {
  return Processor::make(std::move(missions),
                         {.mode = RunMode::Live, .telemetry = {"DDS domain 0, partition live"}})
      .value();
}

inline void submit(Archive& archive, std::vector<ArchiveBatch> batches) {
  for (ArchiveBatch& batch : batches) {
    ASSERT_TRUE(archive.submit(std::move(batch)));
  }
}

/// Stores the routed samples, and the products of what they make due.
inline void work(Processor& processor, Routed routed, Archive& archive) {
  submit(archive, std::move(routed.samples));
  for (const PassInput& input : routed.work) {
    submit(archive, processor.compute(input));
  }
}

}  // namespace spindrift::testing
