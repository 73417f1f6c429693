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

}  // namespace spindrift::testing::edge_information_test
