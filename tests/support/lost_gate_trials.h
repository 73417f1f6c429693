/// @file
/// What the lost gate says of a body that points as commanded, and of one that departs.

#pragma once

#include <cmath>
#include <cstdint>
#include <optional>
#include <random>

#include "pipelines/three_axis/three_axis_pass.h"
#include "tests/support/commanded_flight.h"
#include "tests/support/of_kind.h"

namespace spindrift::testing {

/// A body with a pointing error of one degree and a magnetometer with a noise of 300 nT, once a
/// second.
class LostGateTrial {
 public:
  explicit LostGateTrial(std::uint64_t seed) : rng_{seed} {}

  /// Flies on. @return How often the gate opened or closed.
  int transitions(int samples, double departed_deg = 0.0) {
    int count = 0;
    for (int i = 0; i < samples; ++i) {
      count += transition(departed_deg) ? 1 : 0;
    }
    return count;
  }

  /// Departs. @return Samples of the departure up to that which opened the gate.
  int delay(double departed_deg) {
    constexpr int kLongest = 1'000;
    const double from_s = t_s_;
    for (int i = 0; i < kLongest; ++i) {
      if (const auto opened = transition(departed_deg)) {
        return 1 + static_cast<int>(std::lround(seconds_between(at_s(from_s), *opened)));
      }
    }
    return kLongest;
  }

 private:
  /// Returns the sample that opened or closed the gate, if one did by the next output.
  std::optional<TaiTime> transition(double departed_deg) {
    const auto output = pass_.push(flight_.field(t_s_++, departed_deg * kRadPerDeg));
    for (const GateTransition& gate : of_kind<GateTransition>(output.products)) {
      if (gate.gate == Gate::Lost) {
        return gate.t;
      }
    }
    return std::nullopt;
  }

  std::mt19937_64 rng_;
  CommandedFlight flight_{rng_, 1.0 * kRadPerDeg, 300.0};
  ThreeAxisPass pass_{flight_.config(), flight_.orbit(), flight_.model()};
  double t_s_ = 0.0;
};

/// Seconds of a revolution of the flight.
inline constexpr int kRevolution_s = 5'864;

}  // namespace spindrift::testing
