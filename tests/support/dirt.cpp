#include "tests/support/dirt.h"

#include <algorithm>

namespace spindrift::testing {

DirtyPass dirty(const std::vector<Pulse>& pulses, double period_s, const Dirt& dirt,
                std::mt19937_64& rng) {
  std::uniform_real_distribution<double> uniform;
  DirtyPass result;
  const auto put_bad = [&](const Pulse& pulse, double off_turns) {
    const Pulse bad{.t = shifted(pulse.t, off_turns * period_s), .channel = pulse.channel};
    result.pulses.push_back(bad);
    result.bad.insert(bad);
  };
  for (const Pulse& pulse : pulses) {
    if (uniform(rng) < dirt.spurious) {
      put_bad(pulse, uniform(rng) - 0.5);
    }
    if (uniform(rng) < dirt.lost) {
      continue;
    }
    if (uniform(rng) < dirt.spoilt) {
      const double off_turns = 0.01 + 0.19 * uniform(rng);
      put_bad(pulse, uniform(rng) < 0.5 ? -off_turns : off_turns);
    } else {
      result.pulses.push_back(pulse);
    }
  }
  std::sort(result.pulses.begin(), result.pulses.end());
  return result;
}

}  // namespace spindrift::testing
