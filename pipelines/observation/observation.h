/// @file
/// The observation that one measurement gives to one estimator: residual, normalised innovation,
/// limit and rejection. The estimator builds it before it decides on the measurement.

#pragma once

#include <Eigen/Core>
#include <array>
#include <cmath>
#include <cstddef>
#include <cstdint>
#include <optional>
#include <string_view>

#include "pipelines/observation/rejection.h"
#include "pipelines/time/tai_time.h"

namespace spindrift {

/// The pulse channels in the order of PulseChannel, the sample kinds in that of SampleKind, then
/// the quantities of a revolution in that of SpinQuantity.
enum class SampleSource : std::uint8_t {
  Sun1,
  Sun2,
  NorthIn,
  NorthOut,
  SouthIn,
  SouthOut,
  OrbitState,
  Gyro,
  Star,
  Sun,
  Magnetometer,
  Period,
  SunAngle,
  NorthChord,
  SouthChord,
  NorthDihedral,
  SouthDihedral,
  MixedAzimuth,
};
inline constexpr std::size_t kSampleSources = 18;
constexpr std::size_t index_of(SampleSource source) { return static_cast<std::size_t>(source); }
/// Returns the source's name in the archive: that of its pulse channel, sample kind or quantity.
constexpr std::string_view name_of(SampleSource source) {
  constexpr std::array<std::string_view, kSampleSources> kNames = {
      "sun1",           "sun2",           "north_in",     "north_out",   "south_in",
      "south_out",      "orbit_state",    "gyro",         "star",        "sun",
      "magnetometer",   "period",         "sun_angle",    "north_chord", "south_chord",
      "north_dihedral", "south_dihedral", "mixed_azimuth"};
  return kNames.at(index_of(source));
}

/// Holds measured minus expected: edges and periods in s, angles, star and sun sensors in rad,
/// magnetometer in nT.
struct Residual {
  int freedom = 0;  ///< Number of components; 0 if nothing was expected.
  Eigen::Vector3d value = Eigen::Vector3d::Zero();
  /// Prior standard deviation of each component.
  Eigen::Vector3d sigma = Eigen::Vector3d::Zero();
};

struct Observation {
  TaiTime t;
  SampleSource source;
  Residual residual = {};
  double nis = 0.0;    ///< Normalised innovation squared, with `freedom` degrees of freedom.
  double limit = 0.0;  ///< Upper limit of `nis`.
  std::optional<Rejection> rejected_by = {};  ///< Empty if the measurement was used.

  /// Returns an observation of one degree of freedom, used or rejected by `test`.
  /// @param largest Largest absolute residual that passes the test; unit of the residual.
  static Observation of(TaiTime t, SampleSource source, double residual, double sigma,
                        double largest, Rejection test) {
    const auto square = [sigma](double value) { return value / sigma * (value / sigma); };
    return {.t = t,
            .source = source,
            .residual = {.freedom = 1, .value = {residual, 0.0, 0.0}, .sigma = {sigma, 0.0, 0.0}},
            .nis = square(residual),
            .limit = square(largest),
            .rejected_by = std::abs(residual) > largest ? std::optional{test} : std::nullopt};
  }

  /// Returns the residual of an observation with one degree of freedom, in standard deviations.
  double whitened() const { return residual.value[0] / residual.sigma[0]; }
  /// Counts a rejected measurement at its limit, as the size of a spurious one is arbitrary.
  double bounded_nis() const { return rejected_by ? limit : nis; }
};

}  // namespace spindrift
