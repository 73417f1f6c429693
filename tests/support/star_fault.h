/// @file
/// Passes in which the star tracker is wrong for a while, and a comparison of the rows with the
/// truth.

#pragma once

#include <random>

namespace spindrift::testing {

struct StarFault {
  double from_s;
  double until_s;
  double
      turned_deg;  ///< Rotation about a random axis; 0: the tracker repeats its last fix instead.
};

/// Holds a scene with a gyro at 4 Hz and a star fix once a second.
struct FaultScene {
  double rate_deg_s;        ///< Highest rate about each axis, as the sum of three sines.
  double slew_deg_s = 0.0;  ///< Constant rate about a random axis in addition.
  bool has_sun = true;
  bool has_field = true;
  double direction_s =
      1.0;  ///< Interval between samples of the sun sensor and of the magnetometer.
  double duration_s = 180.0;
};

struct RowCount {
  int rows = 0;
  int ok = 0;
  int ok_beyond = 0;      ///< OK rows more than 5 sigma from the truth.
  double worst_ok = 0.0;  ///< Largest error of an OK row, sigma.
  int rows_of_fault = 0;  ///< Rows during the fault.
  int ok_of_fault = 0;
  int lost = 0;

  RowCount& operator+=(const RowCount& more);
};

RowCount fly(const FaultScene& scene, const StarFault& fault, std::mt19937_64& rng);

/// Runs this many passes for each combination of slow or slewing body, stuck or rotated tracker,
/// and other sensors, with the fault at any time after the first two star fixes. Expects that no OK
/// row is more than 5 sigma off and, where Sun and field hold the attitude, that at least 60 % of
/// the fault's rows are OK and none is LOST.
void expect_honest_rows(int passes_of_each);

}  // namespace spindrift::testing
