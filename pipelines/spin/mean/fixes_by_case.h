/// @file
/// The fixes of a pass for their mean, kept apart by geometry case.
///
/// Where fixes are left out because of their noise (roots that merge, candidates too near to each
/// other), the remaining ones are a biased selection. For a normal vector of unit variance, the
/// mean over any event of probability p is at most sqrt(2 ln(1/p)) long, as its relative entropy,
/// ln(1/p), is at least half the square of the length. Applied to the fixes left out, this gives a
/// bound of (1-p)/p sqrt(2 ln(1/(1-p))).
///
/// A shift of every fix by s of its sigmas moves the least-squares mean, whose covariance is C, in
/// any direction d by at most the root of
///
///     s^2 n  d' C I C d        (Cauchy and Schwarz over the n fixes),
///
/// where I is the information of these fixes: they count by weight, not by number. Unlike noise,
/// this shift does not average out.

#pragma once

#include <Eigen/Core>
#include <array>
#include <cstddef>
#include <cstdint>
#include <map>
#include <vector>

#include "pipelines/spin/mean/angle_equations.h"
#include "pipelines/spin/measurement/measurement.h"
#include "pipelines/spin/types/config.h"
#include "pipelines/spin/types/sky.h"

namespace spindrift {

/// Returns the largest shift, in sigmas, of the mean of a selection from normal vectors.
/// @param share Selected share, in (0, 1].
double largest_selection_shift_sigmas(double share);

/// Holds the mean of the cases that together give the least uncertain axis, as a selected case may
/// shift the mean by more than it helps.
struct MeanOfCases {
  AngleEquations equations;
  Eigen::Matrix2d covariance_rad2;  ///< Noise and shift, tangent plane: east, north.
  std::size_t count;                ///< Number of fixes.
  double settled_share;             ///< Settled share of all fixes, weighted as in the mean.
};

/// Groups the fixes by case and by stretch of fixes settled or left out, because the share that
/// noise leaves out changes with the geometry.
class FixesByCase {
 public:
  /// @param stretch_fixes Number of fixes of a case per stretch. After as many more fixes, earlier
  ///        ones can be neither added nor taken back.
  explicit FixesByCase(std::size_t stretch_fixes) : stretch_fixes_{stretch_fixes} {}

  /// Returns the stretch of the next fix of the case.
  std::int64_t next_stretch(int geometry_case);
  void leave_out(int geometry_case, std::int64_t stretch);
  void take_back(int geometry_case, std::int64_t stretch);
  /// @param axis_icrf Linearisation axis, as in AngleEquations::add().
  void add_fix(int geometry_case, std::int64_t stretch, const SpinConfig& config,
               const RevolutionMeasurements& measured, const SunEarthDirections& sun_earth,
               const Eigen::Vector3d& axis_icrf);

  /// Forgets the fixes but keeps the counts of those left out.
  /// @param reference_icrf Unit vector, as in AngleEquations.
  void begin_at(const Eigen::Vector3d& reference_icrf);

  /// Returns the mean; there must be a fix.
  MeanOfCases mean() const;

 private:
  struct Group {
    AngleEquations equations;
    std::size_t count = 0;
    std::size_t left_out = 0;

    Group& operator+=(const Group& other);
    double share() const;
  };
  /// Holds the last two stretches of a case.
  struct Open {
    std::int64_t number = 0;  ///< Number of the last stretch.
    Group last;
    Group before;
  };
  /// Lower limits of the settled share by which closed stretches are merged.
  static constexpr std::array kShares{1.0, 0.99, 0.9, 0.5, 0.0};

  Group empty() const { return {.equations = AngleEquations{reference_icrf_}}; }
  Group& group_of(int geometry_case, std::int64_t stretch);
  void close(const Group& stretch);
  std::vector<Group> groups() const;

  std::size_t stretch_fixes_;
  Eigen::Vector3d reference_icrf_ = Eigen::Vector3d::UnitZ();
  std::map<int, Open> open_;  ///< Open stretches by geometry case.
  std::vector<Group> closed_{kShares.size(), empty()};
};

}  // namespace spindrift
