/// @file
/// Products as text that keeps every bit, so that two runs can be compared and a difference read.

#pragma once

#include <string>
#include <vector>

#include "pipelines/spin/pulse.h"
#include "pipelines/spin/spin_pass.h"

namespace spindrift::testing {

std::string text_of(const SpinProduct& product);

/// Runs a whole pass, in the order given.
SpinOutput run(SpinPass pass, const std::vector<Pulse>& arrivals);

/// Every product of the pass as text, in the order in which they arose.
std::vector<std::string> texts_of(const SpinOutput& output);

}  // namespace spindrift::testing
