/// @file
/// The limits of a rationality test.

#pragma once

namespace spindrift {

/// Holds the expected value of a measurement and its largest deviation, in the measurement's unit.
struct Rational {
  double expected;
  double limit;
};

}  // namespace spindrift
