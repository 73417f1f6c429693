/// @file
/// Recorded telemetry as input of `process` and `replay`.

#pragma once

#include <cstdint>
#include <filesystem>
#include <optional>
#include <span>
#include <string>
#include <vector>

#include "pipelines/core/expected.h"
#include "services/mission/mission.h"
#include "services/products/run_notice.h"
#include "services/telemetry/telemetry_files.h"
#include "services/telemetry/telemetry_stream.h"

namespace spindrift {

/// Holds the number of bad rows and the first few of them.
struct BadRows {
  std::uint64_t count = 0;
  std::vector<RejectedInput> first = {};

  void collect(const RejectedInput& row);
  std::string text() const;
};

/// Warns of bad rows and returns the notice; empty when there are none.
std::optional<RunNotice> told_bad_rows(const BadRows& bad);

/// Returns absolute paths, since an archive may be read from another folder.
std::vector<std::string> absolute_texts(std::span<const std::filesystem::path> paths);

/// Reads all files once in constant memory.
/// @return The errors of TelemetryStream.
Expected<BadRows> find_bad_rows(std::span<const TelemetryFile> files);

class TelemetryInput {
 public:
  /// Opens the telemetry in `paths` (files, or directories of them). An empty file beside others
  /// counts as rejected input.
  /// @param spacecraft Spacecraft of the rows in files that do not name one.
  /// @param strict Whether a bad row anywhere is an error.
  /// @return InvalidConfiguration for unreadable files, where there is no row at all, and for bad
  ///         rows when strict.
  static Expected<TelemetryInput> open(std::span<const std::filesystem::path> paths,
                                       const std::string& spacecraft, bool strict);

  /// Returns the next batch, with the errors of TelemetryStream.
  Expected<SampleBatch> next();

  /// Sets the preferred source of `mission` to the name that its samples have in this input. When
  /// no file has that source, it warns and returns the notice.
  std::optional<RunNotice> find_preferred(Mission& mission) const;

  /// Returns each kind of telemetry found in the files once.
  std::vector<TelemetryKind> kinds() const;
  /// Returns the hash over all bytes of the files, with the errors of InputFile.
  Expected<std::string> sha256() const;
  const BadRows& bad_rows() const { return bad_rows_; }  ///< Bad rows returned so far.
  /// @return InvalidConfiguration with the first bad row if rows came, and all of them were bad.
  Expected<void> check_read() const;
  std::uint64_t bytes_given() const { return stream_.bytes_given(); }
  std::uint64_t bytes_total() const { return stream_.bytes_total(); }

 private:
  TelemetryInput(std::vector<TelemetryFile> files, TelemetryStream stream, SampleBatch first)
      : files_{std::move(files)}, stream_{std::move(stream)}, first_{std::move(first)} {}

  std::vector<TelemetryFile> files_;
  TelemetryStream stream_;
  SampleBatch first_;  ///< First batch, until next() returns it.
  BadRows bad_rows_;
  bool has_read_ = false;  ///< Whether a sample was returned.
};

}  // namespace spindrift
