/// @file
/// Builds samples of one kind in the form in which the services hold them.

#pragma once

#include <utility>
#include <vector>

#include "services/telemetry/sample_batch.h"

namespace spindrift::testing {

template <class Value>
SampleBatch batch_of_samples(std::vector<TelemetrySample<Value>> samples) {
  SampleBatch batch;
  batch.samples.of<Value>() = std::move(samples);
  return batch;
}

}  // namespace spindrift::testing
