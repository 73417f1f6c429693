/// The information of edges on the axis, compared with pipelines/spin/README.md and with the
/// response of the oracle's edges to changes of the body.

#include <Eigen/Geometry>
#include <array>
#include <cmath>
#include <random>

#include "pipelines/frames/angle.h"
#include "pipelines/frames/celestial.h"
#include "pipelines/spin/sensor_model/edge_prediction.h"
#include "tests/support/information_limit.h"
#include "tests/support/matchers.h"
#include "tests/support/observed_spin.h"
#include "tests/support/recorded_pass.h"

namespace spindrift::testing::edge_information_test {

using enum PulseChannel;

constexpr std::array kAll = {Sun1, Sun2, NorthIn, NorthOut, SouthIn, SouthOut};

/// Returns the rotation from ICRF to a frame on the tangent plane's basis, in which the covariances
/// are given.
Eigen::Matrix3d frame_on_tangents(const Eigen::Vector3d& axis_icrf) {
  Eigen::Matrix3d R_spin_icrf;
  R_spin_icrf << tangent_basis(axis_icrf).transpose(), axis_icrf.transpose();
  return R_spin_icrf;
}

/// Holds a turn from the middle of the first hundred of the pass to which those figures refer.
struct Turn {
  RecordedPass pass = recorded_pass("nominal");
  Sky sky = sky_at(pass.orbit, shifted(pass.pulses.front().t, 50.0));
  Eigen::Matrix3d R_spin_icrf = frame_on_tangents(pass.true_axis_icrf);

  template <class Channels>
  void add_to(EdgeInformation& information, const Channels& channels, double dt_s,
              double weight = 1.0) const {
    for (const PulseChannel channel : channels) {
      const auto edge =
          predict_edge(pass.config, sky, R_spin_icrf, {.t = sky.t, .channel = channel});
      information.add(edge.value(), dt_s,
                      pass.true_rate_rad_s * edge_sigma_s(pass.config.noise, channel), weight);
    }
  }
};

double sigma_deg(const EdgeInformation& information) {
  return std::sqrt(information.axis_covariance_rad2().value().trace()) / kRadPerDeg;
}

TEST(EdgeInformation, OfOneTurnAtAKnownRateIsThePublishedLimit) {
  const Turn turn;
  EdgeInformation information;
  turn.add_to(information, kAll, 0.0);
  // pipelines/spin/README.md; the bound falls by 2 % a minute as the geometry changes.
  EXPECT_NEAR(sigma_deg(information), 0.405, 0.004);
}

TEST(EdgeInformation, IsThatOfTheOraclesEdges) {
  const Surroundings from;
  std::mt19937_64 rng{11};
  for (int trial = 0; trial < 5; ++trial) {
    SCOPED_TRACE(trial);
    const auto body = random_body(from.around, 0.05, rng);
    constexpr double kDuration_s = 40.0;
    EdgeInformation information;
    for (const Edge& edge : edges_between(body, from.around, 0.0, kDuration_s)) {
      const TaiTime t = shifted(kTransferStart, edge.t_s);
      const auto predicted =
          predict_edge(body.config, sky_at(from.orbit, t), frame_on_tangents(body.axis_icrf),
                       {.t = t, .channel = edge.channel});
      information.add(predicted.value(), edge.t_s,
                      body.rate_rad_s * edge_sigma_s(body.config.noise, edge.channel));
    }
    const Eigen::Matrix2d limit = cramer_rao_rad2(body, from.around, kDuration_s);
    const Eigen::Matrix2d found = information.axis_covariance_rad2().value();
    // The oracle assumes a rate without drift, which hardly affects the axis.
    EXPECT_LT((found - limit).norm(), 0.02 * limit.norm()) << found << "\n" << limit;
  }
}

TEST(EdgeInformation, OfOneSensorAloneIsNoAxis) {
  const Turn turn;
  EdgeInformation sun;
  turn.add_to(sun, std::array{Sun1, Sun2}, 0.0, 1e6);
  EXPECT_FALSE(sun.axis_covariance_rad2());
  EdgeInformation earth;
  turn.add_to(earth, std::array{NorthIn, NorthOut, SouthIn, SouthOut}, 0.0, 1e6);
  EXPECT_FALSE(earth.axis_covariance_rad2());
  EXPECT_FALSE(EdgeInformation{}.axis_covariance_rad2());
}

TEST(EdgeInformation, OfSomeEdgesAlikeIsTheirWeight) {
  const Turn turn;
  EdgeInformation seven;
  EdgeInformation weighed;
  for (int i = 0; i < 7; ++i) {
    turn.add_to(seven, kAll, 3.0);
  }
  turn.add_to(weighed, kAll, 3.0, 7.0);
  EXPECT_NEAR(sigma_deg(weighed) / sigma_deg(seven), 1.0, 1e-9);
}

TEST(EdgeInformation, DoesNotDependOnWhenTimeBeginsNorOnTheFrame) {
  const Turn turn;
  EdgeInformation here;
  EdgeInformation later;
  EdgeInformation turned;
  Turn in_turned_frame = turn;
  in_turned_frame.R_spin_icrf = Eigen::AngleAxisd{1.1, Eigen::Vector3d::UnitZ()} * turn.R_spin_icrf;
  for (int i = 0; i < 100; ++i) {
    turn.add_to(here, kAll, i);
    turn.add_to(later, kAll, 5000.0 + i);
    in_turned_frame.add_to(turned, kAll, i);
  }
  // Counting turns from so far away costs eight digits in the drift over a hundred turns.
  EXPECT_NEAR(sigma_deg(later) / sigma_deg(here), 1.0, 1e-4);
  EXPECT_NEAR(sigma_deg(turned) / sigma_deg(here), 1.0, 1e-9);
  // Directions in the rotated frame have rotated components.
  const Eigen::Matrix2d R_turned_here = Eigen::Rotation2Dd{1.1}.toRotationMatrix();
  const Eigen::Matrix2d expected =
      R_turned_here * here.axis_covariance_rad2().value() * R_turned_here.transpose();
  EXPECT_LT((turned.axis_covariance_rad2().value() - expected).norm(), 1e-6 * expected.norm());
}

/// Returns what a sensor is where the mission file is off by `value`.
SpinConfig off_by(SpinConfig config, SpinAlignmentError error, double value) {
  const std::array<double*, 7> values = {
      &config.sun_sensor.slit_cant_rad, &config.sun_sensor.slit_separation_rad,
      &config.north->mount_angle_rad,   &config.south->mount_angle_rad,
      &config.north->azimuth_rad,       &config.south->azimuth_rad,
      &config.horizon.co2_altitude_km};
  *values.at(error) += value;
  return config;
}

/// Three edges of a turn at a known rate determine axis and phase without a residual: those that
/// the mission file predicts about the axis that they give are those that came, but for the phase.
TEST(EdgeInformation, TellsHowFarAWrongMissionFileMovesTheAxis) {
  const Turn turn;
  const SpinConfig& file = turn.pass.config;
  const std::array channels = {Sun1, Sun2, NorthIn};
  EdgeInformation information;
  turn.add_to(information, channels, 0.0, 1e6);
  const auto per_error = information.axis_per_alignment().value();
  constexpr double kTiny = 1e-6;
  for (const auto error : {SlitCantError, SlitSeparationError, NorthMountAngleError,
                           NorthAzimuthError, Co2AltitudeError}) {
    SCOPED_TRACE(kSpinAlignmentKeys.at(error));
    const double value = error == Co2AltitudeError ? 1000.0 * kTiny : kTiny;
    const SpinConfig truth = off_by(file, error, value);
    const Eigen::Vector2d moved = per_error.col(error) * value;
    EXPECT_GT(moved.norm(), 0.1 * kTiny);
    const Eigen::Vector3d tilt{-moved.y(), moved.x(), 0.0};
    const Eigen::Matrix3d R_found_icrf =
        Eigen::AngleAxisd{-tilt.norm(), tilt.normalized()}.toRotationMatrix() * turn.R_spin_icrf;
    std::array<double, 3> off_rad{};
    for (std::size_t i = 0; i < channels.size(); ++i) {
      const Pulse edge{.t = turn.sky.t, .channel = channels.at(i)};
      off_rad.at(i) = wrapped_rad(predict_edge(file, turn.sky, R_found_icrf, edge)->phase_rad -
                                  predict_edge(truth, turn.sky, turn.R_spin_icrf, edge)->phase_rad);
    }
    EXPECT_NEAR(off_rad[1], off_rad[0], 1e-3 * kTiny);
    EXPECT_NEAR(off_rad[2], off_rad[0], 1e-3 * kTiny);
  }
  EXPECT_EQ(per_error.col(SouthMountAngleError).norm(), 0.0);
}

TEST(EdgeInformation, OfOneSensorAloneDoesNotSayWhatAMissionFileMoves) {
  const Turn turn;
  EdgeInformation sun;
  turn.add_to(sun, std::array{Sun1, Sun2}, 0.0, 1e6);
  EXPECT_FALSE(sun.axis_per_alignment());
}

}  // namespace spindrift::testing::edge_information_test
