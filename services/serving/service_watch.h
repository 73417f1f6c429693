/// @file
/// Gathers once a second what the conditions of the service are checked against.

#pragma once

#include <chrono>
#include <cstdint>
#include <filesystem>
#include <map>
#include <optional>
#include <string>
#include <vector>

#include "pipelines/supervision/service_conditions.h"
#include "services/archive/archive.h"
#include "services/ingest/other_services.h"
#include "services/ingest/rehearsal_clocks.h"
#include "services/ingest/telemetry_subscriber.h"
#include "services/mission/mission.h"
#include "services/serving/backlog_watch.h"
#include "services/serving/link_watch.h"
#include "services/serving/session_watch.h"

namespace spindrift {

class ServiceWatch {
 public:
  /// The parts to look at. All but the missions must outlive the watch.
  struct Watched {
    const std::vector<Mission>& missions;
    RunMode mode;
    std::filesystem::path db;
    const Archive& archive;
    const BoundedQueue<SampleBatch>& taken;
    const LinkWatch& links;
    const SessionWatch& sessions;
    OtherServices& others;
    RehearsalClocks& clocks;
  };

  explicit ServiceWatch(const Watched& watched);

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
  void note_link(const SpacecraftHealth& link, ServiceState& state) const;

  Watched watched_;
  BacklogWatch backlog_;
  /// End of validity of auxiliary data, by spacecraft and kind of data.
  std::map<std::string, std::map<std::string, TaiTime>> data_until_;
  std::optional<Instant> last_;
  TaiTime wall_ = {};
  TaiTime t_ = {};
  double clock_step_s_ = 0.0;
  std::uint64_t failures_ = 0;
};

}  // namespace spindrift
