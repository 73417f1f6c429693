#include "pipelines/reconstruction/separation.h"

#include <fmt/format.h>

#include <utility>

#include "pipelines/reconstruction/methods.h"
#include "pipelines/reconstruction/observations.h"
#include "pipelines/statistics/distributions.h"

namespace spindrift {
namespace {

Expected<Eigen::Quaterniond> q_icrf_body_of(const InOrbitFrame& told, TaiTime t,
                                            const std::optional<Orbit>& orbit) {
  if (!orbit) {
    return Unexpected{{ErrorCode::Unobservable,
                       "the launcher's attitude is told in the orbit frame, and no orbit is known: "
                       "name one in [orbit] of the mission file"}};
  }
  return orbit->at(t).and_then(orbit_frame).map([&](const Eigen::Quaterniond& q_icrf_orbit) {
    return Eigen::Quaterniond{q_icrf_orbit * quaternion_of(told.angles)};
  });
}

Expected<Eigen::Quaterniond> q_icrf_body_of(const InLaunchFrame& told, TaiTime /*t*/,
                                            const std::optional<Orbit>& /*orbit*/) {
  return Eigen::Quaterniond{launch_frame(told.launch) * quaternion_of(told.angles)};
}

}  // namespace

Expected<Reconstruction> reconstruct(const ReconstructionRequest& request,
                                     ReconstructionMethod method) {
  const auto all = observations_of(request);
  if (!all) {
    return Unexpected{all.error()};
  }
  return method == ReconstructionMethod::Batch ? reconstruct_batch(request, *all)
                                               : reconstruct_sequential(request, *all);
}

Expected<LauncherCheck> launcher_check(const LauncherAttitude& launcher,
                                       const ReconstructedAttitude& separation,
                                       const std::optional<Orbit>& orbit) {
  if (!(launcher.sigma_rad > 0.0)) {
    return Unexpected{
        {ErrorCode::InvalidConfiguration,
         fmt::format("the sigma of the launcher's attitude is {} rad: must be above 0",
                     launcher.sigma_rad)}};
  }
  const auto q_icrf_body = std::visit(
      [&](const auto& told) { return q_icrf_body_of(told, separation.t, orbit); }, launcher.told);
  if (!q_icrf_body) {
    return Unexpected{q_icrf_body.error()};
  }
  const double variance_rad2 = launcher.sigma_rad * launcher.sigma_rad;
  return attitude_difference({*q_icrf_body, variance_rad2 * Eigen::Matrix3d::Identity()},
                             {separation.q_icrf_body, separation.covariance_rad2})
      .map([&](const AttitudeDifference& difference) {
        return LauncherCheck{.q_icrf_body = *q_icrf_body,
                             .difference = difference,
                             .chance = chi_square_tail(difference.chi_square, 3.0)};
      });
}

ReconstructedSeparation separation_of(Reconstruction solution, const std::optional<Orbit>& orbit,
                                      const std::optional<LauncherAttitude>& launcher) {
  ReconstructedSeparation separation{
      .solution = std::move(solution), .in_orbit_frame = {}, .launcher = std::nullopt};
  if (orbit) {
    for (const ReconstructedEvent& event : separation.solution.events) {
      separation.in_orbit_frame.push_back(orbit->at(event.attitude.t)
                                              .and_then(orbit_frame)
                                              .map([&](const Eigen::Quaterniond& q_icrf_orbit) {
                                                return euler312_of(q_icrf_orbit.conjugate() *
                                                                   event.attitude.q_icrf_body);
                                              }));
    }
  }
  if (launcher) {
    separation.launcher = launcher_check(
        *launcher, find(separation.solution, SeparationEvent::Separation)->attitude, orbit);
  }
  return separation;
}

Expected<ReconstructedSeparation> reconstruct_separation(
    const ReconstructionRequest& request, ReconstructionMethod method,
    const std::optional<LauncherAttitude>& launcher) {
  return reconstruct(request, method).map([&](Reconstruction&& solution) {
    auto separation = separation_of(std::move(solution), orbit_of(request), launcher);
    separation.samples = sample_count(request);
    return separation;
  });
}

}  // namespace spindrift
