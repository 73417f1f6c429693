/// @file
/// All telemetry of a recorded pass in the order of its time, in bounded memory.

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

/// The samples of any number of files, whatever the order of the files and of their rows;
/// duplicates are kept. Only rows that their file shows to be stray (find_stray_rows) come at the
/// place that they have in it, each after another row in order.
///
/// Rows are held back to be sorted, in `buffer_bytes` for all files together. What that holds is
/// sorted completely, and in what is longer every row finds its place that stands nearer to it than
/// half of what is held of its file. A row from still further away comes late, and is passed on.
class TelemetryStream {
 public:
  /// Room for four million pulses.
  static constexpr std::size_t kBufferBytes = std::size_t{96} * 1024 * 1024;
  /// Samples a batch, as many as come from the bus at a time: queues count batches.
  static constexpr std::size_t kBatch = 256;

  /// @param spacecraft  Of the rows, where a file does not say.
  /// @return InvalidConfiguration for what is not a readable file of its kind.
  static Expected<TelemetryStream> open(std::span<const TelemetryFile> files,
                                        const std::string& spacecraft,
                                        std::size_t buffer_bytes = kBufferBytes);

  /// Up to kBatch samples, and what it takes to end and go on with none that is stray, and as many
  /// rejected rows; none of both at the end. The origin of a sample is the file's source, 0 and the
  /// line.
  /// @return Unavailable when reading fails on the way.
  Expected<SampleBatch> next();

  /// Of all files, and how many there are: how far it is. Rows that are read but held back are not
  /// counted yet.
  std::uint64_t bytes_given() const;
  std::uint64_t bytes_total() const { return bytes_total_; }

 private:
  using File = TelemetryKinds::Of<std::variant, SortedRows>;
  /// The head of a file; of equals the file that was named first.
  using Head = std::pair<TelemetryOrder, std::size_t>;

  TelemetryStream(std::vector<File> files, std::uint64_t bytes_total);

  Expected<bool> find_heads(SampleBatch& batch);

  std::vector<File> files_;
  std::vector<std::size_t> without_head_;  ///< Files whose next row is not known yet.
  std::priority_queue<Head, std::vector<Head>, std::greater<>> heads_;
  std::uint64_t bytes_total_;
};

}  // namespace spindrift
