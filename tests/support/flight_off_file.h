/// @file
/// Separations whose sensors, inertia and time tags are not quite as the mission file says.

#pragma once

#include <Eigen/Core>
#include <cstdint>

#include "pipelines/three_axis/alignment.h"
#include "tests/support/separation_flight.h"

namespace spindrift::testing {

using AlignmentErrors = Eigen::Matrix<double, kAttitudeAlignmentErrors, 1>;

/// Returns the standard deviations that a mission file has without a word about them.
AlignmentErrors usual_sigmas();

/// Returns independent errors with these standard deviations.
AlignmentErrors drawn_errors(const AlignmentErrors& sigmas, std::uint64_t seed);

/// Makes the telemetry that of sensors with these errors, and the inertia of the mission file wrong
/// by its errors; the mission file states the sigmas.
void put_off(SeparationFlight& flight, const AlignmentErrors& errors,
             const AlignmentErrors& stated_sigmas);

/// Reconstructs flights with errors drawn from what their mission files state, by both methods, and
/// expects normalised squared errors of T1 within the band, no answer that nothing speaks against
/// beyond 5 sigmas, and as few doubtful ones as of the same flights with exact mission files.
/// @param least, most Band of chi-square with three degrees of freedom for each flight.
void expect_total_sigma(const FlightPlan& plan, int flights, double least, double most);

}  // namespace spindrift::testing
