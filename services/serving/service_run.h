/// @file
/// What runs between "ready" and the stop of the service.

#pragma once

#include <filesystem>
#include <functional>
#include <vector>

#include "pipelines/core/expected.h"
#include "services/alerts/alert_desk.h"
#include "services/archive/archive.h"
#include "services/base/bounded_queue.h"
#include "services/bus/participant.h"
#include "services/ingest/other_services.h"
#include "services/ingest/rehearsal_clocks.h"
#include "services/mission/mission.h"
#include "services/processor/problems.h"
#include "services/processor/processor.h"
#include "services/publisher/result_publisher.h"
#include "services/serving/stop_signal.h"
#include "services/serving/thread_failures.h"
#include "services/serving/verdict_watch.h"
#include "services/telemetry/sample_batch.h"

namespace spindrift {

/// What others on the bus say beside telemetry.
struct Told {
  OtherServices others;
  RehearsalClocks clocks;
};

/// What the run works with. All of them outlive it.
struct ServiceParts {
  const std::vector<Mission>& missions;
  RunMode mode;
  std::filesystem::path db;
  const bus::Participant& participant;
  const ResultPublisher& publisher;
  Told& told;
  BoundedQueue<SampleBatch>& taken;
  Processor& processor;
  Archive& archive;
  AlertDesk& desk;
  Problems& problems;
  StopSignal& stop_signal;
  ThreadFailures& failures;
  std::function<void(const ArchiveBatch&)> announce;  ///< Alerts of the service. Must not wait.
  std::function<void(const Health&)> on_health;       ///< Must not wait.
  VerdictWatch::OnVerdict on_verdict;                 ///< Must not wait.
  std::function<Expected<void>()> on_finished;        ///< The archive has the last batch of a run.
};

/// Until a signal, or a failure, and everything taken is with the archive.
/// @param gone_on What was stored before a restart, its samples with the archive again.
Expected<void> run_service(GoneOn gone_on, const ServiceParts& parts);

}  // namespace spindrift
