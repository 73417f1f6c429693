#include "pipelines/three_axis/carried_directions.h"

#include <algorithm>
#include <cmath>

#include "pipelines/frames/rotation_vector.h"
#include "pipelines/time/time_span.h"

namespace spindrift {

void CarriedDirections::add(SampleKind kind, TaiTime t, const ObservedDirection& direction) {
  std::erase_if(directions_, [kind](const Carried& carried) { return carried.kind == kind; });
  const auto place = std::find_if(directions_.begin(), directions_.end(),
                                  [kind](const Carried& carried) { return carried.kind > kind; });
  directions_.insert(place, {.kind = kind, .t = t, .direction = direction, .error = {}});
}

void CarriedDirections::turn(TaiTime t, const Eigen::Vector3d& turned_rad,
                             const CarryError& error) {
  std::erase_if(directions_,
                [t](const Carried& carried) { return elapsed_s(carried.t, t) > kLongest_s; });
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
  return q_method(directions);
}

}  // namespace spindrift
