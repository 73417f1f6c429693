/// @file
/// What the archive holds of a run that may go on: its telemetry in the order of arrival.

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
#include "services/telemetry/last_origins.h"
#include "services/telemetry/sender_names.h"

namespace spindrift {

/// What a run left out of one session.
struct LeftOut {
  Origin last;             ///< With its highest seq.
  TelemetryValues values;  ///< Each kind in order of arrival.
};

/// How many samples the stored reconstruction of the separation by a method rests on.
using Reconstructed = std::map<std::string, std::int64_t, std::less<>>;

struct StoredPass {
  /// No more of what it left out, the newest, come back.
  static constexpr std::int64_t kMostLeftOut = 1'000'000;

  std::string run_id;
  std::int64_t first_arrival;
  std::optional<std::int64_t> next_arrival;  ///< Of the next run; empty: it is the newest.
  std::optional<TaiTime> earliest;           ///< Of its samples; empty: it has none.
  /// What the pass made of earlier times is stored: the last revolution of which all is began then,
  /// or the last attitude is of then. Empty: there is none.
  std::optional<TaiTime> last_made;
  std::int64_t rejected_inputs;
  std::vector<SourceCount> source_counts;
  std::vector<TaiTime> batches = {};  ///< Of its solutions of `batch`, in order.
  Reconstructed reconstructed = {};
  LastOrigins last_origins = {};            ///< Of its samples, as they arrived first.
  TelemetryValues values = {};              ///< Each kind in order of arrival.
  std::vector<LeftOut> left_out = {};       ///< Of the newest run: it may become of it yet.
  std::vector<std::int64_t> silences = {};  ///< Each before the sample of that arrival.
};

/// Of the runs of `spacecraft_id` that were made as `start` says (same mode, telemetry, program,
/// mission file and orbit) those that are not finished, and the newest in any case; oldest first.
/// Reads by a connection of its own.
/// @param senders Give the samples the numbers of their sources.
/// @return none when there is none; as open_for_reading; Unavailable when reading fails.
Expected<std::vector<StoredPass>> find_stored_passes(const std::filesystem::path& archive,
                                                     const std::string& spacecraft_id,
                                                     const RunStart& start, SenderNames& senders);

/// What operators have said of the telemetry of a spacecraft to runs of the mode of `start`, in
/// order of arrival. What is of another kind of spacecraft is left out: the mission has changed.
/// @return as find_stored_passes.
Expected<std::vector<OperatorAction>> find_stored_actions(const std::filesystem::path& archive,
                                                          const std::string& spacecraft_id,
                                                          const RunStart& start);

/// To the run of a spacecraft of that kind and those before it, likewise. @throws SQLite::Exception
std::vector<OperatorAction> read_actions_of_run(SQLite::Database& database,
                                                const std::string& run_id, SpacecraftKind kind);

/// Edges in the run's pulses and coded frames, each sample once. Of the newest runs: a sample
/// belongs to the run that took it last.
/// @return as find_stored_passes.
Expected<std::int64_t> count_stored_edges(const std::filesystem::path& archive,
                                          const std::string& run_id);

}  // namespace spindrift
