/// @file
/// Reads the telemetry of a run that may be continued, in order of arrival.

#pragma once

#include <SQLiteCpp/Database.h>

#include <cstdint>
#include <filesystem>
#include <functional>
#include <map>
#include <optional>
#include <string>
#include <vector>

#include "pipelines/core/expected.h"
#include "services/archive/records.h"
#include "services/telemetry/by_kind.h"
#include "services/telemetry/sender_names.h"

namespace spindrift {

/// Holds the samples of one session that a run left out.
struct LeftOut {
  Origin last;             ///< Origin with the highest seq.
  TelemetryValues values;  ///< Samples of each kind in order of arrival.
};

/// Number of samples that each stored reconstruction of the separation rests on, by method.
using Reconstructed = std::map<std::string, std::int64_t, std::less<>>;

struct StoredPass {
  /// At most this many of the samples left out, the newest ones, are read back.
  static constexpr std::int64_t kMostLeftOut = 1'000'000;

  std::string run_id;
  RunPlace first_arrival;
  /// First arrival of the next run; empty for the newest run.
  std::optional<RunPlace> next_arrival;
  std::optional<TaiTime> earliest;  ///< Time of the earliest sample; empty without samples.
  /// Products of times before this are all stored. It is the start of the last revolution whose
  /// products are complete, or the time of the last attitude; empty when there is none.
  std::optional<TaiTime> last_made;
  std::int64_t rejected_inputs;
  std::vector<SourceCount> source_counts;
  std::vector<TaiTime> batches = {};  ///< Times of the `batch` solutions, in order.
  Reconstructed reconstructed = {};
  LastOrigins last_origins = {};  ///< For each kind of sample, the highest seq of each session.
  TelemetryValues values = {};    ///< Samples of each kind in order of arrival.
  /// Samples that the newest run left out; it may still take them.
  std::vector<LeftOut> left_out = {};
  std::vector<RunPlace> silences = {};  ///< Each is the arrival of the sample after it.
  std::optional<Origin> clock = {};     ///< Source whose telemetry was the clock at last, if any.
};

/// Finds the runs of `spacecraft_id` that agree with `start` (mode, telemetry, program, mission
/// file and orbit) and are not finished, and the newest such run in any case; oldest first. Uses
/// its own connection. @param senders Gives the samples the numbers of their sources. @return Empty
/// when there is no such run; errors as open_for_reading; Unavailable when reading fails.
Expected<std::vector<StoredPass>> find_stored_passes(const std::filesystem::path& archive,
                                                     const std::string& spacecraft_id,
                                                     const RunStart& start, SenderNames& senders);

/// Finds the operator actions on a spacecraft's runs in the mode of `start`, in order of arrival.
/// Actions for another kind of spacecraft are left out, because the mission has changed since.
/// @return Errors as find_stored_passes.
Expected<std::vector<OperatorAction>> find_stored_actions(const std::filesystem::path& archive,
                                                          const std::string& spacecraft_id,
                                                          const RunStart& start);

/// Reads the operator actions on a run and on the runs before it in the same mode, in order of
/// arrival. Actions for another kind of spacecraft than `kind` are left out.
/// @throws SQLite::Exception
std::vector<OperatorAction> read_actions_of_run(SQLite::Database& database,
                                                const std::string& run_id, SpacecraftKind kind);

/// Counts the edges in the run's pulses and coded frames, each sample once. A sample belongs to the
/// run that took it last, so only the newest runs have all of theirs.
/// @return Errors as find_stored_passes.
Expected<std::int64_t> count_stored_edges(const std::filesystem::path& archive,
                                          const std::string& run_id);

}  // namespace spindrift
