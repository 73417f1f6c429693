/// @file
/// From the edges of one revolution to its measurements (spin.md, "From pulses to measurements").

#pragma once

#include <array>
#include <cstddef>
#include <optional>

#include "pipelines/spin/association.h"
#include "pipelines/spin/config.h"
#include "pipelines/spin/products.h"
#include "pipelines/time/tai_time.h"

namespace spindrift {

struct Measured {
  double value_rad;
  double sigma_rad;  ///< From the stated pulse noise, which is independent from edge to edge.
};

/// What one infrared sensor gives. Chord and dihedral share both edges.
struct EarthCrossing {
  TaiTime t_mid;  ///< Half way between the edges: where the Earth's direction is taken.
  std::optional<Measured> chord;     ///< Phi, (0, pi).
  std::optional<Measured> dihedral;  ///< lambda, (-pi, pi]; empty without sun1.
};

enum class Side { North, South };
inline constexpr std::array<Side, 2> kSides = {Side::North, Side::South};
inline constexpr std::array<SpinQuantity, 2> kChords = {SpinQuantity::NorthChord,
                                                        SpinQuantity::SouthChord};
inline constexpr std::array<SpinQuantity, 2> kDihedrals = {SpinQuantity::NorthDihedral,
                                                           SpinQuantity::SouthDihedral};
inline constexpr std::array<PulseChannel, 2> kInChannels = {PulseChannel::NorthIn,
                                                            PulseChannel::SouthIn};
inline constexpr std::array<PulseChannel, 2> kOutChannels = {PulseChannel::NorthOut,
                                                             PulseChannel::SouthOut};
constexpr std::size_t index_of(Side side) { return static_cast<std::size_t>(side); }

/// The sensor of a side; empty when the mission has none.
const std::optional<InfraredSensor>& sensor_of(const SpinConfig& config, Side side);

struct RevolutionMeasurements {
  std::optional<TaiTime> t_sun1;
  std::optional<Measured> sun_angle;  ///< theta_s, (0, pi).
  std::array<std::optional<EarthCrossing>, 2> crossings;

  const std::optional<EarthCrossing>& crossing(Side side) const {
    return crossings.at(index_of(side));
  }
};

/// The measurement of a quantity, if the revolution has it; never the period.
std::optional<Measured> value_of(const RevolutionMeasurements& measured, SpinQuantity quantity);

/// The same revolution without one quantity.
void remove(RevolutionMeasurements& measured, SpinQuantity quantity);

/// All that the edges determine. A measurement that has no meaning (slit lag of a quarter turn or
/// more, chord of half a turn or more) is absent.
RevolutionMeasurements measure(const SpinConfig& config, const Revolution& revolution);

/// cot(theta_s) = sin(psi_12 - psi0) / tan I.
/// @param delay_s t_sun2 - t_sun1. @return Empty where |psi_12 - psi0| >= 90 deg.
std::optional<Measured> sun_angle(const SunSensor& sensor, double delay_s, double rate_rad_s,
                                  double sun_pulse_sigma_s);

}  // namespace spindrift
