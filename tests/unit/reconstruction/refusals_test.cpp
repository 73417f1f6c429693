#include <functional>
#include <limits>
#include <optional>
#include <vector>

#include "pipelines/reconstruction/separation.h"
#include "tests/support/matchers.h"
#include "tests/support/separation_flight.h"

namespace spindrift::testing::refusals_test {

using enum ErrorCode;

constexpr double kNaN = std::numeric_limits<double>::quiet_NaN();

struct Refusal {
  const char* of;
  std::function<void(SeparationFlight&)> change;
  ErrorCode code;
  const char* words;
};

void set_rates(SeparationFlight& flight, const std::function<void(Eigen::Vector3d&)>& change) {
  for (GyroSample& sample : flight.gyro) {
    change(sample.rate_body_rad_s);
  }
}

const std::vector<Refusal> kRefusals = {
    {"a missing star fix", [](auto& f) { f.stars.clear(); }, Unobservable,
     "nothing can be anchored"},
    {"a star fix before T2 alone", [](auto& f) { f.stars.front().t = f.times.separation; },
     Unobservable, "nothing can be anchored"},
    {"a star fix before T2 alone, without T4",
     [](auto& f) {
       f.stars.front().t = f.times.separation;
       f.times.first_star_fix.reset();
     },
     Unobservable, "nothing can be anchored"},
    {"an arc of too many turns",
     [](auto& f) { set_rates(f, [](auto& rate_rad_s) { rate_rad_s.x() += 1e9; }); }, InvalidInput,
     "cannot be followed back; check the gyro's unit"},
    {"no star tracker", [](auto& f) { f.sensors.star_tracker.reset(); }, Unobservable,
     "nothing can be anchored"},
    {"neither gyro nor star tracker",
     [](auto& f) {
       f.sensors.star_tracker.reset();
       f.sensors.gyro.reset();
     },
     Unobservable, "no gyro"},
    {"T2 and T3 out of order", [](auto& f) { std::swap(f.times.control_on, f.times.acquisition); },
     InvalidInput, "T3 is 2026-03-01T04:01:00.000Z, before T2"},
    {"T2 before the samples",
     [](auto& f) { f.times.control_on = shifted(*f.times.control_on, -10.0); }, InvalidInput,
     "T2 is 2026-03-01T04:00:50.000Z: the gyro samples allow"},
    {"T4 behind the samples",
     [](auto& f) { f.times.first_star_fix = shifted(*f.times.first_star_fix, 10.0); }, InvalidInput,
     "T4 is"},
    {"T1 of 1970", [](auto& f) { f.times.separation = tai_from_ns(0); }, InvalidInput, "T1 is"},
    {"a negative moment of inertia", [](auto& f) { f.sensors.inertia->kg_m2(1, 1) = -100.0; },
     InvalidConfiguration, "-100 kg m2: all three must be above 0"},
    {"an inertia that is not symmetric",
     [](auto& f) {
       f.sensors.inertia->kg_m2(1, 1) = -100.0;
       f.sensors.inertia->kg_m2(0, 1) = 5.0;
     },
     InvalidConfiguration, "symmetric"},
    {"a rate that is no number", [](auto& f) { f.gyro[3].rate_body_rad_s.y() = kNaN; },
     InvalidInput, "the gyro sample of 2026-03-01T04:01:00.750Z is not finite"},
    {"a sun vector that is infinite",
     [](auto& f) { f.sun[3].sun_body.y() = std::numeric_limits<double>::infinity(); }, InvalidInput,
     "the sun sample of"},
    {"a star fix that is no number", [](auto& f) { f.stars[0].q_icrf_sensor.w() = kNaN; },
     InvalidInput, "the star sample of"},
    {"a quaternion of another length", [](auto& f) { f.stars[0].q_icrf_sensor.coeffs() *= 1.01; },
     InvalidInput, "must be 1 within 0.001"},
    {"a sun vector of no length", [](auto& f) { f.sun[5].sun_body.setZero(); }, InvalidInput,
     "the sun vector of"},
    {"noise that is none", [](auto& f) { f.sensors.gyro->noise_rad_s = 0.0; }, InvalidConfiguration,
     "must be finite and above 0"},
    {"a gyro that is frozen throughout",
     [](auto& f) {
       const Eigen::Vector3d first_rad_s = f.gyro.front().rate_body_rad_s;
       set_rates(f, [&](auto& rate_rad_s) { rate_rad_s = first_rad_s; });
     },
     Unobservable, "960 frozen and 0 off"}};

TEST(ReconstructRefuses, WhatCannotBeReconstructed) {
  const SeparationFlight sound = separation_flight({}, 1);
  for (const Refusal& refusal : kRefusals) {
    SCOPED_TRACE(refusal.of);
    SeparationFlight flight = sound;
    refusal.change(flight);
    for (const auto method : {ReconstructionMethod::Batch, ReconstructionMethod::Sequential}) {
      EXPECT_THAT(reconstruct(flight.request(), method),
                  IsRefused(refusal.code, HasSubstr(refusal.words)));
    }
  }
}

/// Degrees are sent for radians; in some flights the solver then finds no minimum.
TEST(ReconstructBatchRefuses, SamplesThatNoAttitudeExplainsAndNamesTheSensor) {
  std::optional<Error> error;
  for (std::uint64_t seed = 1; seed <= 20 && !error; ++seed) {
    SeparationFlight flight = separation_flight({.star_fix_step_s = 10.0, .end_s = 400.0}, seed);
    for (GyroSample& sample : flight.gyro) {
      sample.rate_body_rad_s *= 57.3;
    }
    const auto found = reconstruct(flight.request(), ReconstructionMethod::Batch);
    error = found ? std::nullopt : std::optional{found.error()};
  }
  ASSERT_TRUE(error);
  EXPECT_EQ(error->code, Unobservable);
  EXPECT_THAT(error->message, HasSubstr("is furthest off, by"));
  EXPECT_THAT(error->message, HasSubstr("in the mission file"));
}

}  // namespace spindrift::testing::refusals_test
