#include "pipelines/reconstruction/separation.h"

#include <utility>

#include "pipelines/ephemeris/orbit_frame.h"
#include "pipelines/reconstruction/reconstruct.h"

namespace spindrift {

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
