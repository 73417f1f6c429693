/// @file
/// Robust straight line through phases of which a minority may be wrong.

#pragma once

#include <optional>
#include <span>
#include <vector>

namespace spindrift {

/// The phase that an edge was seen at on a turn, both in turns.
struct PhasePoint {
  double turn;
  double phase;
};

/// A straight line through those that agree.
struct RobustLine {
  double turn;     ///< The middle of those that agree.
  double phase;    ///< There.
  double drift;    ///< Turns per turn.
  double scatter;  ///< Standard deviation about the line, at least the stated one.
  std::vector<PhasePoint> agreeing;

  double at(double turn_then) const { return phase + drift * (turn_then - turn); }
};

/// Least median of deviations over the lines through two points, then least squares over what lies
/// within three sigma of it (Rousseeuw and Leroy): any minority may be wrong.
///
/// @param points No turn twice counts for more than one; at most a few tens, the cost is cubic.
/// @param noise Standard deviation of a phase that is stated.
/// @param most_drift Steeper lines are not considered.
/// @return Empty for no points.
std::optional<RobustLine> fit_robust_line(std::span<const PhasePoint> points, double noise,
                                          double most_drift);

/// The phase of least summed distance to the others, round the circle.
/// @param phases At least one.
double circular_median(std::span<const double> phases);

}  // namespace spindrift
