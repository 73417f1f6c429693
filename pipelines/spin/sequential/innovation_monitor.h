/// @file
/// Test of the filter's normalised innovations, which should have mean 0 and variance 1 (NIS).
///
/// More variance is more noise than stated. A mean is a model error (a slit or a beam that is not
/// where the mission file says, the limb): the part of it that looks like another axis moves the
/// axis unseen, the rest stays in the innovations.
///
/// It is tested as that of the angles is (model_check.h).

#pragma once

#include "pipelines/spin/mean/model_check.h"
#include "pipelines/spin/sequential/spin_filter.h"
#include "pipelines/spin/types/model_allowance.h"

namespace spindrift {

class InnovationMonitor {
 public:
  void note(const EdgeStatistics& tally);

  /// Gives the past little weight: a filter begins anew.
  void fade();

  /// Discards the transient after the start, which is no noise.
  void discard_transient();

  /// How many times the variance of the edges is what their stated noise makes it, where that is
  /// significantly more than 1; else 1.
  double excess_noise() const;

  /// @param offsets_s2 As test_model_errors().
  ModelTest verdict(const OffsetPrior& offsets_s2 = OffsetPrior::Zero()) const {
    return test_model_errors(errors_, excess_noise(), 0.0, offsets_s2);
  }

 private:
  double edges_ = 0.0;  ///< So many speak in the following two.
  double squared_innovation_ = 1.0;
  double gated_share_ = 0.0;
  double error_edges_ = 0.0;  ///< So many speak in the following.
  ErrorInformation errors_;
};

}  // namespace spindrift
