/// @file
/// A body along its orbit, whatever turns it.

#pragma once

#include <Eigen/Core>
#include <optional>

#include "pipelines/core/expected.h"
#include "pipelines/ephemeris/earth_orientation.h"
#include "pipelines/ephemeris/orbit.h"
#include "pipelines/frames/body_state.h"
#include "pipelines/geomagnetism/main_field_model.h"
#include "pipelines/ground_model/control/closed_loop.h"
#include "pipelines/ground_model/dynamics/body_motion.h"
#include "pipelines/ground_model/dynamics/disturbances.h"
#include "pipelines/time/tai_time.h"

namespace spindrift {

struct BodyTruth {
  TaiTime start;
  BodyState at_start;
  Eigen::Matrix3d inertia_kg_m2;
  double end_s;  ///< Behind the start.
  Disturbances disturbances = {};
  std::optional<MainFieldModel> field = std::nullopt;  ///< That a residual dipole feels.
};

/// No body is stepped more coarsely where a law controls it.
inline constexpr double kLongestStep_s = 0.05;

/// At most as fast a body turns without torque, and swings where its wheels hold a momentum.
double fastest_rad_s(const Eigen::Matrix3d& inertia_kg_m2, const Eigen::Vector3d& rate_body_rad_s,
                     const Eigen::Vector3d& wheels_body_nms);

double least_moment_kg_m2(const Eigen::Matrix3d& inertia_kg_m2);

/// @return InvalidConfiguration where the body now turns or swings too fast for the step of the
///         loop, or is no longer finite.
Expected<void> check_now(const ClosedLoop<BodyMotion>& loop, double least_moment_kg_m2);

/// Steps of at most kLongestStep_s.
/// @return InvalidConfiguration for a body that cannot be, or turns too fast for the step.
Expected<ClosedLoop<BodyMotion>> loop_of(const BodyTruth& truth, const Actuators& actuators,
                                         double period_s);

/// Of a flight; asked in order of time. Refers to what it is made of.
class SurroundingsOnTheWay {
 public:
  SurroundingsOnTheWay(const BodyTruth& truth, const Orbit& orbit) : truth_{truth}, orbit_{orbit} {}

  /// The field is computed anew once a second, in which the spacecraft sees it change by a few
  /// parts in a thousand.
  /// @return NoCoverage where orbit or field do not reach.
  Expected<Surroundings> at(TaiTime t);

 private:
  const BodyTruth& truth_;
  const Orbit& orbit_;
  TurningEarth earth_;
  std::optional<TaiTime> field_of_;
  Eigen::Vector3d field_icrf_nt_ = Eigen::Vector3d::Zero();
};

/// On to the end.
/// @param torque_body_nm What a law asks for in the period that begins at `t`: called with `t` and
///        where the spacecraft is, in order of time.
/// @return as SurroundingsOnTheWay; InvalidConfiguration once the body turns too fast for the step.
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
