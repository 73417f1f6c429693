/// @file
/// What the innovations of a filter say of errors of its model (a slit or a beam that is not where
/// the mission file says, the limb). They should have the mean 0: the part of such an error that
/// looks like another axis moves the axis unseen, the rest stays in the innovations. It is tested
/// as that of the angles is (model_check.h).

#pragma once

#include "pipelines/spin/mean/model_check.h"
#include "pipelines/spin/types/model_allowance.h"

namespace spindrift {

class ModelEvidence {
 public:
  /// @param edges So many were used.
  void add(const ErrorInformation& errors, double edges);

  /// The filter begins anew: what was said before has little weight.
  void fade();

  /// @param excess_noise, offsets_s2 As test_model_errors().
  ModelTest test(double excess_noise, const OffsetPrior& offsets_s2) const {
    return test_model_errors(errors_, excess_noise, offsets_s2);
  }

 private:
  double edges_ = 0.0;
  ErrorInformation errors_;
};

}  // namespace spindrift
