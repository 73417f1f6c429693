/// @file
/// Motion of a body along its orbit, whatever turns it.

#pragma once

#include <Eigen/Core>
#include <optional>

#include "pipelines/core/expected.h"
#include "pipelines/ephemeris/earth_orientation.h"
#include "pipelines/ephemeris/orbit.h"
#include "pipelines/frames/body_state.h"
#include "pipelines/geomagnetism/main_field.h"
#include "pipelines/ground_model/control/closed_loop.h"
#include "pipelines/ground_model/dynamics/body_motion.h"
#include "pipelines/ground_model/dynamics/disturbances.h"
#include "pipelines/time/tai_time.h"

namespace spindrift {

struct BodyTruth {
  TaiTime start;
  BodyState at_start;
  Eigen::Matrix3d inertia_kg_m2;
  double end_s;  ///< Time of the end since the start.
  Disturbances disturbances = {};
  std::optional<MainFieldModel> field = std::nullopt;  ///< Field that acts on a residual dipole.
};

/// Longest integration step of a body that a law controls.
inline constexpr double kLongestStep_s = 0.05;

/// Returns an upper bound of the rate of a torque-free body, and of the frequency at which it
/// swings where its wheels hold a momentum.
double fastest_rad_s(const Eigen::Matrix3d& inertia_kg_m2, const Eigen::Vector3d& rate_body_rad_s,
                     const Eigen::Vector3d& wheels_body_nms);

double least_moment_kg_m2(const Eigen::Matrix3d& inertia_kg_m2);

/// @return InvalidConfiguration where the body now turns or swings too fast for the step of the
///         loop, or its rate is no longer finite.
Expected<void> check_now(const ClosedLoop<BodyMotion>& loop, double least_moment_kg_m2);

/// Makes a loop with steps of at most kLongestStep_s.
/// @return InvalidConfiguration for an impossible inertia, or a body too fast for the step.
Expected<ClosedLoop<BodyMotion>> loop_of(const BodyTruth& truth, const Actuators& actuators,
                                         double period_s);

/// Gives the surroundings along a flight, in order of time. Keeps references to its arguments.
class SurroundingsOnTheWay {
 public:
  SurroundingsOnTheWay(const BodyTruth& truth, const Orbit& orbit) : truth_{truth}, orbit_{orbit} {}

  /// Returns the surroundings at `t`. The field is computed anew once a second, in which the field
  /// at the spacecraft changes by a few parts in a thousand.
  /// @return NoCoverage where orbit or field do not reach.
  Expected<Surroundings> at(TaiTime t);

 private:
  const BodyTruth& truth_;
  const Orbit& orbit_;
  TurningEarth earth_;
  std::optional<TaiTime> field_of_;
  Eigen::Vector3d field_icrf_nt_ = Eigen::Vector3d::Zero();
};

/// Simulates the loop to the end of the flight.
/// @param torque_body_nm Law that returns the torque commanded for the period that begins at `t`:
///        called with `t` and the state of the spacecraft, in order of time.
/// @return Errors of SurroundingsOnTheWay; InvalidConfiguration once the step is too long.
template <class Law>
Expected<void> fly(ClosedLoop<BodyMotion>& loop, const BodyTruth& truth, const Orbit& orbit,
                   Law&& torque_body_nm) {
  SurroundingsOnTheWay on_the_way{truth, orbit};
  loop.reserve(truth.end_s);
  const double least_kg_m2 = least_moment_kg_m2(truth.inertia_kg_m2);
  while (loop.t_s() < truth.end_s) {
    const TaiTime t = shifted(truth.start, loop.t_s());
    const auto surroundings = on_the_way.at(t);
    if (!surroundings) {
      return Unexpected{surroundings.error()};
    }
    if (auto fine = check_now(loop, least_kg_m2); !fine) {
      return fine;
    }
    loop.fly(torque_body_nm(t, surroundings->spacecraft), *surroundings);
  }
  return {};
}

}  // namespace spindrift
