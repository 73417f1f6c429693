/// Cost of associating a revolution of six edges, from its first edge to its closing.

#include <benchmark/benchmark.h>

#include <algorithm>
#include <array>
#include <random>
#include <vector>

#include "pipelines/spin/association/association.h"
#include "tests/support/spinning_body.h"

namespace spindrift {
namespace {

constexpr int kTurns = 2000;

std::vector<Pulse> pass() {
  constexpr std::array<double, kPulseChannels> kPhases = {0.0, 0.11, 0.40, 0.52, 0.41, 0.55};
  const TaiTime start = tai_from_ns(1'795'143'637'000'000'000);
  std::mt19937_64 rng{401};
  std::normal_distribution<double> noise_s{0.0, 1e-4};
  std::vector<Pulse> pulses;
  for (int turn = 0; turn < kTurns; ++turn) {
    for (std::size_t channel = 0; channel < kPulseChannels; ++channel) {
      pulses.push_back({.t = shifted(start, 0.6 * (turn + kPhases.at(channel)) + noise_s(rng)),
                        .channel = static_cast<PulseChannel>(channel)});
    }
  }
  std::sort(pulses.begin(), pulses.end());
  return pulses;
}

void BM_Associate(benchmark::State& state) {
  const std::vector<Pulse> pulses = pass();
  for ([[maybe_unused]] const auto iteration : state) {
    Associator associator{testing::usual_config()};
    std::size_t closed = 0;
    for (const Pulse& pulse : pulses) {
      closed += associator.push(pulse).closed.size();
    }
    benchmark::DoNotOptimize(closed);
  }
  state.SetItemsProcessed(state.iterations() * kTurns);
}
BENCHMARK(BM_Associate)->Unit(benchmark::kMillisecond);

}  // namespace
}  // namespace spindrift
