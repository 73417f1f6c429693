/// @file
/// What the spacecraft does behind separation: it drifts, damps its rates, then points.

#pragma once

#include <Eigen/Core>
#include <utility>
#include <variant>

#include "pipelines/core/expected.h"
#include "pipelines/ground_model/control/control_laws.h"

namespace spindrift {

enum class ControlMode { Drift, Damping, Pointing };

/// Seconds behind separation.
struct ControlPlan {
  double control_on_s;   ///< Damping begins.
  double damped_rad_s;   ///< It ends as soon as no axis turns faster,
  double pointing_at_s;  ///< or at the latest now.
};

using DampingLaw = std::variant<RateFeedback, RelayDamping>;
using PointingLaw = std::variant<SaturatedPd, SunAcquisition, VariableLimitPd>;

class AttitudeControl {
 public:
  /// @return InvalidConfiguration where times are negative or out of order, or the rate is
  /// negative.
  static Expected<AttitudeControl> make(const ControlPlan& plan, const DampingLaw& damping,
                                        const PointingLaw& pointing);

  /// What is asked for in the period that begins at `t_s`, behind separation; in order of time.
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
