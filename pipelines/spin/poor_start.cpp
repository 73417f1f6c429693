#include "pipelines/spin/poor_start.h"

#include <cmath>
#include <numbers>

#include "pipelines/frames/celestial.h"

namespace spindrift {
namespace {

// Across less, edges are linear.
constexpr double kPoor_rad = 1.0 * std::numbers::pi / 180.0;
// So far from it, it is confirmed in its turn by nineteen of twenty that are right.
constexpr double kSigmas = 2.0;

}  // namespace

void PoorStart::begin(const StartingPoint& point) {
  const bool poor = point.covariance_rad2.trace() > kPoor_rad * kPoor_rad;
  fixes_ = poor ? std::optional{MeanAxis{}} : std::nullopt;
}

void PoorStart::note(const SpinFix& fix, const StartingPoint& followed) {
  if (!fixes_ || !fix.accepted || fix.grazing) {
    return;
  }
  fixes_->add(fix);
  const double mean_rad2 = fixes_->covariance_rad2().trace() * fixes_->excess_scatter();
  const double sigma_rad = std::sqrt(mean_rad2 + followed.covariance_rad2.trace());
  if (mean_rad2 < kPoor_rad * kPoor_rad &&
      angle_between_rad(fixes_->axis_icrf(), followed.axis_icrf) < kSigmas * sigma_rad) {
    fixes_.reset();
  }
}

}  // namespace spindrift
