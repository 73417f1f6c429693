/// @file
/// The four gates of a three-axis spacecraft (observation/gate.h), fed in order of time:
///     lost     angle of the measured field to that expected at the nominal attitude
///     usable   innovation of the field in the filter in force
///     safe     what a bank of filters says of its winner
///     reached  angle of the attitude in force to the nominal one
///
/// Without a nominal attitude there is neither `lost` nor `reached`. A turn about the field is seen
/// by neither magnetometer nor lost gate. The angle of the Sun is counted by the same rule: if both
/// say that the body is lost, it is certain, since one wrong sensor cannot cause that.

#pragma once

#include <Eigen/Core>
#include <Eigen/Geometry>
#include <array>
#include <cstddef>
#include <deque>
#include <optional>
#include <utility>
#include <vector>

#include "pipelines/core/expected.h"
#include "pipelines/ephemeris/orbit_state.h"
#include "pipelines/frames/angle.h"
#include "pipelines/observation/gate.h"
#include "pipelines/observation/observation.h"
#include "pipelines/three_axis/config.h"
#include "pipelines/three_axis/products.h"
#include "pipelines/time/tai_time.h"

namespace spindrift {

/// Returns the nominal attitude at a place of the orbit.
/// @param spacecraft Not needed for an attitude in ICRF.
/// @return An error where the orbit frame is unknown.
Expected<Eigen::Quaterniond> q_icrf_nominal(const NominalAttitude& nominal,
                                            const Expected<OrbitState>& spacecraft);

/// What a bank of filters says of its winner after one measured field.
struct WinnerReading {
  TaiTime t;
  double nis;        ///< Normalised innovation squared, of three degrees of freedom.
  double sigma_rad;  ///< Sigma that the winner's attitude has.
  /// Log-likelihood by which the winner is ahead of the best hypothesis that is more than
  /// kOtherAttitude_rad away; infinite where there is none.
  double lead_nats;
};

class AttitudeGates {
 public:
  using Products = std::vector<ThreeAxisProduct>;

  /// @name Conditions of `safe` beside the threshold of its rule
  /// @{
  static constexpr double kMostMeanNis = 4.0;  ///< Mean NIS that the last window may have.
  static constexpr double kMostSigma_deg = 5.0;
  static constexpr double kLeastLead_nats = 50.0;
  static constexpr double kOtherAttitude_rad = 15.0 * kRadPerDeg;
  /// @}

  explicit AttitudeGates(std::optional<NominalAttitude> nominal) : nominal_{std::move(nominal)} {}

  /// @name A direction that was measured, and where it is
  /// Precondition: measurements that a sensor has only repeated are left out.
  /// @{
  void see_sun(TaiTime t, const Eigen::Vector3d& sun_body, const Eigen::Vector3d& sun_icrf,
               const Expected<OrbitState>& spacecraft);
  void see_field(TaiTime t, const Eigen::Vector3d& field_body, const Eigen::Vector3d& field_icrf,
                 const Expected<OrbitState>& spacecraft, Products& out);
  /// @}

  /// Takes the attitude in force; one that is LOST is none.
  void see(const AttitudeEstimate& estimate, const Expected<OrbitState>& spacecraft, Products& out);
  /// Takes what the field said to the filter in force.
  void see_innovation(const Observation& field, Products& out);
  void see(const WinnerReading& winner, Products& out);

  /// Holds what the last field has said.
  struct FieldSaid {
    TaiTime t;
    double off_deg;  ///< Angle to the field expected at the nominal attitude.
    bool certain;    ///< The Sun is as far away from where it should be.
  };
  /// @return Empty before the first field, or without a nominal attitude.
  const std::optional<FieldSaid>& field() const { return field_; }
  bool is_open(Gate gate) const { return gates_.at(static_cast<std::size_t>(gate)).is_open(); }

 private:
  void update(TaiTime t, Gate gate, double value, bool is_hit, std::vector<NamedValue> more,
              Products& out);
  double mean_nis(const WinnerReading& winner);

  std::optional<NominalAttitude> nominal_;
  std::array<WindowGate, kGates> gates_{
      WindowGate{rule_of(Gate::Lost)}, WindowGate{rule_of(Gate::Usable)},
      WindowGate{rule_of(Gate::Safe)}, WindowGate{rule_of(Gate::Reached)}};
  struct SunAngle {
    TaiTime t;
    double deg;
  };
  WindowGate by_sun_{rule_of(Gate::Lost)};
  std::optional<SunAngle> sun_;  ///< The last one.
  std::optional<FieldSaid> field_;
  struct Nis {
    TaiTime t;
    double nis;
  };
  std::deque<Nis> recent_;  ///< Readings that are in the window of `safe`.
};

}  // namespace spindrift
