#include "pipelines/spin/batch/axis_choice.h"

#include "pipelines/frames/celestial.h"
#include "pipelines/spin/batch/multi_start.h"

namespace spindrift {
namespace {

std::optional<OtherAxis> other_axis(const Solved& solved,
                                    const std::optional<AxisChoice>& of_pass) {
  if (solved.of.other || !of_pass || !of_pass->other_icrf) {
    return solved.of.other;
  }
  return compared_with(solved.of.best, solved.model, solved.edges, *of_pass->other_icrf);
}

/// Returns whether the solution's axis is the one that the pass had settled on.
bool follows(const Eigen::Vector3d& axis_icrf, const std::optional<OtherAxis>& other,
             const AxisChoice& of_pass) {
  return of_pass.settled_by != SettledBy::Nothing &&
         (!other || angle_between_rad(of_pass.axis_icrf, axis_icrf) <
                        angle_between_rad(of_pass.axis_icrf, other->axis_icrf));
}

}  // namespace

AxisChoice axis_choice(const Solved& solved, const std::optional<AxisChoice>& of_pass) {
  const auto other = other_axis(solved, of_pass);
  AxisChoice choice{.t = solved.edges.back().pulse.t,
                    .estimator = SpinEstimator::Batch,
                    .axis_icrf = solved.of.best.fit.state.axis_icrf(),
                    .other_icrf = {},
                    .delta_chi_square = {},
                    .settled_by = SettledBy::Edges};
  if (other) {
    choice.other_icrf = other->axis_icrf;
    choice.delta_chi_square = other->more_misfit;
  }
  if (solved.of.alternate_axis_icrf) {
    choice.settled_by = SettledBy::Nothing;
  } else if (solved.of.by_prior) {
    choice.settled_by = SettledBy::Prior;
  } else if (of_pass && follows(choice.axis_icrf, other, *of_pass)) {
    choice.settled_by = of_pass->settled_by;
  }
  return choice;
}

}  // namespace spindrift
