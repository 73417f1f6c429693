/// Cost of a step of the unscented filter without a gyro, from one measured field to the next, and
/// of a bank of eight.

#include <benchmark/benchmark.h>

#include <random>
#include <utility>

#include "pipelines/frames/angle.h"
#include "pipelines/three_axis/unscented/gukf_bank.h"
#include "tests/support/tumbling_body.h"

namespace spindrift {
namespace {

/// The number of states is that of attitude and rate, and three of each kind of error.
testing::TumblingPrior prior_of(std::int64_t states) {
  return {.moments = states > 6 ? 0.05 : 0.0,
          .mounting_rad = states > 12 ? 0.3 * kRadPerDeg : 0.0,
          .bias_nt = states > 9 ? 100.0 : 0.0,
          .torque_nm = states > 15 ? 2e-6 : 0.0};
}

struct Scene {
  explicit Scene(double period_s)
      : body{rng, 2.0 * kRadPerDeg, {}}, period_s{period_s}, first{body.field()} {
    body.advance(period_s);
    second = body.field();
    motion = body.state();
    body.advance(period_s);
    third = body.field();
  }

  std::mt19937_64 rng{1402};
  testing::TumblingBody body;
  double period_s;
  SeenField first;
  SeenField second{};
  SeenField third{};
  BodyState motion{};
  Eigen::Vector3d position_icrf_km = body.position_icrf_km(0.0);
};

/// @param filters Copies of it are stepped, so that each step is that of its start.
template <class Filters>
void step(benchmark::State& state, const Filters& filters, const Scene& scene) {
  for ([[maybe_unused]] const auto iteration : state) {
    Filters now = filters;
    now.propagate(scene.period_s, {}, scene.position_icrf_km);
    benchmark::DoNotOptimize(now.innovation(scene.third));
    now.update(scene.third);
    benchmark::DoNotOptimize(now);
  }
}

void BM_GukfStep(benchmark::State& state) {
  const Scene scene{static_cast<double>(state.range(1))};
  UncertainMotion start{.motion = scene.motion,
                        .covariance = 1e-6 * Eigen::Matrix<double, 6, 6>::Identity()};
  start.covariance.bottomRightCorner<3, 3>() *= 1e-3;
  step(state, Gukf{testing::tumbling_model(prior_of(state.range(0))), start}, scene);
}
BENCHMARK(BM_GukfStep)
    ->ArgNames({"states", "period_s"})
    ->ArgsProduct({{6, 9, 12, 15, 18}, {1, 10}})
    ->Unit(benchmark::kMicrosecond);

/// From nothing, where all filters are far from the truth and differ.
void BM_GukfBank(benchmark::State& state) {
  const Scene scene{static_cast<double>(state.range(1))};
  step(state,
       GukfBank{testing::tumbling_model(prior_of(state.range(0))), scene.first, scene.second,
                scene.period_s},
       scene);
}
BENCHMARK(BM_GukfBank)
    ->ArgNames({"states", "period_s"})
    ->ArgsProduct({{6, 9, 12, 15, 18}, {1, 10}})
    ->Unit(benchmark::kMicrosecond);

}  // namespace
}  // namespace spindrift
