/// @file
/// Gathers once a second what the conditions of the service are checked against.

#pragma once

#include <chrono>
#include <cstdint>
#include <deque>
#include <map>
#include <optional>
#include <string>

#include "pipelines/supervision/service_conditions.h"
#include "services/ingest/telemetry_subscriber.h"
#include "services/serving/routing.h"
#include "services/serving/service_run.h"

namespace spindrift {

/// Measures the age of the oldest sample that is not committed, at the times when it is asked.
class BacklogWatch {
 public:
  using Instant = std::chrono::steady_clock::time_point;

  /// @param come Number of all samples so far.
  /// @param committed Number of committed samples.
  /// @return Age of the oldest sample that is not committed, s, counted from the call that first
  /// saw it.
  double update(Instant now, std::uint64_t come, std::uint64_t committed) {
    if (looks_.empty() || looks_.back().come != come) {
      looks_.push_back({.at = now, .come = come});
    }
    while (!looks_.empty() && looks_.front().come <= committed) {
      looks_.pop_front();
    }
    return looks_.empty() ? 0.0 : std::chrono::duration<double>{now - looks_.front().at}.count();
  }

 private:
  struct Look {
    Instant at;
    std::uint64_t come;
  };
  std::deque<Look> looks_;  ///< Calls whose samples are not all committed.
};

class ServiceWatch {
 public:
  /// All arguments must outlive the watch.
  ServiceWatch(const ServiceParts& parts, const Heard& heard);

  using States = std::map<std::string, ServiceState>;
  /// @param gaps Lasting gaps by source.
  /// @return State by spacecraft with telemetry since the start, or Unavailable.
  Expected<States> look(const TelemetrySubscriberStatus& status,
                        const std::map<std::string, std::uint64_t>& gaps);

  /// Returns the wall-clock time of the last look. It never goes back.
  TaiTime t() const { return t_; }

 private:
  using Instant = std::chrono::steady_clock::time_point;

  void note_time(Instant now);
  ServiceState state_of_service(Instant now);
  void note_link(const SpacecraftHealth& link, std::optional<double> silent_s,
                 ServiceState& state) const;

  const ServiceParts& parts_;
  const Heard& heard_;
  BacklogWatch backlog_;
  /// End of validity of auxiliary data, by spacecraft and kind of data.
  std::map<std::string, std::map<std::string, DataEnd>> data_ends_;
  std::optional<Instant> last_;
  TaiTime wall_ = {};
  TaiTime t_ = {};
  double clock_step_s_ = 0.0;
  std::uint64_t failures_ = 0;
};

}  // namespace spindrift
