#include "pipelines/three_axis/carried_directions.h"

#include <fmt/format.h>

#include <algorithm>
#include <cmath>
#include <cstddef>

#include "pipelines/frames/celestial.h"
#include "pipelines/frames/rotation_vector.h"
#include "pipelines/observation/innovation_gate.h"
#include "pipelines/time/time_span.h"

namespace spindrift {
namespace {

/// Returns the chi-square of the misfits.
double misfit_of(const std::vector<ObservedDirection>& directions,
                 const Eigen::Quaterniond& q_ref_body) {
  double squares = 0.0;
  for (const ObservedDirection& direction : directions) {
    const double off_rad = angle_between_rad(q_ref_body * direction.body, direction.ref);
    squares += off_rad * off_rad / (direction.sigma_rad * direction.sigma_rad);
  }
  return squares;
}

/// Each direction gives two numbers; the attitude uses up three of them.
int freedom_of(std::size_t directions) { return 2 * static_cast<int>(directions) - 3; }

}  // namespace

void CarriedDirections::add(SampleKind kind, TaiTime t, const ObservedDirection& direction) {
  std::erase_if(directions_, [kind](const Carried& carried) { return carried.kind == kind; });
  const auto place = std::find_if(directions_.begin(), directions_.end(),
                                  [kind](const Carried& carried) { return carried.kind > kind; });
  directions_.insert(place, {.kind = kind, .t = t, .direction = direction, .error = {}});
}

void CarriedDirections::turn(TaiTime t, const Eigen::Vector3d& turned_rad, const CarryError& error,
                             double longest_s) {
  std::erase_if(directions_,
                [&](const Carried& carried) { return elapsed_s(carried.t, t) > longest_s; });
  for (Carried& carried : directions_) {
    carried.direction.body = quaternion_by(-turned_rad) * carried.direction.body;
    carried.error.add(error);
  }
}

Expected<UncertainAttitude> CarriedDirections::attitude() const {
  std::vector<ObservedDirection> directions;
  for (const Carried& carried : directions_) {
    directions.push_back(carried.direction);
    double& sigma_rad = directions.back().sigma_rad;
    sigma_rad = std::hypot(sigma_rad, std::sqrt(carried.error.variance_rad2()));
  }
  return q_method(directions)
      .and_then([&](const UncertainAttitude& attitude) -> Expected<UncertainAttitude> {
        const double misfit = misfit_of(directions, attitude.q_ref_body);
        if (misfit > innovation_gate(freedom_of(directions.size()))) {
          return Unexpected{{ErrorCode::Unobservable,
                             fmt::format("{} directions contradict each other: chi-square {:.3g}",
                                         directions.size(), misfit)}};
        }
        return attitude;
      });
}

}  // namespace spindrift
