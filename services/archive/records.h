/// @file
/// Values of the domain that the archive stores.

#pragma once

#include <array>
#include <chrono>
#include <cstddef>
#include <cstdint>
#include <optional>
#include <string>
#include <string_view>
#include <vector>

#include "services/mission/spacecraft_kind.h"
#include "services/products/products.h"
#include "services/telemetry/by_kind.h"
#include "services/telemetry/operator_action.h"
#include "services/telemetry/rejected_input.h"

namespace spindrift {

enum class RunMode { Live, Process, Replay };

constexpr std::string_view name_of(RunMode mode) {
  constexpr std::array<std::string_view, 3> kNames = {"live", "process", "replay"};
  return kNames.at(static_cast<std::size_t>(mode));
}

/// Describes how a run was made, so that it can be repeated.
struct RunStart {
  SpacecraftKind spacecraft_kind;
  RunMode mode;
  std::string software_version;
  std::string config_toml;
  std::string config_sha256;
  std::string config_path = {};             ///< Absolute; an orbit file is relative to it.
  std::optional<std::string> orbit_sha256;  ///< Empty when the mission names no orbit file.
  std::optional<std::string> telemetry_sha256 = {};  ///< Digest of all bytes of the files.
  std::optional<std::string> label = {};             ///< Label that the user gave the run.
  std::vector<std::string> telemetry;                ///< File paths, or DDS domain and partition.
  std::string started_utc;                           ///< ISO 8601, ending in Z.
  RunPlace first_arrival = {};                       ///< After every arrival of an earlier run.
};

struct RunReach {
  TaiTime first;
  TaiTime last;
  /// Share of the planned contact's ten-second spans with samples; empty without a contact.
  std::optional<double> contact_share = {};
};

/// Marks that a run is continued. Its products from `t` on are withdrawn and will be made again.
struct Continuation {
  TaiTime t;
};

/// Counts of the samples of one source since the run began, summed over its sessions.
struct SourceCount {
  std::string source;
  std::int64_t received = 0;
  std::int64_t gaps = 0;  ///< Number of missing samples.
  std::int64_t duplicates = 0;
  std::int64_t disordered = 0;
};

/// Says whose telemetry is the clock of the others from an arrival on.
struct SourceClock {
  RunPlace arrival;
  std::optional<Origin> source;  ///< Empty: the host's clock counts again.
};

/// The unit of submission. It is stored as a whole or not at all, in the order of the members.
/// The first batch of a run carries `start`, its last one `finished_utc`. A sample that the archive
/// already holds is not stored again, unless it has another value (table contradiction). A product
/// replaces an earlier one of its run with the same key, and a source's count replaces the earlier
/// count. Only an edge rejected as late does not replace the row of an edge with another outcome:
/// the edge arrived twice.
struct ArchiveBatch {
  std::string run_id;  ///< Unique over all archives that may ever be merged.
  std::string spacecraft_id;
  std::optional<RunStart> start = {};
  std::optional<Continuation> continuation = {};
  std::optional<RunReach> reach = {};  ///< Set when it has changed.
  ArrivedSamples samples = {};
  /// Operator actions of this run, and earlier ones that are still in force.
  std::vector<OperatorAction> actions = {};
  /// Source stored with a sample that several sources give; empty: the first of them.
  std::string preferred_source = {};
  TelemetryValues moved = {};  ///< Stored samples that the run takes now, with their new arrival.
  std::vector<RunPlace> silences = {};  ///< Each is the arrival of the sample after it.
  std::vector<SourceClock> clocks = {};
  std::vector<RejectedInput> rejected = {};
  std::vector<Product> products = {};
  bool stores_residuals = true;  ///< Whether products store residuals in the estimators.
  std::vector<SourceCount> source_counts = {};
  std::optional<std::string> finished_utc = {};  ///< ISO 8601, ending in Z.
  /// When the last sample came that the products rest on; not stored. Empty: there is none.
  std::optional<std::chrono::steady_clock::time_point> came = {};
};

/// Returns the number of rows in `batch`, including those that the archive already holds.
inline std::size_t row_count(const ArchiveBatch& batch) {
  return count_of(batch.samples) + count_of(batch.moved) + batch.rejected.size() +
         batch.products.size() + batch.source_counts.size() + batch.silences.size() +
         batch.clocks.size() + batch.actions.size() + (batch.start ? 1 : 0) +
         (batch.finished_utc ? 1 : 0);
}

}  // namespace spindrift
