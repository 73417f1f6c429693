/// @file
/// What one measurement said to one estimator: what was expected, how far off it was, how
/// surprising that is, and whether it was used. The estimator makes it before it decides.

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

/// The pulse channels in the order of PulseChannel, then the kinds of samples in that of
/// SampleKind.
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
};
inline constexpr std::size_t kSampleSources = 11;
constexpr std::size_t index_of(SampleSource source) { return static_cast<std::size_t>(source); }
/// The archive calls a source by its pulse channel, or by its kind of sample.
constexpr std::string_view name_of(SampleSource source) {
  constexpr std::array<std::string_view, kSampleSources> kNames = {
      "sun1",        "sun2", "north_in", "north_out", "south_in",    "south_out",
      "orbit_state", "gyro", "star",     "sun",       "magnetometer"};
  return kNames.at(index_of(source));
}

/// Measured minus expected. Edges: s. Star tracker, sun sensor: rad. Magnetometer: nT.
struct Residual {
  int freedom = 0;  ///< So many components count; 0: nothing was expected.
  Eigen::Vector3d value = Eigen::Vector3d::Zero();
  /// One standard deviation of each component, by what the estimator knew before.
  Eigen::Vector3d sigma = Eigen::Vector3d::Zero();
};

struct Observation {
  TaiTime t;
  SampleSource source;
  Residual residual = {};
  double nis = 0.0;    ///< Normalised innovation squared, a chi-square of so many freedoms.
  double limit = 0.0;  ///< What `nis` was held against.
  std::optional<Rejection> rejected_by = {};  ///< Empty: it was used.

  /// @return A residual of one degree of freedom, in its standard deviations.
  double whitened() const { return residual.value[0] / residual.sigma[0]; }
  /// What was left out counts as at its limit: nobody knows how far off a spurious one is.
  double bounded_nis() const { return rejected_by ? limit : nis; }
};

}  // namespace spindrift
