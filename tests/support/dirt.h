/// @file
/// Disturbs the edges of a pass as a real link does: lost, displaced and spurious edges.

#pragma once

#include <random>
#include <set>
#include <vector>

#include "pipelines/spin/types/pulse.h"

namespace spindrift::testing {

struct Dirt {
  double lost = 0.0;      ///< Share of the edges that are lost.
  double spoilt = 0.0;    ///< Share of the edges displaced by 1/100 to 1/5 of a turn, either way.
  double spurious = 0.0;  ///< Extra edges for each real one, anywhere within a turn about it.
};

struct DirtyPass {
  std::vector<Pulse> pulses;  ///< Pulses in order of time.
  std::set<Pulse> bad;        ///< Displaced and spurious pulses.
};

DirtyPass dirty(const std::vector<Pulse>& pulses, double period_s, const Dirt& dirt,
                std::mt19937_64& rng);

}  // namespace spindrift::testing
