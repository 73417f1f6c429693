/// Cost of a sample in the three-axis pipeline, from its arrival to the resulting attitude.

#include <benchmark/benchmark.h>

#include <random>
#include <variant>
#include <vector>

#include "pipelines/ephemeris/sun.h"
#include "pipelines/three_axis/three_axis_pass.h"
#include "tests/support/turning_body.h"

namespace spindrift {
namespace {

using testing::at_s;

constexpr int kSeconds = 600;

using Sample = std::variant<GyroSample, StarFix, SunDirection>;

/// Returns a gyro at 10 Hz with, unless `gyro_alone`, a star fix and a sun vector at 1 Hz.
std::vector<Sample> pass(bool gyro_alone) {
  std::mt19937_64 rng{1401};
  const ThreeAxisConfig config = testing::usual_three_axis();
  const auto body = testing::TurningBody::smooth(rng, kSeconds, 0.01);
  testing::Sensors sensors{body, config, rng};
  const Eigen::Vector3d sun_icrf = geometric_sun_icrf_km(at_s(0.0)).normalized();
  std::vector<Sample> samples{sensors.star(0.0)};
  for (int i = 0; i < 10 * kSeconds; ++i) {
    samples.push_back(sensors.gyro(0.1 * i));
    if (i % 10 == 5 && !gyro_alone) {
      samples.push_back(sensors.star(0.1 * i));
      samples.push_back(SunDirection{at_s(0.1 * i), sensors.direction(0.1 * i, sun_icrf, 0.01)});
    }
  }
  return samples;
}

void BM_Attitude(benchmark::State& state) {
  const std::vector<Sample> samples = pass(state.range(0) != 0);
  for ([[maybe_unused]] const auto iteration : state) {
    ThreeAxisPass attitude{testing::usual_three_axis(), std::nullopt};
    std::size_t products = 0;
    for (const Sample& sample : samples) {
      products +=
          std::visit([&](const auto& is) { return attitude.push(is); }, sample).products.size();
    }
    benchmark::DoNotOptimize(products);
  }
  state.SetItemsProcessed(state.iterations() * static_cast<std::int64_t>(samples.size()));
}
BENCHMARK(BM_Attitude)->ArgName("gyro_alone")->Arg(1)->Arg(0)->Unit(benchmark::kMillisecond);

}  // namespace
}  // namespace spindrift
