#include <gmock/gmock.h>
#include <gtest/gtest.h>

#include <limits>
#include <optional>

#include "pipelines/reconstruction/separation.h"
#include "tests/support/separation_flight.h"

namespace spindrift::refusals_test {

using ::testing::HasSubstr;
using testing::separation_flight;
using testing::SeparationFlight;

constexpr double kNaN = std::numeric_limits<double>::quiet_NaN();

class ReconstructRefuses : public ::testing::Test {
 protected:
  void refuses(ErrorCode code, const char* words) const {
    for (const auto method : {ReconstructionMethod::Batch, ReconstructionMethod::Sequential}) {
      const auto found = reconstruct(flight_.request(), method);
      ASSERT_FALSE(found) << words;
      EXPECT_EQ(found.error().code, code) << found.error().message;
      EXPECT_THAT(found.error().message, HasSubstr(words));
    }
  }

  SeparationFlight flight_ = separation_flight({}, 1);
};

TEST_F(ReconstructRefuses, AMissingStarFix) {
  flight_.stars.clear();
  refuses(ErrorCode::Unobservable, "nothing can be anchored");
}

TEST_F(ReconstructRefuses, AStarFixBeforeControlOnAlone) {
  flight_.stars.front().t = flight_.times.separation;
  refuses(ErrorCode::Unobservable, "nothing can be anchored");
  flight_.times.first_star_fix.reset();
  refuses(ErrorCode::Unobservable, "nothing can be anchored");
}

TEST_F(ReconstructRefuses, AnArcOfTooManyTurns) {
  for (GyroSample& sample : flight_.gyro) {
    sample.rate_body_rad_s.x() += 1e9;
  }
  refuses(ErrorCode::InvalidInput, "cannot be followed back; check the gyro's unit");
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
  EXPECT_EQ(error->code, ErrorCode::Unobservable);
  EXPECT_THAT(error->message, HasSubstr("is furthest off, by"));
  EXPECT_THAT(error->message, HasSubstr("in the mission file"));
}

TEST_F(ReconstructRefuses, AMissionWithoutGyroOrStarTracker) {
  flight_.sensors.star_tracker.reset();
  refuses(ErrorCode::Unobservable, "nothing can be anchored");
  flight_.sensors.gyro.reset();
  refuses(ErrorCode::Unobservable, "no gyro");
}

TEST_F(ReconstructRefuses, TimesOutOfOrder) {
  std::swap(flight_.times.control_on, flight_.times.acquisition);
  refuses(ErrorCode::InvalidInput, "T3 is 2026-03-01T04:01:00.000Z, before T2");
}

TEST_F(ReconstructRefuses, TimesOutsideTheSamples) {
  flight_.times.control_on = shifted(*flight_.times.control_on, -10.0);
  refuses(ErrorCode::InvalidInput, "T2 is 2026-03-01T04:00:50.000Z: the gyro samples allow");
  flight_ = separation_flight({}, 1);
  flight_.times.first_star_fix = shifted(*flight_.times.first_star_fix, 10.0);
  refuses(ErrorCode::InvalidInput, "T4 is");
  flight_ = separation_flight({}, 1);
  flight_.times.separation = tai_from_ns(0);
  refuses(ErrorCode::InvalidInput, "T1 is");
}

TEST_F(ReconstructRefuses, AnInertiaThatIsNotPositiveDefinite) {
  flight_.sensors.inertia->kg_m2(1, 1) = -100.0;
  refuses(ErrorCode::InvalidConfiguration, "-100 kg m2: all three must be above 0");
  flight_.sensors.inertia->kg_m2(0, 1) = 5.0;
  refuses(ErrorCode::InvalidConfiguration, "symmetric");
}

TEST_F(ReconstructRefuses, SamplesThatAreNotFinite) {
  flight_.gyro[3].rate_body_rad_s.y() = kNaN;
  refuses(ErrorCode::InvalidInput, "the gyro sample of 2026-03-01T04:01:00.750Z is not finite");
  flight_ = separation_flight({}, 1);
  flight_.sun[3].sun_body.y() = std::numeric_limits<double>::infinity();
  refuses(ErrorCode::InvalidInput, "the sun sample of");
  flight_ = separation_flight({}, 1);
  flight_.stars[0].q_icrf_sensor.w() = kNaN;
  refuses(ErrorCode::InvalidInput, "the star sample of");
}

TEST_F(ReconstructRefuses, WhatIsNotOfUnitLength) {
  flight_.stars[0].q_icrf_sensor.coeffs() *= 1.01;
  refuses(ErrorCode::InvalidInput, "must be 1 within 0.001");
  flight_ = separation_flight({}, 1);
  flight_.sun[5].sun_body.setZero();
  refuses(ErrorCode::InvalidInput, "the sun vector of");
}

TEST_F(ReconstructRefuses, NoiseThatIsNone) {
  flight_.sensors.gyro->noise_rad_s = 0.0;
  refuses(ErrorCode::InvalidConfiguration, "must be finite and above 0");
}

TEST_F(ReconstructRefuses, AGyroThatIsFrozenThroughout) {
  for (GyroSample& sample : flight_.gyro) {
    sample.rate_body_rad_s = flight_.gyro.front().rate_body_rad_s;
  }
  refuses(ErrorCode::Unobservable, "960 frozen and 0 off");
}

}  // namespace spindrift::refusals_test
