/// @file
/// How the service is doing, as told to others once a second.

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
  LinkState link;  ///< Waiting: nothing has come yet, which is not known to be good or bad.
  std::optional<TaiTime> last_sample = {};  ///< Telemetry time of the one that came last.
  std::optional<double> data_age_s = {};    ///< Since it came; empty: none has since the start.
  PassVerdict verdict = {};                 ///< Of the run in force.
};

struct Health {
  TaiTime t;  ///< Of this report: wall clock.
  std::uint64_t samples_received;
  std::uint64_t samples_committed;
  std::uint64_t gaps;  ///< Missing now.
  std::uint64_t duplicates;
  std::uint64_t queue_depth;
  double commit_p99_ms;
  std::string status;  ///< For people: "ok" or the worst problem; its first 64 bytes are published.
  std::string message;  ///< All problems as they are, a line each; empty when there are none.
  std::vector<SpacecraftHealth> spacecraft = {};
  bool works = true;  ///< Samples are taken and stored, whatever else is wrong.
};

}  // namespace spindrift
