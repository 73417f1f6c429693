#include "pipelines/ground_model/dynamics/coarse_step.h"

#include <fmt/format.h>

namespace spindrift {

Expected<void> check_step(double step_s, double rate_rad_s) {
  // Written so that NaN fails.
  if (!(step_s > 0.0)) {
    return Unexpected{
        {ErrorCode::InvalidConfiguration, fmt::format("a step of {} s: must be above 0", step_s)}};
  }
  if (!(step_s * rate_rad_s <= kMostTurn_rad)) {
    return Unexpected{
        {ErrorCode::InvalidConfiguration,
         fmt::format("a step of {} s is too coarse for a body that turns by {:.4g} rad/s: must not "
                     "be above {:.4g} s, in which it turns by {} rad",
                     step_s, rate_rad_s, kMostTurn_rad / rate_rad_s, kMostTurn_rad)}};
  }
  return {};
}

}  // namespace spindrift
