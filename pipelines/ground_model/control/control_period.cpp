#include "pipelines/ground_model/control/control_period.h"

#include <fmt/format.h>

namespace spindrift {

Expected<void> check_control_period(double period_s, double frequency_rad_s) {
  // Written so that NaN fails.
  if (!(period_s > 0.0)) {
    return Unexpected{{ErrorCode::InvalidConfiguration,
                       fmt::format("a control period of {} s: must be above 0", period_s)}};
  }
  if (!(period_s * frequency_rad_s <= kMostOfPeriod_rad)) {
    return Unexpected{
        {ErrorCode::InvalidConfiguration,
         fmt::format("a control period of {} s is too long for a loop of {:.4g} rad/s: must not be "
                     "above {:.4g} s",
                     period_s, frequency_rad_s, kMostOfPeriod_rad / frequency_rad_s)}};
  }
  return {};
}

}  // namespace spindrift
