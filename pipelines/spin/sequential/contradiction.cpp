#include "pipelines/spin/sequential/contradiction.h"

#include <algorithm>
#include <cmath>

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

}  // namespace

void Contradiction::note(const Hypotheses& followed, const StartingPoints::Known& said) {
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
  mean_.add(nearest.axis_icrf, nearest.covariance_rad2);
}

bool Contradiction::stands(const Hypotheses& followed, bool edges_doubt) const {
  const Weight& needed = edges_doubt ? kWhereEdgesDoubt : kFixesAlone;
  if (against_ < needed.fixes) {
    return false;
  }
  const double mean_rad2 = mean_.covariance_rad2().trace() * mean_.excess_scatter();
  return std::all_of(followed.all().begin(), followed.all().end(), [&](const Hypothesis& one) {
    const double sigma_rad = std::sqrt(mean_rad2 + one.filter.axis_covariance_rad2().trace());
    return angle_between_rad(mean_.axis_icrf(), one.filter.axis_icrf()) >
           std::hypot(needed.sigmas * sigma_rad, kModelLimit_rad);
  });
}

}  // namespace spindrift
