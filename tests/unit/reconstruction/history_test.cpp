#include "pipelines/reconstruction/history.h"

#include <Eigen/Dense>
#include <Eigen/Geometry>
#include <cmath>
#include <optional>
#include <vector>

#include "pipelines/frames/rotation_vector.h"
#include "tests/support/matchers.h"

namespace spindrift::history_test {

using Eigen::Matrix3d;
using Eigen::Quaterniond;
using Eigen::Vector3d;
using enum SeparationEvent;

const TaiTime kControlOn = tai_from_ns(1'795'143'637'000'000'000);
TaiTime at_s(double t_s) { return shifted(kControlOn, t_s); }

const Vector3d kBias_rad_s{1e-3, -2e-3, 5e-4};
const Quaterniond kFirst = Quaterniond{0.3, -0.5, 0.7, 0.4}.normalized();

struct Flight {
  double arc_s = 30.0;  ///< Time from T1 to T2.
  Vector3d rate_rad_s{0.01, -0.02, 0.005};
  std::optional<Inertia> inertia =
      Inertia{.kg_m2 = Vector3d{100.0, 100.0, 140.0}.asDiagonal(), .sigma_fraction = 0.0};
  double disturbance_rad_s2 = 0.0;
  double first_sample_s = 0.0;

  /// Returns observations of T1 to T4 with nodes every two seconds and at T3.
  Observations observed() const {
    std::vector<TimedRate> samples;
    for (double t_s = first_sample_s; t_s <= 20.0; t_s += 1.0) {
      samples.push_back({t_s, rate_rad_s + kBias_rad_s});
    }
    return {.origin = kControlOn,
            .events = {{Separation, at_s(-arc_s), false},
                       {ControlOn, at_s(0.0), true},
                       {Acquisition, at_s(5.0), true},
                       {FirstStarFix, at_s(20.0), false}},
            .rates = RateTrack{samples, 0.0, 20.0, kNoise_rad_s}};
  }
  ReconstructionRequest request() const {
    ReconstructionRequest request{.sensors = {},
                                  .times = {.separation = at_s(-arc_s)},
                                  .gyro = {},
                                  .sun_directions = {},
                                  .star_fixes = {}};
    request.sensors.inertia = inertia;
    request.disturbance_rad_s2 = disturbance_rad_s2;
    return request;
  }
  NodeEstimates nodes() const {
    NodeEstimates nodes{
        .times_s = {0.0, 2.0, 4.0, 5.0, 6.0, 8.0, 20.0},
        .q_icrf_body = {},
        .own_rad2 = {},
        .per_shared = std::vector<PerShared>(7, PerShared::Zero()),
        .bias_rad_s = kBias_rad_s,
        .shared = {.total = file_errors, .noise = decltype(SharedErrors::noise)::Zero()},
        .gyro_noise_rad_s = kNoise_rad_s};
    nodes.shared.total.block<3, 3>(SharedGyroBias, SharedGyroBias) = bias_covariance_rad2_s2;
    nodes.shared.noise.block<3, 3>(SharedGyroBias, SharedGyroBias) = bias_covariance_rad2_s2;
    nodes.per_shared.front() = start_per_shared;
    for (const double t_s : nodes.times_s) {
      nodes.q_icrf_body.push_back(kFirst * quaternion_by(t_s * rate_rad_s));
      nodes.own_rad2.push_back((1.0 + t_s) * first_covariance_rad2);
    }
    return nodes;
  }
  History history() const { return history_of(request(), observed(), nodes()); }

  static constexpr double kNoise_rad_s = 3e-5;
  Matrix3d first_covariance_rad2 = Vector3d{1e-6, 4e-6, 9e-6}.asDiagonal();
  Matrix3d bias_covariance_rad2_s2 = Vector3d{1e-10, 4e-10, 2e-10}.asDiagonal();
  PerShared start_per_shared = PerShared::Zero();
  SharedCovariance file_errors = SharedCovariance::Zero();
};

TEST(History, BehindT2ItIsWhatTheNodesSay) {
  const Flight flight;
  const auto attitudes = flight.history().attitudes;
  const NodeEstimates nodes = flight.nodes();
  ASSERT_EQ(attitudes.size(), 30 + nodes.times_s.size());
  const Matrix3d rate_covariance =
      flight.bias_covariance_rad2_s2 + std::pow(Flight::kNoise_rad_s, 2) * Matrix3d::Identity();
  for (std::size_t i = 0; i < nodes.times_s.size(); ++i) {
    const ReconstructedAttitude& one = attitudes[30 + i];
    EXPECT_EQ(one.t, at_s(nodes.times_s[i]));
    EXPECT_EQ(one.q_icrf_body.coeffs(), nodes.q_icrf_body[i].coeffs());
    EXPECT_EQ(one.covariance_rad2, nodes.own_rad2[i]);
    EXPECT_LT((one.rate_body_rad_s - flight.rate_rad_s).norm(), 1e-14);
    EXPECT_LT((one.rate_covariance_rad2_s2 - rate_covariance).norm(), 1e-20);
  }
}

TEST(History, FromT1OnTimesRiseAndPointsAreASecondApartOrMore) {
  for (const double arc_s : {0.4, 1.0, 1.9, 30.0, 60.0, 61.0, 600.0}) {
    Flight flight;
    flight.arc_s = arc_s;
    const auto attitudes = flight.history().attitudes;
    EXPECT_EQ(attitudes.front().t, at_s(-arc_s));
    const std::size_t arc = attitudes.size() - flight.nodes().times_s.size();
    EXPECT_LE(arc, 60U);
    EXPECT_GE(static_cast<double>(arc), std::min(60.0, std::floor(arc_s)));
    for (std::size_t i = 1; i < attitudes.size(); ++i) {
      const double step_s = seconds_between(attitudes[i - 1].t, attitudes[i].t);
      EXPECT_GT(step_s, 0.0);
      if (i <= arc && arc_s >= 1.0) {
        EXPECT_GE(step_s, 1.0 - 1e-9);
        EXPECT_NEAR(step_s, arc_s / static_cast<double>(arc), 1e-6);
      }
    }
  }
}

TEST(History, WhereT1IsT2ThereIsNoArc) {
  Flight flight;
  flight.arc_s = 0.0;
  const History history = flight.history();
  EXPECT_EQ(history.attitudes.size(), flight.nodes().times_s.size());
  EXPECT_EQ(history.events, (std::vector<std::size_t>{0, 0, 3, 6}));
}

TEST(History, ItsEventsAreTheAttitudesOfTheirTimes) {
  const Flight flight;
  const Observations all = flight.observed();
  const History history = flight.history();
  const auto events = events_of(all, history);
  ASSERT_EQ(events.size(), all.events.size());
  for (std::size_t i = 0; i < events.size(); ++i) {
    EXPECT_EQ(events[i].event, all.events[i].event);
    EXPECT_EQ(events[i].found, all.events[i].found);
    EXPECT_EQ(events[i].attitude.t, all.events[i].t);
    EXPECT_EQ(events[i].attitude.q_icrf_body.coeffs(),
              history.attitudes[history.events[i]].q_icrf_body.coeffs());
    EXPECT_FALSE(events[i].bound_rad);
  }
}

/// About a principal axis the rate is constant, so the body rotates back by rate times time.
TEST(History, AboutAPrincipalAxisTheBodyTurnsBackEvenly) {
  Flight flight;
  flight.rate_rad_s = {0.0, 0.0, 0.03};
  const auto attitudes = flight.history().attitudes;
  for (std::size_t i = 0; i < 30; ++i) {
    const double t_s = seconds_between(kControlOn, attitudes[i].t);
    EXPECT_LT(angle_between_rad(attitudes[i].q_icrf_body,
                                kFirst * quaternion_by(t_s * flight.rate_rad_s)),
              1e-9);
    EXPECT_LT((attitudes[i].rate_body_rad_s - flight.rate_rad_s).norm(), 1e-12);
  }
}

TEST(History, WithoutTorquesMomentumAndEnergyStay) {
  Flight flight;
  flight.rate_rad_s = {0.05, -0.03, 0.2};
  flight.arc_s = 100.0;
  const Matrix3d inertia = flight.inertia->kg_m2;
  const auto attitudes = flight.history().attitudes;
  const Vector3d momentum = kFirst * (inertia * flight.rate_rad_s);
  double farthest = 0.0;
  for (std::size_t i = 0; i < 60; ++i) {
    const ReconstructedAttitude& one = attitudes[i];
    EXPECT_LT((one.q_icrf_body * (inertia * one.rate_body_rad_s) - momentum).norm(),
              1e-7 * momentum.norm());
    EXPECT_NEAR(one.rate_body_rad_s.dot(inertia * one.rate_body_rad_s),
                flight.rate_rad_s.dot(inertia * flight.rate_rad_s), 1e-7);
    farthest = std::max(farthest, (one.rate_body_rad_s - flight.rate_rad_s).norm());
  }
  EXPECT_GT(farthest, 0.05);  // The body nutates.
}

TEST(History, OfUnknownInertiaTheRateIsConstantAndItsErrorGrows) {
  Flight known;
  known.rate_rad_s = {0.05, -0.03, 0.2};
  Flight unknown = known;
  unknown.inertia = std::nullopt;
  const auto attitudes = unknown.history().attitudes;
  EXPECT_LT((attitudes.front().rate_body_rad_s - unknown.rate_rad_s).norm(), 1e-12);
  EXPECT_LT(angle_between_rad(attitudes.front().q_icrf_body,
                              kFirst * quaternion_by(-unknown.arc_s * unknown.rate_rad_s)),
            1e-9);
  EXPECT_GT(attitudes.front().sigma_rad(), 10.0 * known.history().attitudes.front().sigma_rad());
}

/// For a body nearly at rest a rate error rotates it by the error times the time, and a constant
/// acceleration by half the time squared. The rate is the measured one minus the bias, so the
/// attitude is correlated with the rate as with the bias, with the opposite sign.
TEST(History, ErrorsGrowBackToT1AsTheyDoForABodyAtRest) {
  Flight flight;
  flight.rate_rad_s = 1e-9 * Vector3d::UnitX();
  flight.disturbance_rad_s2 = 2e-6;
  const Matrix3d per_bias_s = (Matrix3d{} << 30.0, 10.0, 0.0,  //
                               -20.0, 50.0, 0.0,               //
                               0.0, 0.0, -40.0)
                                  .finished();
  flight.start_per_shared.middleCols<3>(SharedGyroBias) = per_bias_s;
  const Matrix3d with_bias = per_bias_s * flight.bias_covariance_rad2_s2;
  const Matrix3d first_covariance_rad2 =
      flight.first_covariance_rad2 + with_bias * per_bias_s.transpose();
  const Matrix3d rate_covariance =
      flight.bias_covariance_rad2_s2 + std::pow(Flight::kNoise_rad_s, 2) * Matrix3d::Identity();
  const auto attitudes = flight.history().attitudes;
  for (const std::size_t i : {0U, 10U, 29U}) {
    const double back_s = seconds_between(attitudes[i].t, kControlOn);
    const Matrix3d expected =
        first_covariance_rad2 + back_s * back_s * rate_covariance +
        back_s * (with_bias + with_bias.transpose()) +
        std::pow(0.5 * back_s * back_s * flight.disturbance_rad_s2, 2) * Matrix3d::Identity();
    EXPECT_LT((attitudes[i].covariance_rad2 - expected).norm(), 1e-6 * expected.norm()) << i;
    const Matrix3d expected_rate =
        rate_covariance + std::pow(back_s * flight.disturbance_rad_s2, 2) * Matrix3d::Identity();
    EXPECT_LT((attitudes[i].rate_covariance_rad2_s2 - expected_rate).norm(),
              1e-6 * expected_rate.norm());
  }
}

/// A body that turns evenly about z: a gyro whose scale is off by a part is off by that part of the
/// turn, and a star tracker that is turned turns every attitude alike.
TEST(History, ErrorsOfTheMissionFileGrowBackToT1BesideTheNoise) {
  Flight flight;
  flight.rate_rad_s = {0.0, 0.0, 0.02};
  const double scale = 1e-3;
  const double turned_rad = 2e-4;
  flight.file_errors(SharedGyro + 2, SharedGyro + 2) = scale * scale;
  flight.file_errors(SharedStarTracker + 2, SharedStarTracker + 2) = turned_rad * turned_rad;
  flight.start_per_shared(2, SharedStarTracker + 2) = 1.0;
  const auto attitudes = flight.history().attitudes;
  const auto exact = [&] {
    Flight other = flight;
    other.file_errors.setZero();
    return other.history().attitudes;
  }();
  for (const std::size_t i : {0U, 10U, 29U}) {
    const double back_rad = 0.02 * seconds_between(attitudes[i].t, kControlOn);
    Matrix3d expected = exact[i].covariance_rad2;
    expected(2, 2) += std::pow(scale * back_rad, 2) + turned_rad * turned_rad;
    EXPECT_LT((attitudes[i].covariance_rad2 - expected).norm(), 1e-9 * expected.norm()) << i;
    EXPECT_EQ(attitudes[i].noise_covariance_rad2, exact[i].covariance_rad2);
  }
}

TEST(History, AnInertiaThatIsUncertainIsNoNoise) {
  Flight flight;
  flight.rate_rad_s = {0.05, -0.03, 0.2};
  const auto exact = flight.history().attitudes;
  flight.inertia->sigma_fraction = 0.05;
  const auto attitudes = flight.history().attitudes;
  EXPECT_GT(attitudes.front().sigma_rad(), 2.0 * exact.front().sigma_rad());
  EXPECT_EQ(attitudes.front().noise_covariance_rad2, exact.front().covariance_rad2);
}

TEST(History, WhoseFirstSamplesAreMissingKnowsItsFirstRateWorse) {
  Flight late;
  late.first_sample_s = 5.0;
  const double variance = late.observed().rates.start_variance_rad2_s2();
  ASSERT_GT(variance, 0.0);
  const auto rate_rad2_s2 = [](const Flight& flight, std::size_t node) {
    return flight.history().attitudes[30 + node].rate_covariance_rad2_s2;
  };
  EXPECT_LT(
      (rate_rad2_s2(late, 0) - rate_rad2_s2(Flight{}, 0) - variance * Matrix3d::Identity()).norm(),
      1e-9 * variance);
  EXPECT_EQ(rate_rad2_s2(late, 1), rate_rad2_s2(Flight{}, 1));
  EXPECT_GT(late.history().attitudes.front().sigma_rad(),
            Flight{}.history().attitudes.front().sigma_rad());
}

}  // namespace spindrift::history_test
