#include <algorithm>
#include <array>
#include <cmath>
#include <cstdint>
#include <random>
#include <vector>

#include "pipelines/spin/association/association.h"
#include "pipelines/spin/telemetry_order/interference.h"
#include "tests/support/edge_train.h"
#include "tests/support/matchers.h"

namespace spindrift::testing::association_interference_test {

using enum PulseChannel;

constexpr double kPeriod_s = 1.0;
constexpr int kTurns = 600;

/// Describes a crossing: south_out comes `apart_s` after north_out, and `drift_s` later each turn.
struct Crossing {
  double window_s;
  double apart_s;
  double drift_s;
};

struct Edge {
  int turn;
  double t_s;
  PulseChannel channel;
  double noise_s;  ///< Timing error of the edge apart from interference.
  bool met = false;
};

double apart_s(const Crossing& crossing, int turn) {
  return crossing.apart_s + turn * crossing.drift_s;
}

std::vector<Edge> edges_of(const Crossing& crossing, const PulseNoise& noise,
                           std::mt19937_64& rng) {
  std::normal_distribution<double> normal;
  std::vector<Edge> edges;
  for (int turn = 0; turn < kTurns; ++turn) {
    const std::array<double, kPulseChannels> behind_s = {
        0.0, 0.11, 0.40, 0.52, 0.43, 0.52 + apart_s(crossing, turn)};
    for (std::size_t i = 0; i < kPulseChannels; ++i) {
      const auto channel = static_cast<PulseChannel>(i);
      const double off_s = edge_sigma_s(noise, channel) * normal(rng);
      edges.push_back({.turn = turn,
                       .t_s = turn * kPeriod_s + behind_s.at(i) + off_s,
                       .channel = channel,
                       .noise_s = off_s});
    }
  }
  return edges;
}

/// Displaces north_out and south_out (index 3 and 5) in every turn in which they are too close.
void interfere(double window_s, std::vector<Edge>& edges, std::mt19937_64& rng) {
  std::uniform_real_distribution<double> half{-0.5 * window_s, 0.5 * window_s};
  for (std::size_t i = 0; i < edges.size(); i += kPulseChannels) {
    Edge& north = edges[i + 3];
    Edge& south = edges[i + 5];
    if (std::abs(north.t_s - south.t_s) < window_s) {
      north.met = south.met = true;
      north.t_s += half(rng);
      south.t_s += half(rng);
    }
  }
}

struct Outcome {
  int met_and_good = 0;
  int good_far_apart = 0;
  int far_apart = 0;
  int good = 0;  ///< Good edges among the two channels.
  int others = 0;
  double off_sigmas = 0.0;  ///< Sum of the errors away from the other edge, sigma.
  std::vector<InterferingChannels> began;
  std::vector<InterferingChannels> interfering;
};

Association associate(const std::vector<Edge>& edges, const SpinConfig& config, Outcome& outcome) {
  std::vector<Pulse> pulses;
  for (const Edge& edge : edges) {
    pulses.push_back({.t = shifted(tai_from_ns(0), edge.t_s), .channel = edge.channel});
  }
  std::ranges::sort(pulses);
  InterferenceWindow window{config.screening.interference_s};
  Associator associator{config};
  Association all;
  const auto associate_all = [&](const std::vector<InterferenceWindow::Judged>& judged) {
    for (const auto& [pulse, spoilt_by] : judged) {
      append(all, spoilt_by ? associator.push_spoilt(pulse, *spoilt_by) : associator.push(pulse));
    }
  };
  for (const Pulse& pulse : pulses) {
    associate_all(window.push(pulse));
  }
  associate_all(window.finish());
  append(all, associator.finish());
  outcome.began = all.began_to_interfere;
  outcome.interfering = associator.interfering();
  return all;
}

void expect_gaps_of_spoilt_edges(const Association& all) {
  for (const Revolution& revolution : all.closed) {
    for (std::size_t i = 0; i < kPulseChannels; ++i) {
      const auto& gap = revolution.edge_gaps.at(i);
      ASSERT_EQ(gap.has_value(), revolution.edge_rejections.at(i) == Rejection::Interference);
      ASSERT_TRUE(!gap || gap->gap_s < gap->least_s);
    }
  }
}

Outcome outcome_of(const Crossing& crossing, const std::vector<Edge>& edges) {
  SpinConfig config = usual_config();
  config.screening.interference_s = crossing.window_s;
  Outcome outcome;
  const Association all = associate(edges, config, outcome);
  expect_gaps_of_spoilt_edges(all);
  const auto good = good_edges(all);
  const double noise_s = config.noise.infrared_s;
  const double far_s = crossing.window_s + 4.0 * std::hypot(noise_s, noise_s);
  for (const Edge& edge : edges) {
    const bool is_good =
        good.contains({.t = shifted(tai_from_ns(0), edge.t_s), .channel = edge.channel});
    if (edge.channel != NorthOut && edge.channel != SouthOut) {
      outcome.others += is_good ? 1 : 0;
      continue;
    }
    const double apart = apart_s(crossing, edge.turn);
    const bool far = std::abs(apart) > far_s;
    outcome.far_apart += far ? 1 : 0;
    outcome.good_far_apart += far && is_good ? 1 : 0;
    outcome.good += is_good ? 1 : 0;
    outcome.met_and_good += edge.met && is_good ? 1 : 0;
    const bool behind = (edge.channel == SouthOut) == (apart > 0.0);
    outcome.off_sigmas += is_good ? (behind ? 1.0 : -1.0) * edge.noise_s / noise_s : 0.0;
  }
  return outcome;
}

Outcome outcome_of(const Crossing& crossing, std::uint64_t seed) {
  std::mt19937_64 rng{seed};
  std::vector<Edge> edges = edges_of(crossing, usual_config().noise, rng);
  interfere(crossing.window_s, edges, rng);
  return outcome_of(crossing, edges);
}

// The kept edges are selected for a large separation. At 2.5 sigma beyond the window this biases an
// edge by 0.0125 sigma, further out by less: no more than the standard error of the mean over these
// passes, of which three are allowed.
TEST(AssociationInterference, WhatIsKeptIsNeitherSpoiltNorBiased) {
  for (const Crossing& crossing :
       {Crossing{0.002, -0.0005, 1.2e-5}, Crossing{0.002, 0.0, 2.0e-5},
        Crossing{0.004, -0.001, 2.0e-5}, Crossing{0.008, -0.014, 5e-5}}) {
    SCOPED_TRACE(crossing.window_s);
    SCOPED_TRACE(crossing.drift_s);
    int good = 0;
    int met_and_good = 0;
    double off_sigmas = 0.0;
    for (std::uint64_t seed = 0; seed < 20; ++seed) {
      const Outcome outcome = outcome_of(crossing, 900 + seed);
      good += outcome.good;
      met_and_good += outcome.met_and_good;
      off_sigmas += outcome.off_sigmas;
    }
    ASSERT_GT(good, 1000);
    EXPECT_LT(met_and_good, good / 500);
    EXPECT_LT(std::abs(off_sigmas), 4.0 * std::sqrt(good));
  }
}

// Displaced edges are set aside while the count begins; then nearly all edges that could correct
// south_out are displaced.
TEST(AssociationInterference, AChannelLearntFromWrongEdgesIsPutRightBySpoiltOnes) {
  const Crossing crossing{.window_s = 0.008, .apart_s = -0.002, .drift_s = 0.0};
  constexpr std::array kWrong_s = {0.028, -0.035, -0.039};
  int met_and_good = 0;
  for (std::uint64_t seed = 0; seed < 20; ++seed) {
    std::mt19937_64 rng{940 + seed};
    std::vector<Edge> edges = edges_of(crossing, usual_config().noise, rng);
    for (std::size_t i = 0; i < kWrong_s.size(); ++i) {
      edges.at((6 + i) * kPulseChannels + index_of(SouthOut)).t_s += kWrong_s.at(i);
    }
    interfere(crossing.window_s, edges, rng);
    met_and_good += outcome_of(crossing, edges).met_and_good;
  }
  EXPECT_LT(met_and_good, 10);  // 24,000 edges; the count is 199 if displaced edges are not used.
}

TEST(AssociationInterference, NothingIsLeftOutWhereChannelsAreFarFromEachOther) {
  for (const double drift_s : {2e-5, 5e-5}) {
    SCOPED_TRACE(drift_s);
    const Outcome outcome =
        outcome_of({.window_s = 0.002, .apart_s = 0.0, .drift_s = drift_s}, 930);
    EXPECT_GE(outcome.good_far_apart, outcome.far_apart * 98 / 100);
    EXPECT_GE(outcome.others, 4 * kTurns * 98 / 100);
  }
}

TEST(AssociationInterference, SaysWhichChannelsInterferedAndForHowLong) {
  const Outcome outcome = outcome_of({.window_s = 0.002, .apart_s = 0.0, .drift_s = 2e-5}, 931);
  ASSERT_EQ(outcome.began.size(), 1U);
  ASSERT_EQ(outcome.interfering.size(), 1U);
  const InterferingChannels& channels = outcome.interfering.front();
  EXPECT_EQ(channels.one, NorthOut);
  EXPECT_EQ(channels.other, SouthOut);
  // The effect lasts until 2.5 sigma beyond the window, where nothing exceeds a sigma.
  const double sigma_s = std::hypot(5e-4, 5e-4);
  EXPECT_GT(channels.revolutions, static_cast<std::int64_t>((0.002 + 1.5 * sigma_s) / 2e-5));
  EXPECT_LT(channels.revolutions, static_cast<std::int64_t>((0.002 + 3.5 * sigma_s) / 2e-5));
  EXPECT_LT(channels.first, channels.last);
}

TEST(AssociationInterference, WithoutAWindowNobodyInterferes) {
  const Outcome outcome = outcome_of({.window_s = 0.0, .apart_s = 0.0, .drift_s = 1e-6}, 932);
  EXPECT_TRUE(outcome.interfering.empty());
  EXPECT_GE(outcome.good, 2 * kTurns * 98 / 100);
}

}  // namespace spindrift::testing::association_interference_test
