// A step of the model allocates no heap memory, which a replaced operator new counts.

#include <cstddef>
#include <cstdlib>
#include <new>

#include "pipelines/frames/angle.h"
#include "pipelines/ground_model/control/attitude_control.h"
#include "pipelines/ground_model/control/closed_loop.h"
#include "tests/support/matchers.h"
#include "tests/support/stepped_body.h"

namespace spindrift::allocation_test {

using Eigen::Vector3d;

std::size_t taken = 0;

void* counted(std::size_t size) {
  ++taken;
  return std::malloc(size);
}

}  // namespace spindrift::allocation_test

void* operator new(std::size_t size) {
  void* const memory = spindrift::allocation_test::counted(size);
  return memory != nullptr ? memory : throw std::bad_alloc{};
}
void* operator new(std::size_t size, const std::nothrow_t& /*tag*/) noexcept {
  return spindrift::allocation_test::counted(size);
}
void operator delete(void* memory) noexcept { std::free(memory); }
void operator delete(void* memory, std::size_t /*size*/) noexcept { std::free(memory); }
void operator delete(void* memory, const std::nothrow_t& /*tag*/) noexcept { std::free(memory); }

namespace spindrift::allocation_test {

const Vector3d kMoments_kg_m2{0.6, 1.2, 1.12};

WheelDesign pyramid() {
  WheelDesign four{.axes_body = WheelAxes{3, 4},
                   .inertia_kg_m2 = 4.8e-4,
                   .torque_nm_most = 0.01,
                   .speed_rad_s_most = 628.0};
  four.axes_body << 1.0, 0.0, -1.0, 0.0,  //
      0.0, 1.0, 0.0, -1.0,                //
      1.0, 1.0, 1.0, 1.0;
  return four;
}

std::size_t taken_in_flight(const Actuators& actuators) {
  const Eigen::Matrix3d inertia_kg_m2 = kMoments_kg_m2.asDiagonal();
  ClosedLoop<SteppedBody> loop{
      SteppedBody{RigidBody::make(inertia_kg_m2).value(),
                  {.q_icrf_body = Eigen::Quaterniond::Identity(),
                   .rate_body_rad_s = kRadPerDeg * Vector3d{3.0, -3.0, 3.0}},
                  0.025},
      actuators,
      {.gravity_gradient = true,
       .drag = Drag{.atmosphere = {.density_kg_m3 = 1e-12},
                    .area_m2 = 1.0,
                    .coefficient = 2.2,
                    .centre_of_pressure_body_m = {0.1, 0.0, 0.0}}},
      4};
  const PdGains gains = PdGains::of(kMoments_kg_m2, 0.1, 0.67);
  AttitudeControl control =
      AttitudeControl::make({.control_on_s = 2.0, .damped_rad_s = 0.002, .pointing_at_s = 30.0},
                            RateFeedback{.gain_nms = gains.kd_nms},
                            SaturatedPd{.target = {Eigen::Quaterniond{0.6, 0.8, 0.0, 0.0}},
                                        .gains = gains,
                                        .error_most = 0.1})
          .value();
  const Surroundings surroundings{.spacecraft = {.position_icrf_km = {7000.0, 0.0, 0.0},
                                                 .velocity_icrf_km_s = {0.0, 7.5, 0.0}}};
  const std::size_t before = taken;
  while (loop.t_s() < 60.0) {
    loop.fly(control.torque_body_nm(loop.t_s(), loop.measured(Vector3d::UnitX())), surroundings);
  }
  return taken - before;
}

TEST(GroundModel, TakesNothingFromTheHeapInAStep) {
  EXPECT_EQ(taken_in_flight(Wheels::make(pyramid()).value()), 0U);
  EXPECT_EQ(taken_in_flight(
                Thrusters::make({.torque_nm = 0.01, .shortest_s = 0.01, .longest_s = 1.0}).value()),
            0U);
  const std::size_t before = taken;
  const std::vector<double> one(1);
  EXPECT_GT(taken, before);
}

}  // namespace spindrift::allocation_test
