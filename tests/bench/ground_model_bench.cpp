/// @file
/// Cost of a step of the ground model for the satellite of Zhang 2019 (body in steps of 25 ms with
/// all disturbances; wheels, thrusters, star tracker and noisy gyro at 10 Hz), and cost of a step
/// of a whole flight along its orbit with telemetry.

#include <benchmark/benchmark.h>

#include <optional>
#include <variant>

#include "pipelines/frames/angle.h"
#include "pipelines/ground_model/control/attitude_control.h"
#include "pipelines/ground_model/control/closed_loop.h"
#include "pipelines/ground_model/link/chance.h"
#include "pipelines/ground_model/sensors/three_axis_reading.h"
#include "services/simulation/scenario.h"
#include "tests/support/stepped_body.h"
#include "tests/support/test_paths.h"

namespace spindrift {
namespace {

using Eigen::Vector3d;

constexpr double kStep_s = 0.025;
constexpr int kSteps = 4;
constexpr int kPeriods = 8000;
const Vector3d kMoments_kg_m2{0.6, 1.2, 1.12};

ClosedLoop<SteppedBody> loop_of(const Actuators& actuators) {
  const Disturbances disturbances{
      .gravity_gradient = true,
      .drag =
          Drag{
              .atmosphere = {.density_kg_m3 = 1e-12, .altitude_km = 500.0, .scale_height_km = 60.0},
              .area_m2 = 1.0,
              .coefficient = 2.2,
              .centre_of_pressure_body_m = {0.05, 0.0, 0.02}},
      .dipole_body_a_m2 = {0.1, 0.0, 0.1},
      .constant_body_nm = Vector3d::Constant(1e-6),
      .periodic = {.amplitude_body_nm = Vector3d::Constant(1e-6), .rate_rad_s = 1.1e-3}};
  return {SteppedBody{RigidBody::make(Eigen::Matrix3d{kMoments_kg_m2.asDiagonal()}).value(),
                      {.q_icrf_body = Eigen::Quaterniond::Identity(),
                       .rate_body_rad_s = kRadPerDeg * Vector3d{3.0, -3.0, 3.0}},
                      kStep_s},
          actuators, disturbances, kSteps};
}

AttitudeControl control() {
  const PdGains gains = PdGains::of(kMoments_kg_m2, 0.1, 0.6716);
  return AttitudeControl::make(
             {.control_on_s = 2.0, .damped_rad_s = 0.1 * kRadPerDeg, .pointing_at_s = 100.0},
             RateFeedback{.gain_nms = gains.kd_nms},
             SaturatedPd{.target = {Eigen::Quaterniond{0.7071, 0.7071, 0.0, 0.0}.normalized()},
                         .gains = gains,
                         .error_most = 0.117})
      .value();
}

MeasuredBody read(MeasuredBody truth, Chance& chance) {
  truth.rate_body_rad_s =
      gyro_reading(truth.rate_body_rad_s, chance.normal_vector(3e-5), std::nullopt);
  truth.q_icrf_body =
      star_reading(truth.q_icrf_body, Eigen::Quaterniond::Identity(), chance.normal_vector(1e-4));
  return truth;
}

void measure(benchmark::State& state, const Actuators& actuators) {
  const Surroundings surroundings{
      .spacecraft = {.position_icrf_km = {6900.0, 0.0, 0.0}, .velocity_icrf_km_s = {0.0, 7.6, 0.0}},
      .field_icrf_nt = {10'000.0, -20'000.0, 30'000.0}};
  for ([[maybe_unused]] const auto iteration : state) {
    ClosedLoop<SteppedBody> loop = loop_of(actuators);
    AttitudeControl laws = control();
    Chance chance{1};
    for (int i = 0; i < kPeriods; ++i) {
      const MeasuredBody measured = read(loop.measured(Vector3d::UnitX()), chance);
      loop.fly(laws.torque_body_nm(loop.t_s(), measured), surroundings);
    }
    benchmark::DoNotOptimize(loop.body().last());
  }
  state.SetItemsProcessed(state.iterations() * kPeriods * kSteps);
}

void BM_Wheels(benchmark::State& state) {
  measure(state, Wheels::make({.axes_body = Eigen::Matrix3d::Identity(),
                               .inertia_kg_m2 = 4.77e-4,
                               .torque_nm_most = 0.01,
                               .speed_rad_s_most = 628.0})
                     .value());
}
BENCHMARK(BM_Wheels)->Unit(benchmark::kMillisecond);

void BM_Thrusters(benchmark::State& state) {
  measure(state,
          Thrusters::make({.torque_nm = 0.01, .shortest_s = 0.01, .longest_s = 1.0}).value());
}
BENCHMARK(BM_Thrusters)->Unit(benchmark::kMillisecond);

void BM_WholeFlight(benchmark::State& state) {
  const Scenario scenario = load_scenario(scenarios() / "upper-stage.toml").value();
  const auto& flight = std::get<OrientationScenario>(scenario.flight);
  double steps = 0.0;
  for ([[maybe_unused]] const auto iteration : state) {
    const FlownOrientation whole = flown(flight, scenario.orbit).value();
    steps += whole.body.motion.end_s() / whole.body.motion.step_s();
    benchmark::DoNotOptimize(whole.body.telemetry.gyro.data());
  }
  state.SetItemsProcessed(static_cast<std::int64_t>(steps));
}
BENCHMARK(BM_WholeFlight)->Unit(benchmark::kMillisecond);

}  // namespace
}  // namespace spindrift
