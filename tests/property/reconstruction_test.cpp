#include <gtest/gtest.h>

#include "pipelines/frames/rotation_vector.h"
#include "pipelines/reconstruction/chain_covariance.h"
#include "pipelines/reconstruction/chain_fit.h"
#include "pipelines/reconstruction/chain_solution.h"
#include "pipelines/reconstruction/separation.h"
#include "tests/support/attitude_smoother.h"
#include "tests/support/separation_flight.h"

namespace spindrift::testing::reconstruction_test {

using Eigen::Quaterniond;
using Eigen::Vector3d;

TEST(ReconstructionProperty, RotatesWithItsReference) {
  for (std::uint64_t seed = 1; seed <= 5; ++seed) {
    const SeparationFlight flight = separation_flight({}, seed);
    const Quaterniond turn = quaternion_by(Vector3d{1.3, -0.4, 0.9} * static_cast<double>(seed));
    Observations all = observations_of(flight.request()).value();
    const ChainSolution expected = solution_of(flight.request(), all).value();
    for (StarObservation& star : all.stars) {
      star.q_icrf_body = turn * star.q_icrf_body;
    }
    for (SunObservation& sun : all.sun) {
      sun.sun_icrf = turn * sun.sun_icrf;
    }
    const ChainSolution found = solution_of(flight.request(), all).value();
    for (std::size_t i = 0; i < found.solved.state.q_icrf_body.size(); i += 20) {
      EXPECT_LT(angle_between_rad(turn * expected.solved.state.q_icrf_body[i],
                                  found.solved.state.q_icrf_body[i]),
                1e-7);
    }
  }
}

/// The tolerance allows for the Sun's motion of 1e-8 rad in that time, which moves the attitude
/// farthest from star fixes ten times as much.
TEST(ReconstructionProperty, ShiftsInTime) {
  for (std::uint64_t seed = 1; seed <= 3; ++seed) {
    SeparationFlight flight = separation_flight({}, seed);
    const Reconstruction expected =
        reconstruct(flight.request(), ReconstructionMethod::Batch).value();
    const std::chrono::nanoseconds shift{50'000'123};
    for (auto* const event :
         {&flight.times.control_on, &flight.times.acquisition, &flight.times.first_star_fix}) {
      **event += shift;
    }
    flight.times.separation += shift;
    for (GyroSample& sample : flight.gyro) {
      sample.t += shift;
    }
    for (SunDirection& sample : flight.sun) {
      sample.t += shift;
    }
    for (StarFix& sample : flight.stars) {
      sample.t += shift;
    }
    const Reconstruction found = reconstruct(flight.request(), ReconstructionMethod::Batch).value();
    ASSERT_EQ(found.history.size(), expected.history.size());
    for (std::size_t i = 0; i < found.history.size(); i += 20) {
      EXPECT_EQ(found.history[i].t, expected.history[i].t + shift);
      EXPECT_LT(angle_between_rad(found.history[i].q_icrf_body, expected.history[i].q_icrf_body),
                2e-7);
    }
  }
}

/// Corrupts a request as a link, a sensor or an operator can.
class Spoiler {
 public:
  explicit Spoiler(std::uint64_t seed) : random_{seed} {}

  void spoil(SeparationFlight& flight) {
    for (int i = below(4); i >= 0; --i) {
      switch (below(6)) {
        case 0:
          return spoil_times(flight.times);
        case 1:
          spoil_some(flight.gyro,
                     [](GyroSample& gyro) -> double& { return gyro.rate_body_rad_s.x(); });
          break;
        case 2:
          spoil_some(flight.sun, [](SunDirection& sun) -> double& { return sun.sun_body.y(); });
          break;
        case 3:
          spoil_some(flight.stars, [](StarFix& fix) -> double& { return fix.q_icrf_sensor.w(); });
          break;
        case 4:
          flight.sensors.gyro->range_rad_s = 0.02 * below(3);
          break;
        case 5:
          flight.sensors.inertia.reset();
          break;
      }
    }
  }

 private:
  int below(int end) { return std::uniform_int_distribution<>{0, end - 1}(random_); }

  void spoil_times(SeparationTimes& times) {
    const auto moved = [&](TaiTime t) { return shifted(t, 50.0 * (below(9) - 4)); };
    times.separation = moved(times.separation);
    for (auto* const event : {&times.control_on, &times.acquisition, &times.first_star_fix}) {
      *event = below(3) == 0 ? std::nullopt : std::optional{moved(event->value())};
    }
  }

  template <class Sample, class Member>
  void spoil_some(std::vector<Sample>& samples, Member member) {
    if (samples.empty()) {
      return;
    }
    const int kind = below(6);
    const auto begin = samples.begin() + below(static_cast<int>(samples.size()));
    const auto end = begin + 1 + below(static_cast<int>(samples.end() - begin));
    switch (kind) {
      case 0:
        samples.erase(begin, end);
        break;
      case 1:
        std::reverse(begin, end);
        break;
      case 2:
        std::for_each(begin, end, [&](Sample& sample) { sample.t = begin->t; });
        break;
      case 3:
        std::for_each(begin, end, [&](Sample& sample) { member(sample) = member(*begin); });
        break;
      case 4:
        std::for_each(begin, end, [&](Sample& sample) { sample.t = shifted(sample.t, 400.0); });
        break;
      case 5:
        member(*begin) = below(2) == 0 ? std::nan("") : 1e9;
        break;
    }
  }

  std::mt19937_64 random_;
};

TEST(ReconstructionProperty, OfBadInputIsAnErrorOrFinite) {
  const FlightPlan plan{.first_star_fix_s = 150.0, .star_fix_step_s = 20.0, .end_s = 200.0};
  const SeparationFlight clean = separation_flight(plan, 1);
  int errors = 0;
  int answers = 0;
  for (std::uint64_t seed = 1; seed <= 300; ++seed) {
    SeparationFlight flight = clean;
    Spoiler{seed}.spoil(flight);
    for (const auto method : {ReconstructionMethod::Batch, ReconstructionMethod::Sequential}) {
      const auto found = reconstruct(flight.request(), method);
      if (!found) {
        ++errors;
        EXPECT_FALSE(found.error().message.empty());
        continue;
      }
      ++answers;
      for (const ReconstructedAttitude& attitude : found->history) {
        ASSERT_NEAR(attitude.q_icrf_body.norm(), 1.0, 1e-12) << seed;
        ASSERT_TRUE(attitude.rate_body_rad_s.allFinite()) << seed;
        ASSERT_TRUE(attitude.rate_covariance_rad2_s2.allFinite()) << seed;
        ASSERT_EQ(attitude.covariance_rad2.llt().info(), Eigen::Success) << seed;
      }
    }
  }
  EXPECT_GT(errors, 60);
  EXPECT_GT(answers, 200);
}

TEST(ReconstructionProperty, IsTheSameBitForBit) {
  const SeparationFlight flight = separation_flight({.star_fix_step_s = 10.0, .end_s = 350.0}, 3);
  for (const auto method : {ReconstructionMethod::Batch, ReconstructionMethod::Sequential}) {
    const Reconstruction first = reconstruct(flight.request(), method).value();
    const Reconstruction second = reconstruct(flight.request(), method).value();
    for (std::size_t i = 0; i < first.history.size(); ++i) {
      ASSERT_EQ(first.history[i].q_icrf_body.coeffs(), second.history[i].q_icrf_body.coeffs());
      ASSERT_EQ(first.history[i].covariance_rad2, second.history[i].covariance_rad2);
    }
  }
}

/// Returns the observations without the sun vectors that the solution down-weights.
Observations without_outliers(const SeparationFlight& flight) {
  Observations all = observations_of(flight.request()).value();
  const SolvedChain solved = solution_of(flight.request(), all).value().solved;
  std::erase_if(all.sun, [&](const SunObservation& sun) {
    const Vector3d off =
        predicted_sun(solved.state, {node_at(solved.chain, sun.t_s), sun, Vector3d::Zero()}) -
        sun.measured_body;
    return weight_of(off.squaredNorm() / std::pow(solved.chain.noise.sun_rad, 2)) < 1.0;
  });
  return all;
}

/// With negligible noise and bias the problem is linear and Gaussian, where the smoother is
/// optimal.
TEST(ReconstructionProperty, EqualsTheSmootherWhereThingsAreLinear) {
  const FlightPlan plan{.first_star_fix_s = 60.0,
                        .star_fix_step_s = 80.0,
                        .end_s = 300.0,
                        .gyro_noise_deg_s = 5e-5,
                        .bias_sigma_deg_s = 5e-5,
                        .sun_noise_deg = 0.002,
                        .star_noise_arcsec = 2.0};
  for (std::uint64_t seed = 1; seed <= 5; ++seed) {
    SeparationFlight flight = separation_flight(plan, seed);
    flight.times.acquisition.reset();
    flight.times.first_star_fix.reset();
    const Observations all = without_outliers(flight);
    const ChainSolution found = solution_of(flight.request(), all).value();
    const ChainInformation known = information_of(found.solved.chain, found.solved.state);
    const SharedErrors errors = errors_of(known, found.solved.chain.noise);
    const auto expected = smoothed(all, {.sun_rad = flight.sensors.sun_sensor->noise_rad,
                                         .star_rad = flight.sensors.star_tracker->noise_rad,
                                         .bias_rad_s = flight.sensors.gyro->bias_sigma_rad_s});
    ASSERT_EQ(expected.size(), found.solved.chain.times_s.size());
    double most_sigmas = 0.0;
    for (std::size_t i = 0; i < expected.size(); ++i) {
      const Vector3d off = rotation_vector_of(expected[i].q_icrf_body.conjugate() *
                                              found.solved.state.q_icrf_body[i]);
      const PerShared& slopes = known.per_shared[i];
      const Eigen::Matrix3d found_rad2 =
          known.own_rad2[i] + slopes * errors.total * slopes.transpose();
      most_sigmas = std::max(most_sigmas, std::sqrt(off.dot(found_rad2.llt().solve(off))));
      const Eigen::Matrix3d expected_rad2 = expected[i].covariance.topLeftCorner<3, 3>();
      EXPECT_LT((found_rad2 - expected_rad2).norm(), 1e-3 * expected_rad2.norm()) << i;
    }
    EXPECT_LT(most_sigmas, 1e-3) << seed;
    const Vector3d bias_off = expected.front().bias_rad_s - found.solved.state.bias_rad_s;
    EXPECT_LT(bias_off.norm(), 1e-3 * std::sqrt(errors.total(SharedGyroBias, SharedGyroBias)));
  }
}

}  // namespace spindrift::testing::reconstruction_test
