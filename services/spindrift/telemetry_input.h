/// @file
/// Recorded telemetry as `process` and `replay` take it.

#pragma once

#include <cstdint>
#include <filesystem>
#include <span>
#include <string>
#include <vector>

#include "pipelines/core/expected.h"
#include "services/telemetry_files/telemetry_files.h"
#include "services/telemetry_files/telemetry_stream.h"

namespace spindrift {

/// How many rows were bad, and the first few of them.
struct BadRows {
  std::uint64_t count = 0;
  std::vector<RejectedInput> first = {};

  void add(const RejectedInput& row);
  std::string text() const;
};

/// Of the files that can be processed. A pass over all of them, in constant memory.
/// @return as TelemetryStream.
Expected<BadRows> find_bad_rows(std::span<const TelemetryFile> files);

class TelemetryInput {
 public:
  /// The pulses and coded frames among `paths` (files, or directories of them). Files of another
  /// kind are left out with a warning; an empty file beside others is rejected input.
  /// @param spacecraft Of the rows, where a file does not say.
  /// @param strict     A bad row anywhere is an error.
  /// @return InvalidConfiguration for unreadable files, where there is no row at all, and for bad
  ///         rows when strict.
  static Expected<TelemetryInput> open(std::span<const std::filesystem::path> paths,
                                       const std::string& spacecraft, bool strict);

  /// As TelemetryStream.
  Expected<SampleBatch> next();

  bool holds(TelemetryKind kind) const;
  const BadRows& bad_rows() const { return bad_rows_; }  ///< Of the batches given.
  std::uint64_t bytes_given() const { return stream_.bytes_given(); }
  std::uint64_t bytes_total() const { return stream_.bytes_total(); }

 private:
  TelemetryInput(std::vector<TelemetryFile> files, TelemetryStream stream, SampleBatch first)
      : files_{std::move(files)}, stream_{std::move(stream)}, first_{std::move(first)} {}

  std::vector<TelemetryFile> files_;
  TelemetryStream stream_;
  SampleBatch first_;  ///< Not given yet.
  BadRows bad_rows_;
};

/// The end of a stream.
inline bool is_empty(const SampleBatch& batch) {
  return batch.pulses.empty() && batch.coded.empty() && batch.rejected.empty();
}

}  // namespace spindrift
