#include <gtest/gtest.h>

#include "pipelines/frames/angle.h"
#include "pipelines/reconstruction/observations.h"
#include "pipelines/reconstruction/separation.h"
#include "pipelines/reconstruction/torque_free_arc.h"
#include "tests/support/separation_flight.h"

namespace spindrift::testing::reconstruction_statistics_test {

using Eigen::Vector3d;

constexpr int kFlights = 400;
// The 95 % band of chi-square with 1200 degrees of freedom.
constexpr double kLeast = 1105.9;
constexpr double kMost = 1297.9;

struct Squares {
  double errors_rad2 = 0.0;
  double normalised = 0.0;
  double bound_rad2 = 0.0;

  void add(const SeparationFlight& flight, const Reconstruction& found, std::size_t event) {
    const ReconstructedEvent& at = found.events[event];
    const Vector3d off = flight.error_rad(event, at.attitude.q_icrf_body);
    errors_rad2 += off.squaredNorm() / kFlights;
    normalised += off.dot(at.attitude.covariance_rad2.llt().solve(off));
    bound_rad2 += std::pow(at.bound_rad.value_or(0.0), 2) / kFlights;
  }
  double rms_deg() const { return degrees(std::sqrt(errors_rad2)); }
};

/// Returns the attitude at T1 integrated from the star fix with the gyro alone.
Eigen::Quaterniond integrated(const SeparationFlight& flight) {
  const Observations all = observations_of(flight.request()).value();
  const std::vector<double> ends{0.0, all.stars.front().t_s};
  const Turn turn = all.rates.turns(ends, Vector3d::Zero()).front();
  const BodyState control_on{all.stars.front().q_icrf_body * turn.turn.conjugate(),
                             all.rates.rate_at(0.0)};
  return torque_free_arc(start_of_arc(control_on), flight.sensors.inertia->kg_m2,
                         -seconds_between(flight.times.separation, all.origin))
      .body.q_icrf_body;
}

TEST(ReconstructionStatistics, BatchIsBestAndKnowsItsErrorOver400Flights) {
  std::array<Squares, 4> batch;
  Squares sequential;
  double gyro_alone_rad2 = 0.0;
  int doubtful = 0;
  for (int seed = 1; seed <= kFlights; ++seed) {
    const SeparationFlight flight = separation_flight({}, static_cast<std::uint64_t>(seed));
    const ReconstructionRequest request = flight.request();
    const Reconstruction found = reconstruct(request, ReconstructionMethod::Batch).value();
    doubtful += found.assessment.quality == Quality::Doubtful ? 1 : 0;
    for (std::size_t event = 0; event < batch.size(); ++event) {
      batch[event].add(flight, found, event);
    }
    sequential.add(flight, reconstruct(request, ReconstructionMethod::Sequential).value(), 0);
    gyro_alone_rad2 += flight.error_rad(0, integrated(flight)).squaredNorm() / kFlights;
  }
  const double gyro_alone_deg = degrees(std::sqrt(gyro_alone_rad2));
  EXPECT_LT(batch[0].rms_deg(), gyro_alone_deg / 3.0);
  EXPECT_LT(batch[0].rms_deg(), sequential.rms_deg() * 2.0 / 3.0);
  for (const Squares& event : batch) {
    EXPECT_LT(event.errors_rad2, 1.1 * 1.1 * event.bound_rad2);
    EXPECT_GT(event.normalised, kLeast);
    EXPECT_LT(event.normalised, kMost);
  }
  EXPECT_GT(sequential.normalised, kLeast);
  EXPECT_LT(sequential.normalised, kMost);
  EXPECT_LT(doubtful, 4);
  std::cout << "T1 rms deg: batch " << batch[0].rms_deg() << ", bound "
            << degrees(std::sqrt(batch[0].bound_rad2)) << ", sequential " << sequential.rms_deg()
            << ", gyro alone " << gyro_alone_deg << "; normalised, of 1200: batch "
            << batch[0].normalised << " " << batch[1].normalised << " " << batch[2].normalised
            << " " << batch[3].normalised << ", sequential " << sequential.normalised << "\n";
}

}  // namespace spindrift::testing::reconstruction_statistics_test
