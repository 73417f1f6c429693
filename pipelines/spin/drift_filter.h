/// @file
/// A quantity measured once a turn that changes by nearly the same amount from turn to turn: two
/// states, value and change per turn, whose change wanders.

#pragma once

#include <cstdint>

namespace spindrift {

/// One standard deviation each.
struct DriftNoise {
  double measured;  ///< Of one measurement.
  double wander;    ///< By which the change per turn itself changes in a turn.
};

/// How far from the expectation a measurement may lie.
struct DriftGate {
  double sigma;  ///< In standard deviations of the difference.
  double most;   ///< In any case.
};

/// What is known at a turn, with its standard deviations.
struct DriftState {
  std::int64_t turn;
  double value;
  double value_sigma;
  double change;  ///< Per turn.
  double change_sigma;
  double scale = 1.0;  ///< By which the scatter exceeds the stated noise, at least 1.
};

/// Kalman filter with an innovation gate. The stated noise is a lower bound: where the measurements
/// scatter more, the gate opens until half of them lie where half of them should.
class DriftFilter {
 public:
  explicit DriftFilter(const DriftState& state);

  double at(double turn) const { return value_ + change_ * (turn - turn_); }
  /// At the last turn that was taken in.
  double value() const { return value_; }
  double change() const { return change_; }
  double scale() const { return scale_; }
  /// Standard deviation of the value at a turn.
  double sigma_at(double turn, const DriftNoise& noise) const;

  /// Whether the measurement lies within the gate.
  bool accepts(std::int64_t turn, double measured, const DriftNoise& noise,
               const DriftGate& gate) const;
  /// The same, and takes it in when it does.
  bool follow(std::int64_t turn, double measured, const DriftNoise& noise, const DriftGate& gate);

  /// Moves value (at `turn`) and change.
  void shift(double turn, double value, double change);

 private:
  struct Covariance {
    double value;
    double both;
    double change;
  };
  Covariance covariance_at(double turn, double wander) const;

  double turn_;
  double value_;
  double change_;
  Covariance covariance_;
  double scale_;
};

}  // namespace spindrift
