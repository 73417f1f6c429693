/// @file
/// Spin clock: counts spin phase in turns by the edges of the channel that sets it.

#pragma once

#include <cstdint>

#include "pipelines/spin/types/spin_rate.h"
#include "pipelines/statistics/drift_filter.h"
#include "pipelines/time/tai_time.h"

namespace spindrift {

/// One sigma of the drift of the spin rate while nothing is known of it, turns/s^2.
inline constexpr double kFirstDrift_per_s2 = drift_per_s2(kFirstDrift_rpm_h);

/// Counts turns: phase n is where the sun1 edge of turn n is expected, or its stand-in. The spin
/// rate may drift evenly, by a few rpm an hour, and wander a little about that. While nothing is
/// known of the drift, turns are counted as if it were small, but the period does not assume that.
class SpinClock {
 public:
  struct Setting {
    TaiTime t;
    double phase_turns;  ///< Phase at t.
    double period_s;
    double period_sigma_s;
    double sigma_s;             ///< One sigma of t.
    double drift_per_s2 = 0.0;  ///< Drift of the spin rate in turns a second.
    double drift_sigma_per_s2 = kFirstDrift_per_s2;
    double scale = 1.0;  ///< Scatter over stated noise (DriftState).
  };
  explicit SpinClock(const Setting& setting);

  double phase_turns(TaiTime t) const;
  TaiTime t_of(double phase_turns) const;
  double period_s() const { return 1.0 / turns_.change(); }
  SpinPeriod period_at(TaiTime t, double earth_turns) const;
  double scale() const { return turns_.scale(); }
  double sigma_s(double phase_turns, double earth_turns) const;

  /// @param phase_turns Expected phase of the edge at `t`.
  /// @param noise_s Standard deviation of t.
  /// @param earth_turns Wander per turn of the phase of the edge's channel.
  /// @return In turns; positive where the phase is ahead of the clock.
  DriftTest test(double phase_turns, TaiTime t, double noise_s, double earth_turns,
                 const DriftGate& gate_turns) const;
  /// Tests the edge and follows it if it lies within the gate.
  DriftTest follow(double phase_turns, TaiTime t, double noise_s, double earth_turns,
                   const DriftGate& gate_turns);

  void add_turns(std::int64_t turns) { epoch_turn_ += static_cast<double>(turns); }

  /// Moves phase `turn` later by `phase_turns` and lengthens the period by `drift` of itself.
  void shift(std::int64_t turn, double phase_turns, double drift);
  /// Adds errors of one sigma each: to the phase, the period (in parts of itself) and the drift.
  void loosen(double phase_turns, double drift, double drift_per_s2);

 private:
  DriftNoise noise(double noise_s, double earth_turns) const;

  TaiTime epoch_;
  double epoch_turn_;
  DriftFilter turns_;  ///< Turns since epoch_turn_ over seconds since epoch_.
  DriftFilter usual_;  ///< The same, supposing a usual drift.
};

}  // namespace spindrift
