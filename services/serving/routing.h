/// @file
/// Routes received samples to the archive and then to the computing side.

#pragma once

#include <vector>

#include "pipelines/core/expected.h"
#include "services/archive/archive.h"
#include "services/base/bounded_queue.h"
#include "services/ingest/rehearsal_clocks.h"
#include "services/processor/problems.h"
#include "services/processor/processor.h"
#include "services/serving/computing.h"
#include "services/serving/link_watch.h"
#include "services/serving/session_watch.h"
#include "services/telemetry/sample_batch.h"

namespace spindrift {

struct Heard {
  LinkWatch links;
  SessionWatch sessions;
  SilenceWatch silences;  ///< Used by the thread of `route` only.
};

/// Returns the present moment. It contains the host's clock only when the telemetry is live,
/// because the clock says nothing about recorded samples, and those that rehearsals tell.
Moment moment_of(const Processor& processor, const RehearsalClocks& clocks);

/// Leaves `again` to the backlog first. Then passes received batches to the archive and on to be
/// computed, until `taken` is closed and empty or the archive refuses a batch.
Expected<void> route(std::vector<PassInput> again, BoundedQueue<SampleBatch>& taken,
                     Processor& processor, const RehearsalClocks& clocks, Archive& archive,
                     Computing& computing, Heard& heard, Problems& problems);

}  // namespace spindrift
