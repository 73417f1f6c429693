/// @file
/// Simulated trains of edges at constant phases, and queries on their association.

#pragma once

#include <gtest/gtest.h>

#include <algorithm>
#include <array>
#include <cstdint>
#include <map>
#include <random>
#include <vector>

#include "pipelines/spin/association/association.h"
#include "tests/support/spinning_body.h"

namespace spindrift {

inline const TaiTime kStart = tai_from_ns(1'795'143'637'000'000'000);
inline constexpr double kPeriod_s = 0.75;

/// Holds the phases of the six channels after sun1, in turns.
using Phases = std::array<double, kPulseChannels>;
inline constexpr Phases kOrdinary = {0.0, 0.11, 0.40, 0.52, 0.41, 0.55};

struct Train {
  double period_s = kPeriod_s;
  Phases phases_turns = kOrdinary;
  int turns = 100;
  double noise_s = 0.0;
};

/// Holds an edge with the turn on which it was made, which association has to find.
struct MadeEdge {
  Pulse pulse;
  int turn;
};

inline std::vector<MadeEdge> made(const Train& train, std::mt19937_64& rng) {
  std::normal_distribution<double> normal;
  std::vector<MadeEdge> edges;
  for (int turn = 0; turn < train.turns; ++turn) {
    for (std::size_t channel = 0; channel < kPulseChannels; ++channel) {
      const double t_s = (turn + train.phases_turns.at(channel)) * train.period_s;
      edges.push_back({.pulse = {.t = shifted(kStart, t_s + train.noise_s * normal(rng)),
                                 .channel = static_cast<PulseChannel>(channel)},
                       .turn = turn});
    }
  }
  return edges;
}

inline std::vector<MadeEdge> made(const Train& train) {
  std::mt19937_64 rng{50};
  return made(train, rng);
}

inline std::vector<Pulse> pulses_of(const std::vector<MadeEdge>& edges) {
  std::vector<Pulse> pulses(edges.size());
  std::transform(edges.begin(), edges.end(), pulses.begin(),
                 [](const MadeEdge& edge) { return edge.pulse; });
  std::sort(pulses.begin(), pulses.end());
  return pulses;
}

/// Adds what `some` says to `all`.
inline void append(Association& all, const Association& some) {
  const auto add = [](auto& to, const auto& more) {
    to.insert(to.end(), more.begin(), more.end());
  };
  add(all.closed, some.closed);
  add(all.left_over, some.left_over);
  add(all.copies, some.copies);
  add(all.began_to_interfere, some.began_to_interfere);
}

inline Association associate(std::vector<Pulse> pulses,
                             const SpinConfig& config = testing::usual_config()) {
  std::sort(pulses.begin(), pulses.end());
  Associator associator{config};
  Association all;
  for (const Pulse& pulse : pulses) {
    append(all, associator.push(pulse));
  }
  append(all, associator.finish());
  return all;
}

inline Association associate(const std::vector<MadeEdge>& edges) {
  return associate(pulses_of(edges));
}

/// Returns the revolution number of every edge that was assigned to a revolution, or of those
/// alone that are not rejected.
inline std::map<Pulse, std::int64_t> places(const Association& association,
                                            bool good_only = false) {
  std::map<Pulse, std::int64_t> found;
  for (const Revolution& revolution : association.closed) {
    for (std::size_t i = 0; i < kPulseChannels; ++i) {
      const auto channel = static_cast<PulseChannel>(i);
      if (const auto edge = good_only ? revolution.good_edge(channel) : revolution.edge(channel)) {
        found[{.t = *edge, .channel = channel}] = revolution.number;
      }
    }
  }
  return found;
}

inline std::map<Pulse, std::int64_t> good_edges(const Association& association) {
  return places(association, true);
}

/// Expects that every edge was assigned and that all revolution numbers differ from the true turns
/// by the same offset.
inline void expect_every_edge_on_its_turn(const Association& association,
                                          const std::vector<MadeEdge>& edges) {
  const auto found = places(association);
  ASSERT_FALSE(edges.empty());
  ASSERT_TRUE(found.contains(edges.front().pulse));
  const std::int64_t offset = edges.front().turn - found.at(edges.front().pulse);
  for (const MadeEdge& edge : edges) {
    ASSERT_TRUE(found.contains(edge.pulse)) << name_of(edge.pulse.channel) << " " << edge.turn;
    ASSERT_EQ(found.at(edge.pulse) + offset, edge.turn) << name_of(edge.pulse.channel);
  }
}

template <class Condition>
std::vector<MadeEdge> without(std::vector<MadeEdge> edges, const Condition& condition) {
  std::erase_if(edges, condition);
  return edges;
}

}  // namespace spindrift
