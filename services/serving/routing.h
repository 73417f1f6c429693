/// @file
/// The way of what is taken: to the archive, and on to be computed.

#pragma once

#include <vector>

#include "pipelines/core/expected.h"
#include "services/archive/archive.h"
#include "services/base/bounded_queue.h"
#include "services/processor/problems.h"
#include "services/processor/processor.h"
#include "services/serving/computing.h"
#include "services/serving/link_watch.h"
#include "services/serving/session_watch.h"
#include "services/telemetry/sample_batch.h"

namespace spindrift {

/// What came, for those who watch the link.
struct Heard {
  LinkWatch links;
  SessionWatch sessions;
};

/// Now. The clock of the host says something of samples of now only.
Moment moment_of(const Processor& processor);

/// First `again`. Then hands what is taken to the archive and on to be computed, until `taken` is
/// closed and empty, or the archive refuses.
Expected<void> route(std::vector<PassInput> again, BoundedQueue<SampleBatch>& taken,
                     Processor& processor, Archive& archive, Computing& computing, Heard& heard,
                     Problems& problems);

}  // namespace spindrift
