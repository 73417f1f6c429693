/// @file
/// Pulse telemetry from files: samples, and rows that are none with the reason.

#pragma once

#include <filesystem>
#include <optional>
#include <span>
#include <string>
#include <string_view>
#include <variant>
#include <vector>

#include "pipelines/core/expected.h"
#include "services/ingest/rejected_input.h"
#include "services/ingest/sample.h"
#include "services/telemetry_files/csv.h"
#include "services/telemetry_files/telemetry_files.h"

namespace spindrift {

using PulseRow = std::variant<PulseSample, RejectedInput>;

/// One pulse file, row by row, in constant memory.
class PulseFile {
 public:
  /// @param spacecraft  Of the rows, where the file does not say.
  /// @return InvalidConfiguration for what is not a readable pulse file.
  static Expected<PulseFile> open(const std::filesystem::path& path, std::string spacecraft);

  /// Empty at the end of the file. The origin of a sample is the file's name, 0 and the line; a
  /// rejected row has the path as it was given.
  /// @return Unavailable when reading fails on the way.
  Expected<std::optional<PulseRow>> next();

 private:
  PulseFile(CsvLines lines, TelemetryLayout layout, std::filesystem::path path,
            std::string spacecraft)
      : lines_{std::move(lines)},
        layout_{layout},
        path_{std::move(path)},
        spacecraft_{std::move(spacecraft)} {}

  Expected<PulseSample> sample_from(const CsvLine& line) const;

  CsvLines lines_;
  TelemetryLayout layout_;
  std::filesystem::path path_;
  std::string spacecraft_;
};

struct PulseTelemetry {
  std::vector<PulseSample> samples;
  std::vector<RejectedInput> rejected;
};

/// All pulse files among `files`, other kinds passed over. The samples are in the order of their
/// pulses, whatever the order of the files and of their rows; duplicates are kept.
/// @return As PulseFile.
Expected<PulseTelemetry> read_pulses(std::span<const TelemetryFile> files,
                                     const std::string& spacecraft);

}  // namespace spindrift
