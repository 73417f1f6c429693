/// @file
/// Whole passes, and their products picked out or as text that keeps every bit, so that two runs
/// can be compared and a difference read.

#pragma once

#include <string>
#include <variant>
#include <vector>

#include "pipelines/spin/pass/spin_pass.h"
#include "pipelines/spin/types/coded_frame.h"
#include "pipelines/spin/types/products.h"
#include "pipelines/spin/types/pulse.h"
#include "tests/support/recorded_pass.h"

namespace spindrift::testing {

std::string text_of(const SpinProduct& product);

/// Runs a whole pass, in the order given.
SpinOutput run(SpinPass pass, const std::vector<Pulse>& arrivals);
SpinOutput run(SpinPass pass, const std::vector<CodedFrame>& arrivals);
SpinOutput run(const RecordedPass& pass);

/// The products of one kind, in the order in which they arose.
template <class Product>
std::vector<Product> all_of(const SpinOutput& output) {
  std::vector<Product> found;
  for (const SpinProduct& product : output.products) {
    if (const auto* value = std::get_if<Product>(&product)) {
      found.push_back(*value);
    }
  }
  return found;
}

/// What an estimator says in the end. Throws where it has said nothing.
SpinEstimate last_estimate(const SpinOutput& output, SpinEstimator estimator);

/// Both directions of the tangent plane together.
double sigma_rad(const SpinEstimate& estimate);

/// Every product of the pass as text, in the order in which they arose.
std::vector<std::string> texts_of(const SpinOutput& output);

}  // namespace spindrift::testing
