/// @file
/// The health of the service, published once a second.

#pragma once

#include <cstdint>
#include <optional>
#include <string>
#include <vector>

#include "pipelines/time/tai_time.h"
#include "services/products/pass_verdict.h"

namespace spindrift {

enum class LinkState { Waiting, Live, Stale };

struct SpacecraftHealth {
  std::string spacecraft;
  LinkState link;  ///< Waiting when no sample has come yet, so its state is unknown.
  std::optional<TaiTime> last_sample = {};  ///< Telemetry time of the sample that came last.
  /// Time since that sample came, s; empty when none has come since the start.
  std::optional<double> data_age_s = {};
  PassVerdict verdict = {};  ///< Verdict on the current run.
};

struct Health {
  TaiTime t;  ///< Wall-clock time of this report.
  std::uint64_t samples_received;
  std::uint64_t samples_committed;
  std::uint64_t gaps;  ///< Samples that are missing at present.
  std::uint64_t duplicates;
  std::uint64_t queue_depth;
  double commit_p99_ms;
  std::string status;   ///< "ok" or the worst problem; 64 bytes of it are published.
  std::string message;  ///< All problems, one per line; empty when there are none.
  std::vector<SpacecraftHealth> spacecraft = {};
  bool works = true;  ///< Whether samples are taken and stored.
};

}  // namespace spindrift
