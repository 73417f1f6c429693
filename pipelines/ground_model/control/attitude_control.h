/// @file
/// Sequence of control modes after separation: the spacecraft drifts, damps its rates, then points.

#pragma once

#include <Eigen/Core>
#include <utility>
#include <variant>

#include "pipelines/core/expected.h"
#include "pipelines/ground_model/control/control_laws.h"

namespace spindrift {

enum class ControlMode { Drift, Damping, Pointing };

/// Times of the mode changes, in seconds after separation.
struct ControlPlan {
  double control_on_s;   ///< Start of damping.
  double damped_rad_s;   ///< Damping ends as soon as no axis turns faster,
  double pointing_at_s;  ///< or at the latest at this time.
};

using DampingLaw = std::variant<RateFeedback, RelayDamping>;
using PointingLaw = std::variant<SaturatedPd, SunAcquisition, VariableLimitPd>;

class AttitudeControl {
 public:
  /// @return InvalidConfiguration for negative or unordered times, or a negative rate.
  static Expected<AttitudeControl> make(const ControlPlan& plan, const DampingLaw& damping,
                                        const PointingLaw& pointing);

  /// Returns the torque for the period that begins at `t_s` after separation; call in order of
  /// time.
  Eigen::Vector3d torque_body_nm(double t_s, const MeasuredBody& measured);

  ControlMode mode() const { return mode_; }

 private:
  AttitudeControl(const ControlPlan& plan, DampingLaw damping, PointingLaw pointing)
      : plan_{plan}, damping_{std::move(damping)}, pointing_{std::move(pointing)} {}

  ControlPlan plan_;
  DampingLaw damping_;
  PointingLaw pointing_;
  ControlMode mode_ = ControlMode::Drift;
};

}  // namespace spindrift
