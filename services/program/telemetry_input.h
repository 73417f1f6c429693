/// @file
/// Recorded telemetry as `process` and `replay` take it.

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

/// How many rows were bad, and the first few of them.
struct BadRows {
  std::uint64_t count = 0;
  std::vector<RejectedInput> first = {};

  void add(const RejectedInput& row);
  std::string text() const;
};

/// The warning of them. @return it; empty: there are none.
std::optional<RunNotice> told_bad_rows(const BadRows& bad);

/// As an archive keeps them, which may be read from another folder.
std::vector<std::string> absolute_texts(std::span<const std::filesystem::path> paths);

/// A pass over all files, in constant memory.
/// @return as TelemetryStream.
Expected<BadRows> find_bad_rows(std::span<const TelemetryFile> files);

class TelemetryInput {
 public:
  /// The telemetry in `paths` (files, or directories of them). An empty file beside others is
  /// rejected input.
  /// @param spacecraft Of the rows, where a file does not say.
  /// @param strict     A bad row anywhere is an error.
  /// @return InvalidConfiguration for unreadable files, where there is no row at all, and for bad
  ///         rows when strict.
  static Expected<TelemetryInput> open(std::span<const std::filesystem::path> paths,
                                       const std::string& spacecraft, bool strict);

  /// As TelemetryStream.
  Expected<SampleBatch> next();

  /// The preferred source of `mission` by the name that its samples have here. That it is none of
  /// the files is said, and returned.
  std::optional<RunNotice> find_preferred(Mission& mission) const;

  /// That there are files of, each once.
  std::vector<TelemetryKind> kinds() const;
  /// Of all bytes of the files. @return the errors of InputFile.
  Expected<std::string> sha256() const;
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

}  // namespace spindrift
