/// @file
/// What the archive is given to store: values of the domain, never rows.

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

/// How the samples of a run come.
enum class RunMode { Live, Process, Replay };

/// As in the archive.
constexpr std::string_view name_of(RunMode mode) {
  constexpr std::array<std::string_view, 3> kNames = {"live", "process", "replay"};
  return kNames.at(static_cast<std::size_t>(mode));
}

/// Where a run came from: enough to do it again.
struct RunStart {
  SpacecraftKind spacecraft_kind;
  RunMode mode;
  std::string software_version;
  std::string config_toml;
  std::string config_sha256;
  std::string config_path = {};             ///< Absolute. An orbit file is relative to it.
  std::optional<std::string> orbit_sha256;  ///< Of the mission's orbit file, if it names one.
  std::optional<std::string> telemetry_sha256 = {};  ///< Of all bytes of its files.
  std::optional<std::string> label = {};             ///< That somebody gave it.
  std::vector<std::string> telemetry;                ///< File paths, or DDS domain and partition.
  std::string started_utc;                           ///< ISO 8601, ending in Z.
  std::int64_t first_arrival = 0;  ///< Later than that of any sample of an earlier run.
};

/// How far the samples of a run reach.
struct RunReach {
  TaiTime first;
  TaiTime last;
  /// Of the ten-second spans of the planned contact, those in which samples came; empty: none is
  /// planned.
  std::optional<double> contact_share = {};
};

/// A run that goes on. What it has stored from `t` on is withdrawn, to be made again.
struct Continuation {
  TaiTime t;
};

/// How the samples of one source came in, all its sessions together, since the run began.
struct SourceCount {
  std::string source;
  std::int64_t received = 0;
  std::int64_t gaps = 0;  ///< Samples that are missing.
  std::int64_t duplicates = 0;
  std::int64_t disordered = 0;
};

/// The unit of submission: stored as a whole or not at all, in the order of the members.
///
/// A run's first batch carries `start`, its last one `finished_utc`. A sample that the archive
/// already holds is not stored again, unless it says something else (table contradiction); a
/// product with the key of an earlier one of its run, and a source's count, take its place. Only an
/// edge that is late is not said to be so when something else has become of it: it arrived twice.
struct ArchiveBatch {
  std::string run_id;  ///< Unique over all archives that may ever be merged.
  std::string spacecraft_id;
  std::optional<RunStart> start = {};
  std::optional<Continuation> continuation = {};
  std::optional<RunReach> reach = {};  ///< Where it is news.
  /// With their order of arrival in the run; negative: the run leaves the sample out.
  TelemetrySamples samples = {};
  std::vector<OperatorAction> actions = {};  ///< Of this run, or still in force; likewise.
  /// Of the sources that give a sample this one stands beside it; empty: the first that did.
  std::string preferred_source = {};
  TelemetryValues moved = {};  ///< Stored already, and now of the run in this order of arrival.
  std::vector<std::int64_t> silences = {};  ///< Each before the sample of that arrival.
  std::vector<RejectedInput> rejected = {};
  std::vector<Product> products = {};
  bool stores_residuals = true;  ///< What measurements say to the estimators, of the products.
  std::vector<SourceCount> source_counts = {};
  std::optional<std::string> finished_utc = {};  ///< ISO 8601, ending in Z.
  /// Not stored: when the last sample came that the products rest on. Empty: they waited for none.
  std::optional<std::chrono::steady_clock::time_point> came = {};
};

/// Rows that `batch` asks for, those the archive already holds included.
inline std::size_t row_count(const ArchiveBatch& batch) {
  return count_of(batch.samples) + count_of(batch.moved) + batch.rejected.size() +
         batch.products.size() + batch.source_counts.size() + batch.silences.size() +
         batch.actions.size() + (batch.start ? 1 : 0) + (batch.finished_utc ? 1 : 0);
}

}  // namespace spindrift
