/// @file
/// Cost of a reconstruction from rates at 10 Hz and sun vectors at 1 Hz over 0.25, 1, 4 and 10 h,
/// with one star fix at the end or one every quarter of an hour. Over hours the former leaves the
/// rotation about the Sun uncertain by half a turn, which takes more iterations.

#include <benchmark/benchmark.h>

#include "pipelines/reconstruction/separation.h"
#include "tests/support/separation_flight.h"

namespace spindrift {
namespace {

/// Time of T2.
constexpr double kControlOn_s = 60.0;

ReconstructionRequest one_fix_at_the_end(double length_s) {
  const double end_s = kControlOn_s + length_s;
  return testing::separation_flight({.first_star_fix_s = end_s, .end_s = end_s, .gyro_step_s = 0.1},
                                    1)
      .request();
}

ReconstructionRequest many_fixes(double length_s) {
  constexpr double kStep_s = 900.0;
  return testing::separation_flight({.first_star_fix_s = kControlOn_s + kStep_s,
                                     .star_fix_step_s = kStep_s,
                                     .end_s = kControlOn_s + length_s,
                                     .gyro_step_s = 0.1},
                                    1)
      .request();
}

void measure(benchmark::State& state, ReconstructionRequest request, ReconstructionMethod method,
             bool node_at_every_gyro_sample) {
  request.node_at_every_gyro_sample = node_at_every_gyro_sample;
  for (auto _ : state) {
    benchmark::DoNotOptimize(reconstruct(request, method));
  }
  state.counters["gyro"] = static_cast<double>(request.gyro.size());
  state.SetComplexityN(state.range(0));
}

void batch(benchmark::State& state, ReconstructionRequest (*flight)(double),
           bool node_at_every_gyro_sample) {
  measure(state, flight(static_cast<double>(state.range(0))), ReconstructionMethod::Batch,
          node_at_every_gyro_sample);
}

void sequential(benchmark::State& state) {
  measure(state, one_fix_at_the_end(static_cast<double>(state.range(0))),
          ReconstructionMethod::Sequential, false);
}

void sizes(benchmark::internal::Benchmark* bench) {
  bench->Arg(900)->Arg(3600)->Arg(14400)->Arg(36000)->Unit(benchmark::kMillisecond);
  bench->Complexity(benchmark::oN);
}

BENCHMARK_CAPTURE(batch, node_at_every_sample, many_fixes, true)->Apply(sizes);
BENCHMARK_CAPTURE(batch, node_at_every_sun_vector, many_fixes, false)->Apply(sizes);
BENCHMARK_CAPTURE(batch, one_fix_node_at_every_sample, one_fix_at_the_end, true)
    ->Arg(600)
    ->Arg(3600)
    ->Unit(benchmark::kMillisecond);
BENCHMARK(sequential)->Arg(600)->Arg(3600)->Unit(benchmark::kMillisecond);

}  // namespace
}  // namespace spindrift
