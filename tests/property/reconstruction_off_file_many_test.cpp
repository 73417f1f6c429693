#include <gtest/gtest.h>

#include <Eigen/Dense>

#include "pipelines/frames/angle.h"
#include "pipelines/reconstruction/separation.h"
#include "tests/support/flight_off_file.h"

namespace spindrift::testing::reconstruction_off_file_many_test {

using Eigen::Vector3d;

// The 95 % band of chi-square with 600 degrees of freedom.
constexpr double kLeast = 534.0;
constexpr double kMost = 669.8;
constexpr int kFlights = 200;

TEST(ReconstructionOffFileMany, SigmaHoldsWhatTheMissionFileMayBeOffBy) {
  expect_total_sigma({}, kFlights, kLeast, kMost);
}

/// The noise is so small that the errors of the mission file are most of the sigma.
TEST(ReconstructionOffFileMany, SigmaHoldsItWhereThereIsLittleNoise) {
  expect_total_sigma({.star_fix_step_s = 10.0,
                      .end_s = 400.0,
                      .gyro_noise_deg_s = 2e-4,
                      .bias_sigma_deg_s = 0.001,
                      .sun_noise_deg = 0.05,
                      .star_noise_arcsec = 10.0},
                     kFlights, kLeast, kMost);
}

struct Errors {
  double squares_rad2 = 0.0;
  double worst_sigmas = 0.0;

  void add(const SeparationFlight& flight, ReconstructionMethod method) {
    const Reconstruction found = reconstruct(flight.request(), method).value();
    const ReconstructedAttitude& at = found.events.front().attitude;
    const Vector3d off = flight.error_rad(0, at.q_icrf_body);
    squares_rad2 += off.squaredNorm() / kFlights;
    if (is_unopposed(found.assessment.quality)) {
      worst_sigmas =
          std::max(worst_sigmas, std::sqrt(off.dot(at.covariance_rad2.llt().solve(off))));
    }
  }
  double rms_deg() const { return degrees(std::sqrt(squares_rad2)); }
};

/// Errors of 2.5 and one stated sigmas, always in the same direction.
TEST(ReconstructionOffFileMany, BatchIsNoWorseThanSequentialWhereSunSensorAndInertiaAreOff) {
  AlignmentErrors errors = AlignmentErrors::Zero();
  errors.segment<3>(SunSensorError) = 0.5 * kRadPerDeg * Vector3d{0.6, -0.64, 0.48};
  errors.segment<3>(InertiaError) = Vector3d{0.05, -0.05, 0.05};
  Errors batch;
  Errors sequential;
  for (int seed = 1; seed <= kFlights; ++seed) {
    SeparationFlight flight = separation_flight({}, static_cast<std::uint64_t>(seed));
    put_off(flight, errors, usual_sigmas());
    batch.add(flight, ReconstructionMethod::Batch);
    sequential.add(flight, ReconstructionMethod::Sequential);
  }
  std::cout << "T1 rms deg: batch " << batch.rms_deg() << ", sequential " << sequential.rms_deg()
            << "; worst sigmas " << batch.worst_sigmas << ", " << sequential.worst_sigmas << "\n";
  EXPECT_LE(batch.rms_deg(), sequential.rms_deg());
  EXPECT_LT(batch.worst_sigmas, 5.0);
  EXPECT_LT(sequential.worst_sigmas, 5.0);
}

}  // namespace spindrift::testing::reconstruction_off_file_many_test
