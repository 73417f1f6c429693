#include "pipelines/spin/sequential/start_confirmation.h"

#include <cmath>

#include "pipelines/frames/angle.h"
#include "pipelines/frames/celestial.h"

namespace spindrift {
namespace {

// Within this angle edges are linear.
constexpr double kPoor_rad = kRadPerDeg;
// Limit in sigmas of a mean known to a degree. A better mean is not tested more strictly, as fixes
// lie to one side when noise suppresses some of them.
constexpr double kSigmas = 1.5;

}  // namespace

void StartConfirmation::begin(const StartingPoint& point) {
  const bool poor = point.covariance_rad2.trace() > kPoor_rad * kPoor_rad;
  fixes_ = poor ? std::optional{MeanAxis{}} : std::nullopt;
}

void StartConfirmation::note(const SpinFix& fix, const StartingPoint& followed) {
  if (!fixes_ || !fix.accepted || fix.near_tangent) {
    return;
  }
  fixes_->add(fix);
  const double mean_rad2 = fixes_->covariance_rad2().trace() * fixes_->excess_scatter();
  const double sigma_rad = std::hypot(kPoor_rad, std::sqrt(followed.covariance_rad2.trace()));
  if (mean_rad2 < kPoor_rad * kPoor_rad &&
      angle_between_rad(fixes_->axis_icrf(), followed.axis_icrf) < kSigmas * sigma_rad) {
    fixes_.reset();
  }
}

}  // namespace spindrift
