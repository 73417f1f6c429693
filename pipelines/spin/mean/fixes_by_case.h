/// @file
/// The fixes of a pass for their mean, kept apart by geometry case.
///
/// Where fixes are left out because of their noise (roots that merge, candidates too near to each
/// other), those that remain are a biased selection. Of a normal vector of unit variance, the mean
/// over any event of probability p is at most sqrt(2 ln(1/p)) long, as its relative entropy,
/// ln(1/p), is at least half the square of that; and by the same for what is left out, at most
/// (1-p)/p sqrt(2 ln(1/(1-p))).
///
/// A shift of every fix by s of its sigmas moves the least-squares mean, whose covariance is C, in
/// no direction d by more than the root of
///
///     s^2 n  d' C I C d        (Cauchy and Schwarz over the n fixes),
///
/// with the information I that these fixes bring: so they count by what they weigh, not by their
/// number. Unlike noise, it does not average out.

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
#include "pipelines/spin/types/sun_earth_directions.h"

namespace spindrift {

/// What a selection of so many of all normal vectors is shifted by at most, in sigmas.
/// @param share (0, 1].
double largest_selection_shift_sigmas(double share);

/// Mean of the cases that together leave the axis the least uncertain: what a selection adds may be
/// less than what it shifts.
struct MeanOfCases {
  AngleEquations equations;
  Eigen::Matrix2d covariance_rad2;  ///< Noise and shift. Tangent plane: east, north.
  std::size_t count;                ///< Fixes.
  double settled_share;  ///< Of the fixes that there might be, each case by its weight in the mean.
};

/// Fixes of one case, by stretches in each of which so many came to be settled or left out: as the
/// geometry turns, those that noise leaves out become more or fewer.
class FixesByCase {
 public:
  /// @param stretch_fixes Of so many fixes of a case; once so many more of it have come, those
  ///        before are neither added nor taken back any more.
  explicit FixesByCase(std::size_t stretch_fixes) : stretch_fixes_{stretch_fixes} {}

  /// Where the next fix of the case belongs.
  std::int64_t next_stretch(int geometry_case);
  void leave_out(int geometry_case, std::int64_t stretch);
  void take_back(int geometry_case, std::int64_t stretch);
  /// @param axis_icrf As AngleEquations.
  void add(int geometry_case, std::int64_t stretch, const SpinConfig& config,
           const RevolutionMeasurements& measured, const SunEarthDirections& sun_earth,
           const Eigen::Vector3d& axis_icrf);

  /// Forgets the fixes, but not what was left out.
  /// @param reference_icrf Unit; as AngleEquations.
  void begin_at(const Eigen::Vector3d& reference_icrf);

  /// There must be a fix.
  MeanOfCases mean() const;

 private:
  struct Group {
    AngleEquations equations;
    std::size_t count = 0;
    std::size_t left_out = 0;

    Group& operator+=(const Group& other);
    double share() const;
  };
  /// The last two stretches.
  struct Open {
    std::int64_t number = 0;  ///< Of the last.
    Group last;
    Group before;
  };
  /// Earlier ones, those together that are settled alike.
  static constexpr std::array kShares{1.0, 0.99, 0.9, 0.5, 0.0};

  Group empty() const { return {.equations = AngleEquations{reference_icrf_}}; }
  Group& group_of(int geometry_case, std::int64_t stretch);
  void close(const Group& stretch);
  std::vector<Group> groups() const;

  std::size_t stretch_fixes_;
  Eigen::Vector3d reference_icrf_ = Eigen::Vector3d::UnitZ();
  std::map<int, Open> open_;  ///< By geometry case.
  std::vector<Group> closed_{kShares.size(), empty()};
};

}  // namespace spindrift
