/// @file
/// Trains of pulses with lost, doubled and displaced edges, and the count of what is made of them.

#pragma once

#include <cstdint>
#include <functional>
#include <map>
#include <optional>
#include <random>
#include <vector>

#include "pipelines/spin/association/association.h"
#include "tests/support/edge_train.h"
#include "tests/support/matchers.h"
#include "tests/support/pulse_trains.h"

namespace spindrift::testing::association_dirt_test {

/// Holds the disturbances of the edges of a pass.
struct Dirt {
  double lost = 0.0;
  double spurious = 0.0;  ///< Spurious edges for each turn and channel, at random times.
  /// Share of displaced edges; they are off by 1/20 of `most_off_turns` up to all of it.
  double spoilt = 0.0;
  double most_off_turns = 0.2;
  double doubled = 0.0;  ///< Share of edges repeated within 1/200 of a turn.
};

/// Describes a train of pulses of all channels and what disturbs it.
struct Train {
  double period_s = 1.0;
  int turns = 100;
  Phases phases_turns = kOrdinary;
  double earth_drift = 0.0;   ///< Drift of the infrared phases, turns per turn.
  double earth_bend = 0.0;    ///< Change of that drift each turn.
  double period_drift = 0.0;  ///< Relative change of the period each turn.
  int step_turn = 0;
  double step = 1.0;  ///< Factor of the period from `step_turn` on.
  Dirt dirt = {};
};

struct Pass {
  std::vector<Pulse> pulses;
  std::map<Pulse, int> turns;  ///< Turn of each undisturbed edge.
};

inline Pass made(const Train& train, std::mt19937_64& rng) {
  std::normal_distribution<double> normal;
  std::uniform_real_distribution<double> uniform;
  const PulseNoise noise = usual_config().noise;
  Pass pass;
  double sun1_s = 0.0;
  double period_s = train.period_s;
  for (int turn = 0; turn < train.turns; ++turn) {
    for (std::size_t i = 0; i < kPulseChannels; ++i) {
      const auto channel = static_cast<PulseChannel>(i);
      const double earth_turns = (train.earth_drift + 0.5 * train.earth_bend * turn) * turn;
      const double drift = sees_the_sun(channel) ? 0.0 : earth_turns;
      const double t_s = sun1_s + (train.phases_turns.at(i) + drift) * period_s;
      Pulse edge{.t = shifted(kStart, t_s + edge_sigma_s(noise, channel) * normal(rng)),
                 .channel = channel};
      if (uniform(rng) < train.dirt.spurious) {
        pass.pulses.push_back(
            {.t = shifted(kStart, sun1_s + uniform(rng) * period_s), .channel = channel});
      }
      if (uniform(rng) < train.dirt.lost) {
        continue;
      }
      if (uniform(rng) < train.dirt.spoilt) {
        const double off = (0.05 + 0.95 * uniform(rng)) * (uniform(rng) < 0.5 ? -1.0 : 1.0);
        edge.t = shifted(edge.t, off * train.dirt.most_off_turns * period_s);
      } else {
        pass.turns[edge] = turn;
      }
      pass.pulses.push_back(edge);
      if (train.dirt.doubled > 0.0 && uniform(rng) < train.dirt.doubled) {
        const double behind_s = 0.005 * uniform(rng) * period_s;
        pass.pulses.push_back({.t = shifted(edge.t, behind_s), .channel = channel});
      }
    }
    sun1_s += period_s;
    period_s *= 1.0 + train.period_drift;
    period_s *= turn + 1 == train.step_turn ? train.step : 1.0;
  }
  return pass;
}

inline Pass without(Pass pass, const std::function<bool(const Pulse&)>& lost) {
  std::erase_if(pass.pulses, lost);
  return pass;
}

inline double seconds_in(const Pulse& pulse) { return seconds_between(kStart, pulse.t); }

/// Counts good edges on a wrong turn (relative to the first one) and rejected good edges.
struct Mistakes {
  int misplaced = 0;
  int rejected = 0;
  int good = 0;
};

inline Mistakes mistakes(const Pass& pass, const Association& all) {
  const auto found = good_edges(all);
  Mistakes counted;
  std::optional<std::int64_t> offset;
  for (const Pulse& pulse : pass.pulses) {
    const bool is_good = pass.turns.contains(pulse);
    counted.good += is_good ? 1 : 0;
    if (is_good && found.contains(pulse)) {
      const std::int64_t here = pass.turns.at(pulse) - found.at(pulse);
      counted.misplaced += here != offset.value_or(here) ? 1 : 0;
      offset = offset.value_or(here);
    } else if (is_good) {
      ++counted.rejected;
    }
  }
  return counted;
}

/// Expects every good edge on its turn and no more than this share of them rejected.
inline void expect_counted(const Pass& pass, const Association& all, double most_rejected) {
  const Mistakes counted = mistakes(pass, all);
  EXPECT_EQ(counted.misplaced, 0);
  EXPECT_LE(counted.rejected, most_rejected * counted.good);
}

}  // namespace spindrift::testing::association_dirt_test
