#include "pipelines/spin/sequential/contradiction.h"

#include <algorithm>
#include <cmath>

#include "pipelines/frames/angle.h"
#include "pipelines/frames/celestial.h"
#include "pipelines/spin/types/model_allowance.h"
#include "pipelines/statistics/significance.h"

namespace spindrift {
namespace {

struct Weight {
  int fixes;
  double sigmas;
};
constexpr Weight kWhereEdgesDoubt{.fixes = 10, .sigmas = kContradictionSigmas};
// Without doubt by the edges more is needed, as single fixes may all be off to one side.
constexpr Weight kFixesAlone{.fixes = 30, .sigmas = 8.0};

// Within this angle edges are linear.
constexpr double kPoor_rad = kRadPerDeg;

}  // namespace

void StartConfirmation::begin(const StartingPoint& point) {
  const bool poor = point.covariance_rad2.trace() > kPoor_rad * kPoor_rad;
  fixes_ = poor ? std::optional{MeanAxis{}} : std::nullopt;
}

void StartConfirmation::add_fix(const SpinFix& fix, const StartingPoint& followed) {
  if (!fixes_ || !fix.accepted || fix.near_tangent) {
    return;
  }
  fixes_->add_fix(fix);
  const double mean_rad2 = fixes_->covariance_rad2().trace() * fixes_->excess_scatter();
  const double sigma_rad = std::hypot(kPoor_rad, std::sqrt(followed.covariance_rad2.trace()));
  // Limit in sigmas of a mean known to a degree. A better mean is not tested more strictly, as
  // fixes lie to one side when noise suppresses some of them.
  if (mean_rad2 < kPoor_rad * kPoor_rad &&
      angle_between_rad(fixes_->axis_icrf(), followed.axis_icrf) < 1.5 * sigma_rad) {
    fixes_.reset();
  }
}

void Contradiction::count_fix(const Hypotheses& followed, const StartingPoints::Known& said) {
  const bool against =
      std::all_of(said.points.begin(), said.points.end(),
                  [&](const StartingPoint& point) { return followed.contradicted_by(point); });
  against_ = std::max(0, against_ + (against ? said.fixes : -said.fixes));
  if (against_ == 0) {
    mean_ = {};
    return;
  }
  const Eigen::Vector3d axis_icrf = followed.published().filter.axis_icrf();
  const StartingPoint& nearest = *std::max_element(
      said.points.begin(), said.points.end(), [&](const StartingPoint& a, const StartingPoint& b) {
        return a.axis_icrf.dot(axis_icrf) < b.axis_icrf.dot(axis_icrf);
      });
  mean_.add_fix(nearest.axis_icrf, nearest.covariance_rad2, nearest.alignment_rad2);
}

bool Contradiction::stands(const Hypotheses& followed, bool edges_doubt) const {
  const Weight& needed = edges_doubt ? kWhereEdgesDoubt : kFixesAlone;
  if (against_ < needed.fixes) {
    return false;
  }
  const double mean_rad2 =
      mean_.covariance_rad2().trace() * mean_.excess_scatter() + mean_.alignment_rad2().trace();
  return std::all_of(followed.all().begin(), followed.all().end(), [&](const Hypothesis& one) {
    const double sigma_rad = std::sqrt(mean_rad2 + one.filter.total_covariance_rad2().trace());
    return angle_between_rad(mean_.axis_icrf(), one.filter.axis_icrf()) >
           std::hypot(needed.sigmas * sigma_rad, kModelLimit_rad);
  });
}

}  // namespace spindrift
