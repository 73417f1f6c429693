/// @file
/// Runs whole passes and extracts their products, also as bit-exact text, so that two runs can be
/// compared and a difference read.

#pragma once

#include <string>
#include <vector>

#include "pipelines/spin/pass/spin_pass.h"
#include "pipelines/spin/types/coded_frame.h"
#include "pipelines/spin/types/products.h"
#include "pipelines/spin/types/pulse.h"
#include "tests/support/of_kind.h"
#include "tests/support/recorded_pass.h"

namespace spindrift::testing {

std::string text_of(const SpinProduct& product);

/// Processes a whole pass; the arrivals keep their order.
SpinOutput run(SpinPass pass, const std::vector<Pulse>& arrivals);
SpinOutput run(SpinPass pass, const std::vector<CodedFrame>& arrivals);
SpinOutput run(const RecordedPass& pass);

/// Returns the products of one kind in the order of their creation.
template <class Product>
std::vector<Product> all_of(const SpinOutput& output) {
  return of_kind<Product>(output.products);
}

/// Returns the estimates of one estimator in the order of their creation.
std::vector<SpinEstimate> estimates_of(const SpinOutput& output, SpinEstimator estimator);

/// Returns the last estimate of an estimator; throws if there is none.
SpinEstimate last_estimate(const SpinOutput& output, SpinEstimator estimator);

/// Returns the sigma of the axis over both directions of its tangent plane, rad.
double sigma_rad(const SpinEstimate& estimate);

/// Returns how many of its sigmas the axis of an estimate is off.
double error_sigmas(const SpinEstimate& estimate, const Eigen::Vector3d& true_icrf);

/// Returns every product of the pass as text in the order of creation.
std::vector<std::string> texts_of(const SpinOutput& output);

}  // namespace spindrift::testing
