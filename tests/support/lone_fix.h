/// @file
/// Computes the fix of a single revolution without prior knowledge.

#pragma once

#include <optional>
#include <set>

#include "pipelines/spin/disambiguation/disambiguation.h"
#include "pipelines/spin/fix/axis_candidates.h"
#include "pipelines/spin/measurement/measurement.h"

namespace spindrift::testing {

/// Returns the measurements of the revolution with the quantities in `left_out` rejected.
inline RevolutionMeasurements measured_without(const SpinConfig& config,
                                               const Revolution& revolution,
                                               const std::set<SpinQuantity>& left_out) {
  RevolutionMeasurements measured = measure(config, revolution);
  for (const SpinQuantity quantity : left_out) {
    reject(measured, quantity, rejection_of(quantity));
  }
  return measured;
}

inline tl::expected<SpinFix, NoCandidates> lone_fix(const SpinConfig& config,
                                                    const Revolution& revolution,
                                                    const std::set<SpinQuantity>& left_out,
                                                    const SunEarthDirections& sun_earth) {
  const RevolutionMeasurements measured = measured_without(config, revolution, left_out);
  const auto found = axis_candidates(config, measured, sun_earth);
  if (!found) {
    return tl::unexpected{found.error()};
  }
  return Disambiguator{config}
      .settle(revolution.number, *revolution.edge(PulseChannel::Sun1), measured, sun_earth, *found,
              std::nullopt)
      .back();
}

}  // namespace spindrift::testing
