#include "tests/support/flight_off_file.h"

#include <gtest/gtest.h>

#include <Eigen/Dense>
#include <algorithm>
#include <cmath>
#include <iostream>

#include "pipelines/frames/angle.h"
#include "pipelines/frames/rotation_vector.h"
#include "pipelines/ground_model/link/chance.h"
#include "pipelines/reconstruction/separation.h"

namespace spindrift::testing {
namespace {

using Eigen::Matrix3d;
using Eigen::Quaterniond;
using Eigen::Vector3d;

Matrix3d gyro_matrix(const AlignmentErrors& errors) {
  Matrix3d gyro = Matrix3d::Identity();
  gyro.diagonal() += errors.segment<3>(GyroScaleError);
  int i = GyroAxisError;
  for (const auto& [row, column] : {std::pair{0, 1}, std::pair{0, 2}, std::pair{1, 0},
                                    std::pair{1, 2}, std::pair{2, 0}, std::pair{2, 1}}) {
    gyro(row, column) += errors[i++];
  }
  return gyro;
}

struct Normalised {
  double squares = 0.0;
  double worst_sigmas = 0.0;  ///< Largest error of an answer that nothing speaks against.
  int doubtful = 0;

  void add(const SeparationFlight& flight, ReconstructionMethod method) {
    const Reconstruction found = reconstruct(flight.request(), method).value();
    const ReconstructedAttitude& at = found.events.front().attitude;
    const Vector3d off = flight.error_rad(0, at.q_icrf_body);
    const double square = off.dot(at.covariance_rad2.llt().solve(off));
    squares += square;
    if (is_unopposed(found.assessment.quality)) {
      worst_sigmas = std::max(worst_sigmas, std::sqrt(square));
    } else {
      ++doubtful;
    }
  }
};

}  // namespace

AlignmentErrors usual_sigmas() {
  AlignmentErrors sigmas = AlignmentErrors::Zero();
  sigmas.segment<3>(StarTrackerError).setConstant(0.01 * kRadPerDeg);
  sigmas.segment<3>(SunSensorError).setConstant(0.2 * kRadPerDeg);
  sigmas.segment<3>(GyroScaleError).setConstant(0.001);
  sigmas.segment<6>(GyroAxisError).setConstant(0.05 * kRadPerDeg);
  sigmas[StarTrackerTimeError] = 0.01;
  sigmas[SunSensorTimeError] = 0.01;
  sigmas.segment<3>(InertiaError).setConstant(0.05);
  return sigmas;
}

AlignmentErrors drawn_errors(const AlignmentErrors& sigmas, std::uint64_t seed) {
  Chance chance{seed};
  AlignmentErrors errors;
  for (int i = 0; i < kAttitudeAlignmentErrors; ++i) {
    errors[i] = sigmas[i] * chance.normal();
  }
  return errors;
}

void put_off(SeparationFlight& flight, const AlignmentErrors& errors,
             const AlignmentErrors& stated_sigmas) {
  const Matrix3d gyro = gyro_matrix(errors);
  for (GyroSample& sample : flight.gyro) {
    sample.rate_body_rad_s =
        gyro * (sample.rate_body_rad_s - flight.bias_rad_s) + flight.bias_rad_s;
  }
  const Quaterniond sun_off = quaternion_by(errors.segment<3>(SunSensorError));
  for (SunDirection& sun : flight.sun) {
    sun.sun_body = sun_off * sun.sun_body;
    sun.t = shifted(sun.t, errors[SunSensorTimeError]);
  }
  const Quaterniond& q_body_sensor = flight.sensors.star_tracker->q_body_sensor;
  const Quaterniond star_off = q_body_sensor.conjugate() *
                               quaternion_by(-errors.segment<3>(StarTrackerError)) * q_body_sensor;
  for (StarFix& fix : flight.stars) {
    fix.q_icrf_sensor = fix.q_icrf_sensor * star_off;
    fix.t = shifted(fix.t, errors[StarTrackerTimeError]);
  }
  Inertia& inertia = *flight.sensors.inertia;
  const Eigen::SelfAdjointEigenSolver<Matrix3d> principal{inertia.kg_m2};
  const Vector3d stated =
      principal.eigenvalues().cwiseQuotient(Vector3d::Ones() + errors.segment<3>(InertiaError));
  inertia.kg_m2 =
      principal.eigenvectors() * stated.asDiagonal() * principal.eigenvectors().transpose();
  inertia.sigma_fraction = stated_sigmas[InertiaError];
  flight.sensors.alignment = stated_sigmas.cwiseAbs2().asDiagonal();
}

void expect_total_sigma(const FlightPlan& plan, int flights, double least, double most) {
  for (const auto method : {ReconstructionMethod::Batch, ReconstructionMethod::Sequential}) {
    Normalised normalised;
    Normalised exact;
    for (int seed = 1; seed <= flights; ++seed) {
      SeparationFlight flight = separation_flight(plan, static_cast<std::uint64_t>(seed));
      exact.add(flight, method);
      put_off(flight, drawn_errors(usual_sigmas(), static_cast<std::uint64_t>(seed) + 1'000'000),
              usual_sigmas());
      normalised.add(flight, method);
    }
    std::cout << name_of(method) << ": normalised squares " << normalised.squares << " of "
              << 3 * flights << ", worst " << normalised.worst_sigmas << " sigmas, "
              << normalised.doubtful << " doubtful, " << exact.doubtful << " with exact files\n";
    EXPECT_GT(normalised.squares, least);
    EXPECT_LT(normalised.squares, most);
    EXPECT_LT(normalised.worst_sigmas, 5.0);
    EXPECT_LE(normalised.doubtful, exact.doubtful + flights / 100);
  }
}

}  // namespace spindrift::testing
