/// @file
/// Gives all telemetry of a recorded pass in order of time, in bounded memory.

#pragma once

#include <cstddef>
#include <cstdint>
#include <functional>
#include <queue>
#include <span>
#include <string>
#include <utility>
#include <variant>
#include <vector>

#include "pipelines/core/expected.h"
#include "services/telemetry/sample_batch.h"
#include "services/telemetry/sorted_rows.h"
#include "services/telemetry/telemetry_files.h"

namespace spindrift {

/// Merges the samples of any number of files, whatever the order of the files and of their rows;
/// duplicates are kept. Rows that their file shows to be stray (find_stray_rows) keep their place
/// in it, each after another row in order.
/// Rows are held back to be sorted, in `buffer_bytes` for all files together. A file that fits is
/// sorted completely; in a longer one a row is sorted into its place if that is nearer than half of
/// the rows held of its file. A row from further away is passed on late.
class TelemetryStream {
 public:
  /// Has room for four million pulses.
  static constexpr std::size_t kBufferBytes = std::size_t{96} * 1024 * 1024;
  /// Samples per batch, as many as the bus delivers at a time, since queues count batches.
  static constexpr std::size_t kBatch = 256;

  /// @param spacecraft  Spacecraft of the rows, where a file does not say.
  /// @return InvalidConfiguration for what is not a readable file of its kind.
  static Expected<TelemetryStream> open(std::span<const TelemetryFile> files,
                                        const std::string& spacecraft,
                                        std::size_t buffer_bytes = kBufferBytes);

  /// Returns up to kBatch samples, and more until neither the last nor the next is stray, and up to
  /// kBatch rejected rows; both are empty at the end. The origin of a sample is the file's source,
  /// 0 and the line.
  /// @return Unavailable when reading fails on the way.
  Expected<SampleBatch> next();

  /// Progress in bytes over all files. Rows that are read but held back do not count yet.
  std::uint64_t bytes_given() const;
  std::uint64_t bytes_total() const { return bytes_total_; }

 private:
  using File = TelemetryKinds::Of<std::variant, SortedRows>;
  /// The head of a file; of equal heads, that of the file named first comes first.
  using Head = std::pair<TelemetryOrder, std::size_t>;

  TelemetryStream(std::vector<File> files, std::uint64_t bytes_total);

  Expected<bool> find_heads(SampleBatch& batch);

  std::vector<File> files_;
  std::vector<std::size_t> without_head_;  ///< Files whose next row is unknown.
  std::priority_queue<Head, std::vector<Head>, std::greater<>> heads_;
  std::uint64_t bytes_total_;
};

}  // namespace spindrift
