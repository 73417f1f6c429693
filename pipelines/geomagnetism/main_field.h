/// @file
/// The Earth's main magnetic field, that of its core: at one date, over a century, and at a
/// spacecraft.
///
///     B = -grad V,  V = a sum_n (a/r)^(n+1) sum_m (g_nm cos m l + h_nm sin m l) P_nm(sin b)
///
/// with a = 6371.2 km, latitude b, longitude l, and Schmidt's semi-normalised P_nm. The sum is in
/// Cartesian components by Cunningham's recursion (Montenbruck and Gill 2000, eq. 3.29 to 3.33),
/// which divides by r only and so has no singularity at the poles.
///
/// Crust and currents add 30 nT on a quiet day, and turn the field by a degree and more under an
/// aurora; they are not modelled.
///
/// GeographicLib's SphericalHarmonic was rejected: with the same coefficients it is slower by a
/// factor of 1.7 (tests/bench), and its table would be shared by threads. The tests compare with it
/// to 1e-12.

#pragma once

#include <Eigen/Core>
#include <array>
#include <cstddef>
#include <utility>
#include <vector>

#include "pipelines/core/expected.h"
#include "pipelines/ephemeris/earth_orientation.h"
#include "pipelines/frames/local_frame.h"
#include "pipelines/time/tai_time.h"

namespace spindrift {

inline constexpr int kHighestDegree = 13;
/// Reference radius of the harmonics: the Earth's mean radius of the IGRF.
inline constexpr double kFieldRadius_km = 6371.2;

/// Spherical harmonic coefficients of a main field, Schmidt semi-normalised.
struct GaussCoefficients {
  static constexpr std::size_t kCount{(kHighestDegree + 1) * (kHighestDegree + 2) / 2};
  /// Returns the index in `g_nt` and `h_nt`, by degree, then order; degree 0 is included.
  static constexpr std::size_t index(int degree, int order) {
    const int entry = degree * (degree + 1) / 2 + order;
    return static_cast<std::size_t>(entry);
  }

  std::array<double, kCount> g_nt{};
  std::array<double, kCount> h_nt{};  ///< Coefficients h; 0 for order 0.
};

/// The field at one date.
class MainField {
 public:
  /// Radius below which the sources of the field lie and the sum has no meaning.
  static constexpr double kCoreRadius_km = 3480.0;

  /// @param degree Highest degree of the sum, 1 to kHighestDegree.
  MainField(const GaussCoefficients& coefficients, int degree);

  /// @return Field in ITRF, nT; InvalidInput within the core and for a position that is not finite.
  Expected<Eigen::Vector3d> at(const Eigen::Vector3d& position_itrf_km) const;

  /// @return Field north, east, down, nT; InvalidInput as for `at`.
  Expected<Eigen::Vector3d> ned_at(const LocalFrame& frame) const;

 private:
  GaussCoefficients unnormalised_;
  int degree_;
};

/// Returns the year and its elapsed fraction at `t`, by TAI: a year is 365 or 366 days.
double decimal_year(TaiTime t);
/// Returns the inverse of `decimal_year`.
TaiTime instant_of_year(double year);

struct FieldEpoch {
  double year;
  GaussCoefficients coefficients;
};

/// The field over a century, interpolated linearly between epochs; valid by construction.
class MainFieldModel {
 public:
  /// @return InvalidConfiguration for fewer than two epochs, and for epochs out of order.
  static Expected<MainFieldModel> make(std::vector<FieldEpoch> epochs);

  /// @param year Decimal year. @return NoCoverage for a year outside the epochs.
  Expected<GaussCoefficients> coefficients(double year) const;

  /// @param degree Highest degree of the sum.
  Expected<MainField> at(double year, int degree = kHighestDegree) const;

  double first_year() const { return epochs_.front().year; }
  double last_year() const { return epochs_.back().year; }

 private:
  explicit MainFieldModel(std::vector<FieldEpoch> epochs) : epochs_{std::move(epochs)} {}
  std::vector<FieldEpoch> epochs_;
};

/// @return Field in ICRF, nT; NoCoverage outside the model's years, InvalidInput within the core.
Expected<Eigen::Vector3d> field_icrf_nt(const MainFieldModel& model, TaiTime t,
                                        const Eigen::Vector3d& position_icrf_km,
                                        TurningEarth& earth);

}  // namespace spindrift
