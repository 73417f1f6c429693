/// The effect of model errors on an edge, compared with finite differences and with the formulas of
/// the measured angles. (The edges themselves are tested with the filter against the oracle.)

#include "pipelines/spin/sensor_model/edge_prediction.h"

#include <Eigen/Geometry>
#include <cmath>
#include <numbers>
#include <random>

#include "pipelines/frames/celestial.h"
#include "pipelines/frames/wgs84.h"
#include "pipelines/spin/measurement/measurement.h"
#include "tests/support/matchers.h"
#include "tests/support/misaligned.h"
#include "tests/support/observed_spin.h"
#include "tests/support/spinning_body.h"

namespace spindrift::testing::edge_prediction_test {

using enum PulseChannel;

struct Scene {
  Orbit orbit = transfer_orbit();
  Sky sky = sky_at(orbit, kTransferStart);
  std::mt19937_64 rng{5};
  SpinningBody body = random_body(seen_from(orbit), 0.1, rng);
  Eigen::Matrix3d R_spin_icrf = spin_frame(body.axis_icrf);

  PredictedEdge predicted(PulseChannel channel, const SpinConfig& config) const {
    return predict_edge(config, sky, R_spin_icrf, {.t = sky.t, .channel = channel}).value();
  }
};

TEST(EdgePrediction, ALimbFartherOutMovesTheEdgesOfItsBeamApart) {
  const Scene scene;
  // Compare with 1 km of altitude, converted to an angle.
  SpinConfig higher = scene.body.config;
  higher.horizon.co2_altitude_km += 1.0;
  const double range_km = scene.sky.spacecraft.position_icrf_km.norm();
  const auto disc_rad = [&](double altitude_km) {
    return std::asin((wgs84::kEquatorialRadius_km + altitude_km) / range_km);
  };
  const double farther_rad = disc_rad(41.0) - disc_rad(40.0);
  for (const PulseChannel channel : {NorthIn, NorthOut, SouthIn, SouthOut}) {
    const PredictedEdge edge = scene.predicted(channel, scene.body.config);
    const bool north = channel == NorthIn || channel == NorthOut;
    const double moved_rad = scene.predicted(channel, higher).phase_rad - edge.phase_rad;
    const double expected_rad = edge.phase_per_error[north ? NorthLimb : SouthLimb] * farther_rad;
    EXPECT_EQ(moved_rad > 0.0, channel == NorthOut || channel == SouthOut);
    EXPECT_NEAR(moved_rad / expected_rad, 1.0, 1e-3);
    EXPECT_EQ(edge.phase_per_error[north ? SouthLimb : NorthLimb], 0.0);
    EXPECT_EQ(edge.phase_per_error[SunAngleError], 0.0);
    EXPECT_EQ(edge.phase_per_error[north ? NorthAzimuth : SouthAzimuth], 1.0);
  }
}

TEST(EdgePrediction, ASunAngleMeasuredTooLargeMovesTheSecondSlitAlone) {
  const Scene scene;
  const SunSensor& sensor = scene.body.config.sun_sensor;
  const PredictedEdge sun1 = scene.predicted(Sun1, scene.body.config);
  const PredictedEdge sun2 = scene.predicted(Sun2, scene.body.config);
  EXPECT_TRUE(sun1.phase_per_error.isZero());
  constexpr double kError_rad = 1e-5;
  const double delay_rad = sun2.phase_rad - sun1.phase_rad;
  const double later_rad = sun2.phase_per_error[SunAngleError] * kError_rad;
  const double before_rad = sun_angle(sensor, delay_rad, 1.0, 0.0)->value_rad;
  const double after_rad = sun_angle(sensor, delay_rad + later_rad, 1.0, 0.0)->value_rad;
  EXPECT_NEAR((after_rad - before_rad) / kError_rad, 1.0, 1e-3);
}

TEST(EdgePrediction, SlopesByTheAlignmentAreDifferencesOfPredictions) {
  const Scene scene;
  for (const PulseChannel channel : {Sun1, Sun2, NorthIn, NorthOut, SouthIn, SouthOut}) {
    SCOPED_TRACE(name_of(channel));
    const PredictedEdge edge = scene.predicted(channel, scene.body.config);
    for (int error = 0; error < TimeTagError; ++error) {
      SCOPED_TRACE(kSpinAlignmentKeys.at(static_cast<std::size_t>(error)));
      const double step = error == Co2AltitudeError ? 0.1 : 1e-5;
      const SpinAlignmentVector errors = step * SpinAlignmentVector::Unit(error);
      const double moved_rad =
          scene.predicted(channel, true_config(scene.body.config, errors)).phase_rad -
          edge.phase_rad;
      EXPECT_NEAR(moved_rad / step, edge.phase_per_alignment[error],
                  1e-3 * std::abs(edge.phase_per_alignment[error]) + 1e-9);
    }
    constexpr double kLate_s = 0.1;
    const auto on_time = predict_edge(scene.body.config, scene.sky, scene.R_spin_icrf,
                                      {.t = shifted(scene.sky.t, -kLate_s), .channel = channel});
    EXPECT_NEAR((on_time.value().phase_rad - edge.phase_rad) / kLate_s,
                edge.phase_per_alignment[TimeTagError],
                1e-3 * std::abs(edge.phase_per_alignment[TimeTagError]) + 1e-12);
  }
}

TEST(EdgePrediction, TheSunHasAnAzimuthUpToHalfADegreeFromTheAxis) {
  const Scene scene;
  const Eigen::Vector3d across = scene.sky.sun_icrf.unitOrthogonal();
  const auto sun1_at = [&](double sun_angle_deg) {
    const Eigen::Vector3d axis_icrf =
        Eigen::AngleAxisd{sun_angle_deg * std::numbers::pi / 180.0, across} * scene.sky.sun_icrf;
    return predict_edge(scene.body.config, scene.sky, spin_frame(axis_icrf),
                        {.t = scene.sky.t, .channel = Sun1});
  };
  // The edge is predicted even near the Sun: an edge that no candidate could have is compared with
  // it.
  EXPECT_TRUE(sun1_at(5.0));
  EXPECT_TRUE(sun1_at(0.7));
  EXPECT_FALSE(sun1_at(0.5));
  // The azimuth changes by this ratio as the axis moves across the Sun's direction.
  EXPECT_NEAR(sun1_at(2.0)->phase_per_rotation.head<2>().norm(),
              1.0 / std::tan(2.0 * std::numbers::pi / 180.0), 1e-9);
}

TEST(EdgePrediction, WhatLeadsToAnEdgeIsTheEdgeItselfWhereThereIsOne) {
  const Scene scene;
  const SpinConfig& config = scene.body.config;
  for (const PulseChannel channel : {NorthIn, NorthOut, SouthIn, SouthOut}) {
    const PredictedEdge there = scene.predicted(channel, config);
    const PredictedEdge near =
        linearise_by_depth(config, scene.sky, scene.R_spin_icrf,
                           {.t = scene.sky.t, .channel = channel}, there.phase_rad, 0.001)
            .value();
    EXPECT_NEAR(near.phase_rad, there.phase_rad, 1e-9);
    EXPECT_LT((near.phase_per_rotation - there.phase_per_rotation).norm(), 1e-9);
  }
}

TEST(EdgePrediction, AStepTowardsAnEdgeLeadsFromABeamThatMissesTheEarthToOneThatHasIt) {
  const Scene scene;
  // The beam passes half a degree beyond the limb.
  SpinConfig config = scene.body.config;
  const Eigen::Vector3d earth_spin =
      -(scene.R_spin_icrf * scene.sky.spacecraft.position_icrf_km).normalized();
  const double disc_rad = std::asin((wgs84::kEquatorialRadius_km + 40.0) /
                                    scene.sky.spacecraft.position_icrf_km.norm());
  const double earth_rad = std::acos(earth_spin.z());
  config.north->mount_angle_rad = earth_rad - disc_rad - 0.0087;
  const Pulse edge{.t = scene.sky.t, .channel = NorthIn};
  ASSERT_FALSE(predict_edge(config, scene.sky, scene.R_spin_icrf, edge));
  const double phase_rad =
      std::atan2(earth_spin.y(), earth_spin.x()) + config.north->azimuth_rad - 0.05;
  const PredictedEdge near =
      linearise_by_depth(config, scene.sky, scene.R_spin_icrf, edge, phase_rad, 0.001).value();
  const Eigen::Vector2d slope = near.phase_per_rotation.head<2>();
  const Eigen::Vector2d tilt =
      slope * wrapped_rad(phase_rad - near.phase_rad) / slope.squaredNorm();
  const Eigen::Matrix3d tilted =
      Eigen::AngleAxisd{tilt.norm(), Eigen::Vector3d{tilt.x(), tilt.y(), 0.0}.normalized()}
          .toRotationMatrix()
          .transpose() *
      scene.R_spin_icrf;
  EXPECT_NEAR(predict_edge(config, scene.sky, tilted, edge).value().phase_rad, phase_rad, 0.005);
}

}  // namespace spindrift::testing::edge_prediction_test
