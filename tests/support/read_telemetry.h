/// @file
/// Reads whole telemetry files through the telemetry stream.

#pragma once

#include <gtest/gtest.h>

#include <cstdint>
#include <filesystem>
#include <string_view>
#include <type_traits>
#include <vector>

#include "services/telemetry/telemetry_stream.h"
#include "tests/support/outcome.h"
#include "tests/support/temporary_folder.h"

namespace spindrift {

inline constexpr std::int64_t kT0_tai_ns = 1795143637568806257;

inline constexpr std::string_view kCodedHeader =
    "t_tai_ns,period_s,sun2_s,north_in_s,north_out_s,south_in_s,south_out_s\n";

struct BadRow {
  std::string_view row;
  const char* reason;
};

/// Collects everything that a stream delivers in its order and checks the size of each batch.
struct ReadTelemetry {
  std::vector<TelemetrySample<Pulse>> samples;
  std::vector<TelemetrySample<CodedFrame>> coded;
  std::vector<RejectedInput> rejected;
  std::vector<TaiTime> times;  ///< Times of the samples of all kinds.
};

inline ReadTelemetry read(const std::vector<std::filesystem::path>& paths,
                          std::size_t buffer_bytes = TelemetryStream::kBufferBytes) {
  const auto files = value_or_throw(scan_telemetry(paths));
  auto stream = value_or_throw(TelemetryStream::open(files, "SPINNER", buffer_bytes));
  ReadTelemetry all;
  while (true) {
    const auto batch = value_or_throw(stream.next());
    EXPECT_LE(count_of(batch.samples), TelemetryStream::kBatch);
    EXPECT_LE(batch.rejected.size(), TelemetryStream::kBatch);
    if (is_empty(batch)) {
      EXPECT_EQ(stream.bytes_given(), stream.bytes_total());
      return all;
    }
    in_order_of_arrival(batch.samples, [&]<class Value>(const TelemetrySample<Value>& sample) {
      all.times.push_back(sample.value.t);
      if constexpr (std::is_same_v<Value, Pulse>) {
        all.samples.push_back(sample);
      } else if constexpr (std::is_same_v<Value, CodedFrame>) {
        all.coded.push_back(sample);
      }
    });
    all.rejected.insert(all.rejected.end(), batch.rejected.begin(), batch.rejected.end());
  }
}

/// Reads a text as pulses.csv.
inline ReadTelemetry read_text(std::string_view text,
                               std::size_t buffer_bytes = TelemetryStream::kBufferBytes) {
  const TemporaryFolder folder;
  return read({folder.write("pulses.csv", text)}, buffer_bytes);
}

}  // namespace spindrift
