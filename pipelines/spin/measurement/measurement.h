/// @file
/// From the edges of one revolution to its measurements (Wang 2015).

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

/// What each edge adds to a value when it comes one standard deviation late (rad), by channel.
using EdgeNoise = Eigen::Matrix<double, kPulseChannels, 1>;

struct Measured {
  double value_rad;
  double sigma_rad;     ///< Length of `noise_rad`: the stated noise is independent between edges.
  EdgeNoise noise_rad;  ///< Two measurements are correlated where both have an entry.
  /// Empty: good. Otherwise it failed a test, or rests on an edge that is not to be used.
  std::optional<Rejection> rejected_by = {};
  std::optional<Rational> test = {};  ///< Empty: it was not tested.
};

/// What one infrared sensor gives. Chord and dihedral share both edges.
struct EarthCrossing {
  TaiTime t_in;
  TaiTime t_out;
  std::optional<Measured> chord;     ///< Phi, (0, pi).
  std::optional<Measured> dihedral;  ///< lambda, (-pi, pi]; empty without sun1.

  TaiTime t_mid() const { return t_in + (t_out - t_in) / 2; }
};

/// All that `measure` gives.
inline constexpr std::array<SpinQuantity, 6> kMeasuredAngles = {
    SpinQuantity::SunAngle,      SpinQuantity::NorthChord,    SpinQuantity::SouthChord,
    SpinQuantity::NorthDihedral, SpinQuantity::SouthDihedral, SpinQuantity::MixedAzimuth};

/// Of two measurements of the same angle, wrapped to (-pi, pi].
Measured circular_mean(const Measured& one, const Measured& other);

/// All that the edges of one revolution determine, good or not.
struct RevolutionMeasurements {
  PulseNoise noise;                   ///< Of the edges, as stated when it was measured.
  std::optional<TaiTime> t_sun1;      ///< Of a good edge only.
  std::optional<Measured> sun_angle;  ///< theta_s, (0, pi).
  /// w (t_mid - t_sun2) - a, (-pi, pi], the mean of the sensors; only where sun1 is not good.
  std::optional<Measured> mixed_azimuth;
  std::array<std::optional<EarthCrossing>, 2> crossings;
  std::array<bool, 2> silent;  ///< Neither edge of the sensor was received.

  const std::optional<EarthCrossing>& crossing(Side side) const {
    return crossings.at(index_of(side));
  }
};

/// The measurement of a quantity, good or not, if the revolution has it; never the period.
std::optional<Measured> value_of(const RevolutionMeasurements& measured, SpinQuantity quantity);

/// The same where nothing speaks against it.
std::optional<Measured> good_value_of(const RevolutionMeasurements& measured,
                                      SpinQuantity quantity);

/// Marks a quantity as not to be used, unless it is already.
void reject(RevolutionMeasurements& measured, SpinQuantity quantity, Rejection why);

/// Notes what a quantity was held against.
void note_test(RevolutionMeasurements& measured, SpinQuantity quantity, const Rational& test);

/// A measurement that has no meaning (slit lag of a quarter turn or more, chord of a whole turn or
/// more) is absent; one that rests on a rejected edge is there, rejected for the same reason.
RevolutionMeasurements measure(const SpinConfig& config, const Revolution& revolution);

/// cot(theta_s) = sin(psi_12 - psi0) / tan I.
/// @param delay_s t_sun2 - t_sun1. @return Empty where |psi_12 - psi0| >= 90 deg.
std::optional<Measured> sun_angle(const SunSensor& sensor, double delay_s, double rate_rad_s,
                                  double sun_pulse_sigma_s);

}  // namespace spindrift
