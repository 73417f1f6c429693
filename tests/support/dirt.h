/// @file
/// What a real link does to the edges of a pass.

#pragma once

#include <random>
#include <set>
#include <vector>

#include "pipelines/spin/types/pulse.h"

namespace spindrift::testing {

struct Dirt {
  double lost = 0.0;      ///< Share of the edges.
  double spoilt = 0.0;    ///< Share of the edges: a hundredth to a fifth of a turn off, either way.
  double spurious = 0.0;  ///< Edges more for each that is there, anywhere in a turn about it.
};

struct DirtyPass {
  std::vector<Pulse> pulses;  ///< In order of time.
  std::set<Pulse> bad;        ///< Those that are spoilt or spurious.
};

DirtyPass dirty(const std::vector<Pulse>& pulses, double period_s, const Dirt& dirt,
                std::mt19937_64& rng);

}  // namespace spindrift::testing
