/// Cost of testing a sample of a three-axis spacecraft against those of the other sensors.

#include <benchmark/benchmark.h>

#include <random>
#include <utility>
#include <variant>
#include <vector>

#include "pipelines/frames/angle.h"
#include "pipelines/three_axis/sensor_contradictions.h"
#include "tests/support/turning_body.h"

namespace spindrift {
namespace {

using testing::at_s;

constexpr int kSeconds = 600;
constexpr double kLimit_s = 1e-6;

struct Turn {
  RateSpan span;
  double variance_rad2;
};
struct Fix {
  TaiTime t;
  ObservedAttitude seen;
};
using Tested = std::variant<Turn, Fix, SeenDirection>;

/// Returns turns of a gyro at 10 Hz, and star fixes and directions to Sun and field `hz` times a
/// second.
std::vector<Tested> pass(int hz) {
  std::mt19937_64 rng{4708};
  const ThreeAxisConfig config = testing::usual_three_axis();
  const auto body = testing::TurningBody::smooth(rng, kSeconds, 0.01);
  testing::Sensors sensors{body, config, rng};
  const Eigen::Vector3d sun_icrf = testing::normal_vector(rng, 1.0).normalized();
  const Eigen::Vector3d field_icrf = sun_icrf.unitOrthogonal();
  constexpr double kDirection_rad = 0.5 * kRadPerDeg;
  constexpr double kField_nt = 40'000.0;
  std::vector<Tested> tested;
  Eigen::Vector3d rate_rad_s = sensors.gyro(0.0).rate_body_rad_s;
  for (int i = 1; i < 10 * kSeconds; ++i) {
    const double t_s = 0.1 * i;
    const Eigen::Vector3d to_rad_s = sensors.gyro(t_s).rate_body_rad_s;
    tested.emplace_back(
        Turn{{.dt_s = 0.1, .from_rad_s = std::exchange(rate_rad_s, to_rad_s), .to_rad_s = to_rad_s},
             1e-12});
    if (i % (10 / hz) == 0) {
      tested.emplace_back(
          Fix{at_s(t_s), {.q_icrf_body = body.q_icrf_body(t_s), .sigma_rad = 1e-4}});
      tested.emplace_back(
          SeenDirection{.t = at_s(t_s),
                        .kind = SampleKind::Sun,
                        .direction = {.body = sensors.direction(t_s, sun_icrf, kDirection_rad),
                                      .ref = sun_icrf,
                                      .sigma_rad = kDirection_rad}});
      tested.emplace_back(
          SeenDirection{.t = at_s(t_s),
                        .kind = SampleKind::Magnetometer,
                        .direction = {.body = sensors.direction(t_s, field_icrf, kDirection_rad),
                                      .ref = kField_nt * field_icrf,
                                      .sigma_rad = kDirection_rad},
                        .stronger = 0.0});
    }
  }
  return tested;
}

void test(SensorContradictions& contradictions, const Turn& turn) {
  contradictions.turn(turn.span, turn.variance_rad2);
}
void test(SensorContradictions& contradictions, const Fix& fix) {
  contradictions.add(fix.t, fix.seen);
}
void test(SensorContradictions& contradictions, const SeenDirection& seen) {
  contradictions.add(seen);
}

void BM_Contradictions(benchmark::State& state) {
  const std::vector<Tested> samples = pass(static_cast<int>(state.range(0)));
  for ([[maybe_unused]] const auto iteration : state) {
    SensorContradictions contradictions{testing::usual_three_axis()};
    for (const Tested& sample : samples) {
      std::visit([&](const auto& is) { test(contradictions, is); }, sample);
    }
    benchmark::DoNotOptimize(contradictions.found());
  }
  const auto count = static_cast<double>(samples.size());
  state.SetItemsProcessed(state.iterations() * static_cast<std::int64_t>(samples.size()));
  // Time of a sample over its limit.
  state.counters["of_limit"] =
      benchmark::Counter(count * kLimit_s, benchmark::Counter::kIsIterationInvariantRate |
                                               benchmark::Counter::kInvert);
}
BENCHMARK(BM_Contradictions)->ArgName("hz")->Arg(1)->Arg(10)->Unit(benchmark::kMillisecond);

}  // namespace
}  // namespace spindrift
