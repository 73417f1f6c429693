/// @file
/// Whether the edges are what the filter takes them for: normalised innovations of variance 1 and
/// mean 0.
///
/// More variance is more noise than stated. A mean is an error of the model (a slit or a beam that
/// is not where the mission says, the limb): what the axis can take up of it moves the axis and is
/// not seen, the rest stays in the innovations for ever. What they say of the errors is judged as
/// that of the angles is (model_check.h).

#pragma once

#include "pipelines/spin/mean/model_check.h"
#include "pipelines/spin/sequential/spin_filter.h"
#include "pipelines/spin/types/model_allowance.h"

namespace spindrift {

class InnovationWatch {
 public:
  void note(const EdgeTally& tally);

  /// What was seen so far shall weigh little beside what comes: a filter begins anew.
  void fade();

  /// The filter has come from its start to where its edges fit: what that took is no noise.
  void forget_the_start();

  /// How many times the variance of the edges is what their stated noise makes it, where that is
  /// significantly more than 1; else 1.
  double excess_noise() const;

  ModelVerdict verdict() const { return verdict_on(errors_, excess_noise(), 0.0); }

 private:
  double edges_ = 0.0;  ///< So many speak in the following two.
  double squared_innovation_ = 1.0;
  double gated_share_ = 0.0;
  double error_edges_ = 0.0;  ///< So many speak in the following.
  ErrorInformation errors_;
};

}  // namespace spindrift
