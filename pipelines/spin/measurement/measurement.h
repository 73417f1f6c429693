/// @file
/// Measurements of one revolution from its edges (Wang 2015).

#pragma once

#include <Eigen/Core>
#include <array>
#include <optional>

#include "pipelines/spin/types/config.h"
#include "pipelines/spin/types/products.h"
#include "pipelines/spin/types/revolution.h"
#include "pipelines/spin/types/side.h"
#include "pipelines/time/tai_time.h"

namespace spindrift {

/// Change of a value per standard deviation that each edge is late (rad), by channel.
using EdgeNoise = Eigen::Matrix<double, kPulseChannels, 1>;

struct Measured {
  double value_rad;
  double sigma_rad;     ///< Length of `noise_rad`: the stated noise is independent between edges.
  EdgeNoise noise_rad;  ///< Two measurements are correlated where both have an entry.
  /// Empty when good; else the failed test, or the rejection of an edge that the value rests on.
  std::optional<Rejection> rejected_by = {};
  std::optional<Observation> said = {};  ///< Empty if not tested.
};

/// Holds the measurements of one infrared sensor. Chord and dihedral share both edges.
struct EarthCrossing {
  TaiTime t_in;
  TaiTime t_out;
  std::optional<Measured> chord;     ///< Chord Phi, (0, pi).
  std::optional<Measured> dihedral;  ///< Dihedral lambda, (-pi, pi]; empty without sun1.

  TaiTime t_mid() const { return t_in + (t_out - t_in) / 2; }
};

/// Quantities that measure() can return.
inline constexpr std::array<SpinQuantity, 6> kMeasuredAngles = {
    SpinQuantity::SunAngle,      SpinQuantity::NorthChord,    SpinQuantity::SouthChord,
    SpinQuantity::NorthDihedral, SpinQuantity::SouthDihedral, SpinQuantity::MixedAzimuth};

/// Returns the mean of two measurements of the same angle, wrapped to (-pi, pi].
Measured circular_mean(const Measured& one, const Measured& other);

/// All that the edges of one revolution determine, good or not.
struct RevolutionMeasurements {
  PulseNoise noise;                   ///< Edge noise stated at the time.
  std::optional<TaiTime> t_sun1;      ///< Time of a good sun1 edge.
  std::optional<Measured> sun_angle;  ///< Sun angle theta_s, (0, pi).
  /// Azimuth w (t_mid - t_sun2) - a, (-pi, pi], mean of the sensors; only where sun1 is not good.
  std::optional<Measured> mixed_azimuth;
  std::array<std::optional<EarthCrossing>, 2> crossings;
  std::array<bool, 2> silent;  ///< True if neither edge of the sensor was received.

  const std::optional<EarthCrossing>& crossing(Side side) const {
    return crossings.at(index_of(side));
  }
};

/// Returns the measurement of a quantity, good or not, if there is one; never the period.
std::optional<Measured> value_of(const RevolutionMeasurements& measured, SpinQuantity quantity);

/// Returns the measurement of a quantity unless it is rejected.
std::optional<Measured> good_value_of(const RevolutionMeasurements& measured,
                                      SpinQuantity quantity);

/// Marks a quantity as rejected, unless it is already.
void reject(RevolutionMeasurements& measured, SpinQuantity quantity, Rejection why);

/// Stores what a quantity said, and rejects it if its test did.
void judge(RevolutionMeasurements& measured, SpinQuantity quantity, const Observation& said);

/// Returns the measurements. One without meaning (slit lag of a quarter turn or more, chord of a
/// whole turn or more) is absent; one that rests on a rejected edge is rejected for the same
/// reason.
RevolutionMeasurements measure(const SpinConfig& config, const Revolution& revolution);

/// Solves cot(theta_s) = sin(psi_12 - psi0) / tan I.
/// @param delay_s Delay t_sun2 - t_sun1. @return Empty where |psi_12 - psi0| >= 90 deg.
std::optional<Measured> sun_angle(const SunSensor& sensor, double delay_s, double rate_rad_s,
                                  double sun_pulse_sigma_s);

}  // namespace spindrift
