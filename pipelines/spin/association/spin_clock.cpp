#include "pipelines/spin/association/spin_clock.h"

#include <cmath>

#include "pipelines/time/time_span.h"

namespace spindrift {
namespace {

// Eddy currents, warming and leaks seldom cause more. A few turns reveal a larger drift; allowing
// for any drift before that would leave the count uncertain through a silence of minutes.
constexpr double kUsualDrift_per_s2 = 0.1 * kFirstDrift_per_s2;

}  // namespace

SpinClock::SpinClock(const Setting& setting)
    : epoch_{setting.t},
      epoch_turn_{setting.phase_turns},
      turns_{
          DriftState{.x = 0.0,
                     .value = 0.0,
                     .value_sigma = setting.sigma_s / setting.period_s,
                     .change = 1.0 / setting.period_s,
                     .change_sigma = setting.period_sigma_s / (setting.period_s * setting.period_s),
                     .bend = setting.drift_per_s2,
                     .bend_sigma = setting.drift_sigma_per_s2,
                     .scale = setting.scale}},
      usual_{turns_.supposing_bend(0.0, kUsualDrift_per_s2)} {}

double SpinClock::phase_turns(TaiTime t) const {
  return epoch_turn_ + usual_.at(elapsed_s(epoch_, t));
}

TaiTime SpinClock::t_of(double phase_turns) const {
  return later_by_s(epoch_, usual_.x_of(phase_turns - epoch_turn_));
}

SpinPeriod SpinClock::period_at(TaiTime t, double earth_turns) const {
  const double x = elapsed_s(epoch_, t);
  const double period_s = 1.0 / turns_.change_at(x);
  return {.period_s = period_s,
          .sigma_s = period_s * period_s * turns_.change_sigma_at(x, noise(0.0, earth_turns)),
          .drift_per_s2 = turns_.bend()};
}

DriftNoise SpinClock::noise(double noise_s, double earth_turns) const {
  const double rate = turns_.change();
  // The wander of the spin rate in one second, turns/s, is what is left of its change beside an
  // even drift, as in the spin filter; that of the drift is in turns/s^2.
  return {.measured = noise_s * rate,
          .wander = std::hypot(5e-7, earth_turns * rate * std::sqrt(rate)),
          .bend_wander = 3e-10};
}

double SpinClock::sigma_s(double phase_turns, double earth_turns) const {
  return usual_.sigma_at(usual_.x_of(phase_turns - epoch_turn_), noise(0.0, earth_turns)) *
         period_s();
}

DriftTest SpinClock::test(double phase_turns, TaiTime t, double noise_s, double earth_turns,
                          const DriftGate& gate_turns) const {
  return turns_.test(elapsed_s(epoch_, t), phase_turns - epoch_turn_, noise(noise_s, earth_turns),
                     gate_turns);
}

DriftTest SpinClock::follow(double phase_turns, TaiTime t, double noise_s, double earth_turns,
                            const DriftGate& gate_turns) {
  const DriftTest tested = turns_.follow(elapsed_s(epoch_, t), phase_turns - epoch_turn_,
                                         noise(noise_s, earth_turns), gate_turns);
  usual_ = turns_.supposing_bend(0.0, kUsualDrift_per_s2);
  return tested;
}

void SpinClock::shift(std::int64_t turn, double phase_turns, double drift) {
  turns_.shift(turns_.x_of(static_cast<double>(turn) - epoch_turn_), -phase_turns,
               -drift * turns_.change());
  usual_ = turns_.supposing_bend(0.0, kUsualDrift_per_s2);
}

void SpinClock::loosen(double phase_turns, double drift, double drift_per_s2) {
  turns_.loosen(phase_turns, drift * turns_.change(), drift_per_s2);
  usual_ = turns_.supposing_bend(0.0, kUsualDrift_per_s2);
}

}  // namespace spindrift
