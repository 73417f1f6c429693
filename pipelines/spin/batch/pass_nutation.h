/// @file
/// Searches free nutation in each stretch of a pass, in the residuals of uniform spin, and reduces
/// the information of the edges by the unknowns of the nutation.

#pragma once

#include <optional>
#include <span>
#include <vector>

#include "pipelines/spin/batch/pass_information.h"
#include "pipelines/spin/batch/pass_model.h"
#include "pipelines/spin/nutation/nutation.h"
#include "pipelines/spin/nutation/tilt_signal.h"

namespace spindrift {

/// Returns residuals of the edges within 30 sigmas of their prediction, or within 30 times the
/// observed scatter, because nutation moves edges by several sigmas.
std::vector<UniformSpinResidual> uniform_spin_residuals(const PassModel& model,
                                                        std::span<const PassEdge> edges,
                                                        const SpinState& state);

/// Returns the robust standard deviation of the residuals in sigmas, at least 1.
double scatter_of(std::span<const UniformSpinResidual> residuals);

struct PassNutation {
  std::vector<NutationStretch> stretches;  ///< Starting values of a fit.
  /// Search of the last stretch with nutation, or of the last stretch of the pass if there is none.
  /// Empty when the edges are too few to search.
  std::optional<NutationSearch> last;
};

/// @param edges Edges in order of time.
/// @param state Best state without nutation; any nutation in it is ignored.
PassNutation find_pass_nutation(const PassModel& model, std::span<const PassEdge> edges,
                                SpinState state);

/// Returns half-angle, growth, period and lean of the fitted stretch, with the sigmas of the
/// search.
FoundNutation as_fitted(const FoundNutation& found, const PassModel& model, const SpinState& state);

/// Returns the information on motion and biases when the nutation of each stretch is unknown.
/// @param information Information at the same state with known nutation.
PassInformation less_nutation(PassInformation information, const PassModel& model,
                              std::span<const PassEdge> edges, const SpinState& state);

}  // namespace spindrift
