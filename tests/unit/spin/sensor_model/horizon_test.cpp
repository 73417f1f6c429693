/// The predicted edges, compared with the oracle, which searches for them and shares no formula.

#include "pipelines/spin/sensor_model/horizon.h"

#include <Eigen/Geometry>
#include <cmath>
#include <limits>
#include <numbers>
#include <random>

#include "pipelines/frames/angle.h"
#include "pipelines/frames/celestial.h"
#include "pipelines/spin/sensor_model/edge_prediction.h"
#include "tests/support/matchers.h"
#include "tests/support/spinning_body.h"

namespace spindrift::testing::horizon_test {

constexpr double kPi = std::numbers::pi;
const TaiTime kStart = tai_from_ns(1'795'143'637'000'000'000);

Eigen::Vector3d random_direction(std::mt19937_64& rng) {
  std::normal_distribution<double> normal;
  return testing::random_direction(normal, rng);
}

/// Holds a body that sees the Earth from some distance, and the predictor's input for it.
struct Scene {
  SpinningBody body;
  SunEarthEphemeris around;
  Eigen::Vector3d sun_icrf;
  Eigen::Vector3d earth_icrf_km;

  Sky sky(TaiTime t) const {
    return {.t = t,
            .spacecraft = {.position_icrf_km = -earth_icrf_km,
                           .velocity_icrf_km_s = Eigen::Vector3d::Zero()},
            .sun_icrf = sun_icrf,
            .earth_pole_icrf = Eigen::Vector3d::UnitZ()};
  }
};

Scene random_scene(HorizonModel model, std::mt19937_64& rng) {
  std::uniform_real_distribution<double> uniform;
  const Eigen::Vector3d earth_icrf = random_direction(rng);
  const Eigen::Vector3d across =
      Eigen::AngleAxisd{2.0 * kPi * uniform(rng), earth_icrf} * earth_icrf.unitOrthogonal();
  const double tilt_rad = (uniform(rng) - 0.5) * 20.0 * kRadPerDeg;
  SpinConfig config = usual_config();
  config.horizon.model = model;
  Scene scene{.body = {.axis_icrf = Eigen::AngleAxisd{tilt_rad, across.cross(earth_icrf)} * across,
                       .rate_rad_s = 2.0 * kPi,
                       .first_turn_rad = 2.0 * kPi * uniform(rng),
                       .config = config},
              .around = {},
              .sun_icrf = random_direction(rng),
              .earth_icrf_km = earth_icrf * (7000.0 + 35000.0 * uniform(rng))};
  scene.around = at_rest(scene.sun_icrf, scene.earth_icrf_km);
  scene.around.horizon_km = usual_horizon_km(model);
  return scene;
}

class EdgesOnHorizons : public ::testing::TestWithParam<HorizonModel> {};

TEST_P(EdgesOnHorizons, EveryEdgeComesAtThePhasePredicted) {
  std::mt19937_64 rng{7};
  std::array<int, kPulseChannels> seen{};
  int unpredicted = 0;
  for (int trial = 0; trial < 300; ++trial) {
    const Scene scene = random_scene(GetParam(), rng);
    for (const Edge& edge : edges_between(scene.body, scene.around, 0.0, 1.0)) {
      const TaiTime t = shifted(kStart, edge.t_s);
      const auto predicted =
          predict_edge(scene.body.config, scene.sky(t), spin_frame(scene.body.axis_icrf),
                       {.t = t, .channel = edge.channel});
      if (!predicted) {
        // Only grazing edges may lack a prediction; the next test limits how grazing.
        ++unpredicted;
        continue;
      }
      const double phase_rad = scene.body.first_turn_rad + scene.body.rate_rad_s * edge.t_s;
      // The oracle is accurate to 1e-12 s; a grazing beam amplifies that, and the rounding of a
      // flat crossing, up to 30 times, at the steepest crossing that is predicted.
      ASSERT_NEAR(wrapped_rad(phase_rad - predicted->phase_rad), 0.0, 3e-9)
          << "trial " << trial << ' ' << name_of(edge.channel);
      ++seen.at(index_of(edge.channel));
    }
  }
  for (const int count : seen) {
    EXPECT_GT(count, 100);
  }
  EXPECT_LT(unpredicted, 60);
}

TEST_P(EdgesOnHorizons, DerivativesAreThoseOfThePrediction) {
  // Central differences of 1e-6 rad have a truncation error of 1e-12 f'''/6 and a rounding error of
  // 1e-15 / 1e-6. Near grazing (slopes up to 30) f''' grows as the fifth power of the slope.
  constexpr double kStep_rad = 1e-6;
  std::mt19937_64 rng{8};
  int compared = 0;
  for (int trial = 0; trial < 300; ++trial) {
    const Scene scene = random_scene(GetParam(), rng);
    // The frame is displaced from the solution.
    const Eigen::Matrix3d off =
        (Eigen::AngleAxisd{0.02, random_direction(rng)} * spin_frame(scene.body.axis_icrf))
            .matrix();
    for (std::size_t channel = 0; channel < kPulseChannels; ++channel) {
      const Pulse edge{.t = kStart, .channel = static_cast<PulseChannel>(channel)};
      const auto phase = [&](const Eigen::Vector3d& turned_rad) {
        const double angle_rad = turned_rad.norm();
        const Eigen::AngleAxisd turn{angle_rad, turned_rad / angle_rad};
        return predict_edge(scene.body.config, scene.sky(kStart),
                            turn.toRotationMatrix().transpose() * off, edge);
      };
      const auto predicted = predict_edge(scene.body.config, scene.sky(kStart), off, edge);
      if (!predicted || predicted->phase_per_rotation.norm() > 10.0) {
        continue;
      }
      for (Eigen::Index i = 0; i < 3; ++i) {
        const auto later = phase(kStep_rad * Eigen::Vector3d::Unit(i));
        const auto earlier = phase(-kStep_rad * Eigen::Vector3d::Unit(i));
        ASSERT_TRUE(later && earlier);
        const double slope = wrapped_rad(later->phase_rad - earlier->phase_rad) / (2.0 * kStep_rad);
        ASSERT_NEAR(predicted->phase_per_rotation[i], slope, 1e-6)
            << "trial " << trial << ' ' << name_of(edge.channel) << " about axis " << i;
        ++compared;
      }
      ASSERT_NEAR(predicted->phase_per_rotation.z(), -1.0, 1e-12);
    }
  }
  EXPECT_GT(compared, 3000);
}

TEST_P(EdgesOnHorizons, TheBeamThatMissesHasNoCrossing) {
  // From 42 164 km the disc is 8.8 deg wide; the beam is at 85 deg, the Earth 60 deg from the axis.
  const HorizonAxes axes = horizon_axes({.model = GetParam(), .co2_altitude_km = 40.0});
  const auto crossing = [&](double earth_angle_deg) {
    const double angle_rad = earth_angle_deg * kRadPerDeg;
    return limb_crossing(axes,
                         {.spacecraft_spin_km = -42164.0 * Eigen::Vector3d{std::sin(angle_rad), 0.0,
                                                                           std::cos(angle_rad)},
                          .pole_spin = Eigen::Vector3d::UnitY()},
                         85.0 * kRadPerDeg, Crossing::In);
  };
  EXPECT_FALSE(crossing(60.0));
  EXPECT_TRUE(crossing(80.0));
  EXPECT_TRUE(crossing(92.0));
  EXPECT_FALSE(crossing(93.9));
}

TEST_P(EdgesOnHorizons, NothingIsSeenFromInsideNorFromNowhere) {
  const HorizonAxes axes = horizon_axes({.model = GetParam(), .co2_altitude_km = 40.0});
  for (const double range_km : {0.0, 6400.0, std::numeric_limits<double>::quiet_NaN()}) {
    EXPECT_FALSE(limb_crossing(
        axes, {.spacecraft_spin_km = {range_km, 0.0, 0.0}, .pole_spin = Eigen::Vector3d::UnitZ()},
        1.5, Crossing::In));
  }
}

INSTANTIATE_TEST_SUITE_P(EdgePrediction, EdgesOnHorizons,
                         ::testing::Values(HorizonModel::Sphere, HorizonModel::Ellipsoid),
                         [](const auto& model) {
                           return model.param == HorizonModel::Sphere ? "Sphere" : "Ellipsoid";
                         });

TEST(Horizon, GrazingTheFlattenedPoleIsAMiss) {
  // In a polar view the beam passes 10 km above the ellipsoid's pole and 11 km inside the sphere.
  const HorizonAxes ellipsoid =
      horizon_axes({.model = HorizonModel::Ellipsoid, .co2_altitude_km = 40.0});
  const HorizonAxes sphere = horizon_axes({.model = HorizonModel::Sphere, .co2_altitude_km = 40.0});
  const double range_km = 42164.0;
  const double miss_km = ellipsoid.polar_km + 10.0;
  const EarthView earth{.spacecraft_spin_km = {-range_km, 0.0, 0.0},
                        .pole_spin = Eigen::Vector3d::UnitZ()};
  const double mount_rad = 0.5 * kPi - std::asin(miss_km / range_km);
  EXPECT_FALSE(limb_crossing(ellipsoid, earth, mount_rad, Crossing::In));
  EXPECT_TRUE(limb_crossing(sphere, earth, mount_rad, Crossing::In));
}

TEST(EdgePrediction, WithoutTheSensorOrWithTheSunOnTheAxisThereIsNoEdge) {
  SpinConfig config = usual_config();
  config.south.reset();
  const Sky sky{.t = kStart,
                .spacecraft = {.position_icrf_km = {20000.0, 0.0, 0.0},
                               .velocity_icrf_km_s = Eigen::Vector3d::Zero()},
                .sun_icrf = Eigen::Vector3d::UnitZ(),
                .earth_pole_icrf = Eigen::Vector3d::UnitZ()};
  for (const auto& [channel, seen] :
       {std::pair{PulseChannel::NorthIn, true}, std::pair{PulseChannel::SouthIn, false},
        std::pair{PulseChannel::Sun1, false}, std::pair{PulseChannel::Sun2, false}}) {
    EXPECT_EQ(
        predict_edge(config, sky, Eigen::Matrix3d::Identity(), {.t = kStart, .channel = channel})
            .has_value(),
        seen)
        << name_of(channel);
  }
}

}  // namespace spindrift::testing::horizon_test
