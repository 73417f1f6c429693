/// @file
/// Runs the service between "ready" and its stop.

#pragma once

#include <filesystem>
#include <functional>
#include <vector>

#include "pipelines/core/expected.h"
#include "services/alerts/alert_desk.h"
#include "services/archive/archive.h"
#include "services/base/bell.h"
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

class Webhook;

struct Told {
  OtherServices others;
  RehearsalClocks clocks;
};

/// The parts that the service works with. All must outlive the run.
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
  const Webhook* webhook;  ///< Null when alerts are sent nowhere.
  Problems& problems;
  StopSignal& stop_signal;
  ThreadFailures& failures;
  Bell& new_answers;  ///< Rung when results have been announced, answers among them.
  /// Called with alerts of the service. Must not wait.
  std::function<void(const ArchiveBatch&)> announce;
  std::function<void(const Health&)> on_health;  ///< The function must not wait.
  VerdictWatch::OnVerdict on_verdict;            ///< The function must not wait.
  /// Called when the last batch of the runs is submitted.
  std::function<Expected<void>()> on_finished;
};

/// Runs until a signal or a failure, and until everything received has been submitted to the
/// archive. @param gone_on What was stored before a restart; the archive has its batches already.
Expected<void> run_service(GoneOn gone_on, const ServiceParts& parts);

}  // namespace spindrift
