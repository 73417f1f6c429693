#include "pipelines/spin/spin_clock.h"

#include <cmath>

#include "pipelines/spin/time_span.h"

namespace spindrift {
namespace {

// Change of the period in one turn, of itself: free bodies lose less, thermal and eddy effects in.
constexpr double kWander = 3e-6;

}  // namespace

SpinClock::SpinClock(const Setting& setting)
    : epoch_{setting.t},
      epoch_turn_{static_cast<double>(setting.turn)},
      t_s_{DriftState{.turn = setting.turn,
                      .value = 0.0,
                      .value_sigma = setting.sigma_s,
                      .change = setting.period_s,
                      .change_sigma = setting.period_sigma_s,
                      .scale = setting.scale}} {}

double SpinClock::phase_turns(TaiTime t) const {
  return epoch_turn_ + (elapsed_s(epoch_, t) - t_s_.at(epoch_turn_)) / period_s();
}

TaiTime SpinClock::t_of(double phase_turns) const {
  return later_by_s(epoch_, t_s_.at(phase_turns));
}

DriftNoise SpinClock::noise(double noise_s, double earth_turns) const {
  return {.measured = noise_s, .wander = std::hypot(kWander, earth_turns) * period_s()};
}

double SpinClock::sigma_s(double phase_turns, double earth_turns) const {
  return t_s_.sigma_at(phase_turns, noise(0.0, earth_turns));
}

bool SpinClock::accepts(std::int64_t turn, TaiTime t, double noise_s, double earth_turns,
                        const DriftGate& gate_turns) const {
  return t_s_.accepts(turn, elapsed_s(epoch_, t), noise(noise_s, earth_turns),
                      {.sigma = gate_turns.sigma, .most = gate_turns.most * period_s()});
}

bool SpinClock::follow(std::int64_t turn, TaiTime t, double noise_s, double earth_turns,
                       const DriftGate& gate_turns) {
  return t_s_.follow(turn, elapsed_s(epoch_, t), noise(noise_s, earth_turns),
                     {.sigma = gate_turns.sigma, .most = gate_turns.most * period_s()});
}

void SpinClock::shift(std::int64_t turn, double phase_turns, double drift) {
  t_s_.shift(static_cast<double>(turn), phase_turns * period_s(), drift * period_s());
}

}  // namespace spindrift
