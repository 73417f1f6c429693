/// @file
/// What is worth an alert in the link of a spacecraft and in the service that supervises it.

#pragma once

#include <cstdint>
#include <map>
#include <optional>
#include <string>

#include "pipelines/supervision/condition_watch.h"
#include "pipelines/supervision/limits.h"
#include "pipelines/supervision/rise_of_last_minute.h"

namespace spindrift {

/// What came of one source of telemetry since the service started.
struct SourceRecord {
  std::int64_t missing = 0;   ///< By gaps in its sequence numbers, that last; of all spacecraft.
  std::int64_t restarts = 0;  ///< Sessions that it began behind the first.
  std::int64_t repeated = 0;  ///< Samples from before the session that brought them.
};

/// As the service knows it at one moment; some telemetry of the spacecraft has come.
struct ServiceState {
  TaiTime t;                            ///< Wall clock, later than before.
  TaiTime pass_t;                       ///< The clock that telemetry goes by, now.
  std::optional<double> silent_s = {};  ///< Since a sample came; empty: some wait to be looked at.
  std::optional<double> late_s = {};    ///< Of the last sample when it came; empty: it is recorded.
  std::map<std::string, SourceRecord> sources = {};
  std::int64_t received = 0;  ///< Of the spacecraft, since the service started.
  std::int64_t rejected = 0;  ///< Of those.
  /// Publishes results of the spacecraft, too; empty: none does.
  std::optional<std::string> other_service = {};
  double backlog_s = 0.0;  ///< How long the oldest sample waits to be committed.
  bool write_failed = false;
  std::optional<double> free_gib = {};             ///< At the archive; empty: nobody knows.
  double clock_step_s = 0.0;                       ///< Of the wall clock, since the state before.
  std::map<std::string, TaiTime> data_until = {};  ///< By what they are; "orbit".
};

/// Of one spacecraft; what concerns the whole service is raised for each.
class ServiceConditions {
 public:
  ServiceConditions(const AlertLimits& limits, std::optional<Contact> contact);

  ConditionChanges see(const ServiceState& state);

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
  ConditionWatch backlog_;
  ConditionWatch write_;
  ConditionWatch disk_;
  ConditionWatch clock_;
  RiseOfLastMinute received_count_;
  RiseOfLastMinute rejected_count_;
  std::map<std::string, Source> sources_;
  std::map<std::string, ConditionWatch> outdated_;
};

}  // namespace spindrift
