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

/// A straight line through the points that agree.
struct RobustLine {
  double turn;     ///< Mean turn of the points that agree.
  double phase;    ///< Phase on that turn, turns.
  double drift;    ///< Drift, turns per turn.
  double scatter;  ///< Standard deviation about the line, at least the stated one.
  std::vector<PhasePoint> agreeing;

  double at(double turn_then) const { return phase + drift * (turn_then - turn); }
};

/// Fits a line by the least median of deviations over the lines through two points, then by least
/// squares within three sigma of it (Rousseeuw and Leroy): any minority may be wrong.
///
/// @param points At most a few tens, since the cost is cubic.
/// @param noise Stated standard deviation of a phase.
/// @param most_drift Steeper lines are not considered.
/// @return Empty for no points.
std::optional<RobustLine> fit_robust_line(std::span<const PhasePoint> points, double noise,
                                          double most_drift);

/// Returns the phase with the least summed distance to the others round the circle.
/// @param phases At least one.
double circular_median(std::span<const double> phases);

}  // namespace spindrift
