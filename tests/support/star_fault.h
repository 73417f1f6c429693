/// @file
/// Passes in which the star tracker lies for a while, beside whatever else there is: what the rows
/// say, beside the truth.

#pragma once

#include <random>

namespace spindrift::testing {

struct StarFault {
  double from_s;
  double until_s;
  double turned_deg;  ///< About a random axis; 0: it repeats its last fix instead.
};

/// Once a second, at 4 Hz of the gyro.
struct FaultScene {
  double rate_deg_s;        ///< About each axis, at most, as three sines.
  double slew_deg_s = 0.0;  ///< About a random axis beside that, all the time.
  bool has_sun = true;
  bool has_field = true;
  double direction_s = 1.0;  ///< Between samples of Sun and of field.
  double duration_s = 180.0;
};

struct RowCount {
  int rows = 0;
  int ok = 0;
  int ok_beyond = 0;      ///< By more than 5 sigma from the truth; likewise:
  double worst_ok = 0.0;  ///< In sigma.
  int rows_of_fault = 0;  ///< While it lasts.
  int ok_of_fault = 0;
  int lost = 0;

  RowCount& operator+=(const RowCount& more);
};

RowCount fly(const FaultScene& scene, const StarFault& fault, std::mt19937_64& rng);

/// Slow and slewing bodies, trackers that are stuck or turned, each with the sensors beside them:
/// so many passes of each, the fault at any time behind two star fixes. Expects that no row that
/// says OK is beyond 5 sigma, and 60 % and more of them OK, and none LOST, where Sun and field hold
/// the attitude.
void expect_honest_rows(int passes_of_each);

}  // namespace spindrift::testing
