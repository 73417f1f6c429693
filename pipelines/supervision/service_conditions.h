/// @file
/// The alert conditions for a spacecraft's link and for the service that supervises it.
///
/// The clocks are part of the given state: supervision reads none itself.

#pragma once

#include <cstdint>
#include <map>
#include <optional>
#include <string>

#include "pipelines/supervision/condition_watch.h"
#include "pipelines/supervision/limits.h"
#include "pipelines/supervision/rise_of_last_minute.h"

namespace spindrift {

/// Holds the counts of one telemetry source since the service started.
struct SourceRecord {
  std::int64_t missing = 0;   ///< Lasting gaps in its sequence numbers, over all spacecraft.
  std::int64_t restarts = 0;  ///< Sessions begun after the first one.
  std::int64_t repeated = 0;  ///< Samples older than the session that delivered them.
};

/// The end of validity of data, and how bad it is that they end.
struct DataEnd {
  TaiTime until;
  AlertSeverity severity = AlertSeverity::Warning;
};

/// Holds the state of the service at one moment, once telemetry of the spacecraft has come.
struct ServiceState {
  TaiTime t;                            ///< Wall-clock time, later than in the previous state.
  TaiTime pass_t;                       ///< Present time on the clock that the telemetry follows.
  std::optional<double> silent_s = {};  ///< Time since the last sample; empty while some wait.
  std::optional<double> late_s = {};    ///< Delay of the last sample; empty if recorded.
  std::map<std::string, SourceRecord> sources = {};
  std::int64_t received = 0;  ///< Samples of this spacecraft since the service started.
  std::int64_t rejected = 0;  ///< Rejected samples among `received`.
  /// Another service that publishes results of this spacecraft; empty if there is none.
  std::optional<std::string> other_service = {};
  double undelivered_s = 0.0;  ///< Time for which the webhook has not taken alerts.
  double backlog_s = 0.0;      ///< Time for which the oldest sample has waited to be committed.
  bool write_failed = false;
  std::optional<double> free_gib = {};  ///< Free space of the archive; empty if unknown.
  double log_mib = 0.0;                 ///< What the archive's log has and its file has not.
  double clock_step_s = 0.0;            ///< Step of the wall clock since the previous state.
  std::map<std::string, DataEnd> data_ends = {};  ///< Ends of validity by item, such as "orbit".
};

/// Watches one spacecraft; conditions of the whole service are raised for each spacecraft.
class ServiceConditions {
 public:
  ServiceConditions(const AlertLimits& limits, std::optional<Contact> contact);

  /// Sets the limits of what is evaluated from now on.
  void set_limits(const AlertLimits& limits) { limits_ = limits; }

  ConditionChanges evaluate(const ServiceState& state);

 private:
  struct Source {
    explicit Source(const std::string& name);
    RiseOfLastMinute missing;
    RiseOfLastMinute restarts;
    RiseOfLastMinute repeated;
    ConditionWatch gap;
    ConditionWatch restarted;
    ConditionWatch again;
  };

  void see_silence(const ServiceState& state, ConditionChanges& changes);
  void see_link(const ServiceState& state, ConditionChanges& changes);
  void see_archive(const ServiceState& state, ConditionChanges& changes);
  void see_data(const ServiceState& state, ConditionChanges& changes);

  AlertLimits limits_;
  std::optional<Contact> contact_;
  ConditionWatch silent_;
  ConditionWatch late_;
  ConditionWatch ahead_;
  ConditionWatch rejected_;
  ConditionWatch twice_;
  ConditionWatch undelivered_;
  ConditionWatch backlog_;
  ConditionWatch write_;
  ConditionWatch disk_;
  ConditionWatch log_;
  ConditionWatch disagree_;
  ConditionWatch clock_;
  RiseOfLastMinute received_count_;
  RiseOfLastMinute rejected_count_;
  std::map<std::string, Source> sources_;
  std::map<std::string, ConditionWatch> outdated_;
};

}  // namespace spindrift
