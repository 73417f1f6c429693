#include "pipelines/three_axis/carried_directions.h"

#include <fmt/format.h>

#include <algorithm>
#include <cmath>
#include <cstddef>

#include "pipelines/frames/rotation_vector.h"
#include "pipelines/frames/shortest_turn.h"
#include "pipelines/observation/innovation_gate.h"
#include "pipelines/time/time_span.h"

namespace spindrift {
namespace {

/// Each direction gives two numbers; the attitude uses up three of them.
int freedom_of(std::size_t directions) { return 2 * static_cast<int>(directions) - 3; }

}  // namespace

void CarriedDirections::add(const SeenDirection& seen, const Eigen::Vector3d& rate_body_rad_s) {
  std::erase_if(directions_, [&](const Carried& carried) { return carried.kind == seen.kind; });
  const auto place = std::find_if(directions_.begin(), directions_.end(),
                                  [&](const Carried& carried) { return carried.kind > seen.kind; });
  const Eigen::Vector3d body = seen.direction.ref.norm() * seen.direction.body.normalized();
  directions_.insert(place, {.kind = seen.kind,
                             .t = seen.t,
                             .direction = seen.direction,
                             .per_error = -direction_per_error(seen.kind, body, rate_body_rad_s),
                             .error = {}});
}

void CarriedDirections::turn(TaiTime t, const Eigen::Vector3d& turned_rad, const CarryError& error,
                             double longest_s) {
  std::erase_if(directions_,
                [&](const Carried& carried) { return elapsed_s(carried.t, t) > longest_s; });
  const Eigen::Quaterniond back = quaternion_by(-turned_rad);
  for (Carried& carried : directions_) {
    carried.direction.body = back * carried.direction.body;
    carried.per_error =
        turned(carried.per_error, turned_rad, back.toRotationMatrix(), right_jacobian(turned_rad));
    carried.error.add(error);
  }
}

Expected<SensitiveAttitude> CarriedDirections::attitude() const {
  std::vector<ObservedDirection> directions;
  for (const Carried& carried : directions_) {
    directions.push_back(carried.direction);
    double& sigma_rad = directions.back().sigma_rad;
    sigma_rad = std::hypot(sigma_rad, std::sqrt(carried.error.variance_rad2()));
  }
  return q_method(directions)
      .and_then([&](const UncertainAttitude& attitude) -> Expected<SensitiveAttitude> {
        const Fit fit = fit_of(attitude, directions);
        const double misfit = fit.squares - fit.by_errors.explained(alignment_);
        if (misfit > innovation_gate(freedom_of(directions.size()))) {
          return Unexpected{{ErrorCode::Unobservable,
                             fmt::format("{} directions contradict each other: chi-square {:.3g}",
                                         directions.size(), misfit)}};
        }
        return SensitiveAttitude{attitude, fit.per_error};
      });
}

/// The attitude is the mean of what the directions say, weighted by their information.
CarriedDirections::Fit CarriedDirections::fit_of(
    const UncertainAttitude& attitude, const std::vector<ObservedDirection>& directions) const {
  Fit fit;
  TurnPerError weighted = TurnPerError::Zero();
  for (std::size_t i = 0; i < directions.size(); ++i) {
    const ObservedDirection& direction = directions[i];
    const TurnPerError& per_error = directions_[i].per_error;
    const Eigen::Vector3d off_rad = rotation_vector_of(
        shortest_turn(direction.body, attitude.q_ref_body.conjugate() * direction.ref));
    const TurnPerError one = information_of(direction) * per_error;
    weighted += one;
    fit.squares += off_rad.squaredNorm() / (direction.sigma_rad * direction.sigma_rad);
    fit.by_errors.own += per_error.transpose() * one;
    fit.by_errors.score -= one.transpose() * off_rad;
  }
  fit.per_error = attitude.covariance_rad2 * weighted;
  fit.by_errors.own -= weighted.transpose() * fit.per_error;
  return fit;
}

}  // namespace spindrift
