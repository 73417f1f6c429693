/// @file
/// The limits of a rationality test.

#pragma once

namespace spindrift {

/// What a rationality test expects of a measurement, and how far from that it may be; the unit is
/// that of the measurement.
struct Rational {
  double expected;
  double limit;
};

}  // namespace spindrift
