/// @file
/// Accumulates evidence of model errors (misplaced slits or beams, limb altitude) from innovations.
/// Innovations should have zero mean. The part of a model error that looks like another axis moves
/// the axis unseen; the rest stays in the innovations and is tested as in model_check.h.

#pragma once

#include "pipelines/spin/mean/model_check.h"
#include "pipelines/spin/types/model_allowance.h"

namespace spindrift {

class ModelEvidence {
 public:
  /// @param edges Number of edges used.
  void add(const ErrorInformation& errors, double edges);

  /// Reduces the weight of earlier evidence when the filter restarts.
  void fade();

  /// @param excess_noise, offsets_s2 Arguments of test_model_errors().
  ModelTest test(double excess_noise, const OffsetPrior& offsets_s2) const {
    return test_model_errors(errors_, excess_noise, offsets_s2);
  }

 private:
  double edges_ = 0.0;
  ErrorInformation errors_;
};

}  // namespace spindrift
