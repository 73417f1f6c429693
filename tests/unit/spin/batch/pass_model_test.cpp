/// The equations of `batch`, compared with the oracle and with finite differences away from the
/// solution.

#include "pipelines/spin/batch/pass_model.h"

#include <gtest/gtest.h>

#include <cmath>
#include <random>

#include "pipelines/frames/angle.h"
#include "tests/support/batch_pass.h"

namespace spindrift::pass_model_test {

struct Scene {
  std::mt19937_64 rng{11};
  Orbit orbit = testing::transfer_orbit();
  testing::SunEarthEphemeris around;
  testing::SpinningBody body;
  std::vector<PassEdge> edges;

  explicit Scene(HorizonModel horizon)
      : around{testing::seen_from(orbit, horizon == HorizonModel::Sphere
                                             ? testing::spherical_horizon_km(40.0)
                                             : testing::ellipsoidal_horizon_km(40.0))},
        body{testing::random_body(around, 4.0 * kRadPerDeg, rng)} {
    body.config.horizon.model = horizon;
    edges = testing::counted(body, testing::pulses_from(testing::edges_of_turns(body, around, 20.0),
                                                        testing::kTransferStart));
  }

  PassModel model() const { return PassModel::make(body.config, orbit, edges).value(); }
};

class PassModels : public ::testing::TestWithParam<HorizonModel> {};

TEST_P(PassModels, TheTrueStateLeavesNothingOver) {
  const Scene scene{GetParam()};
  const PassModel model = scene.model();
  const SpinState truth = testing::true_state(scene.body, model);
  for (const PassEdge& edge : scene.edges) {
    const auto residual = model.at(truth).residual(edge.pulse);
    ASSERT_TRUE(residual);
    // 1/100 of the noise, since Sun and Earth are held constant for ten seconds.
    EXPECT_NEAR(residual->off, 0.0, 0.01) << name_of(edge.pulse.channel);
  }
}

SpinState stepped(const PassModel& model, SpinState state, int unknown, double step) {
  const double half_s = model.half_s();
  if (unknown < 3) {
    state.q_icrf_spin = state.q_icrf_spin *
                        Eigen::Quaterniond{Eigen::AngleAxisd{step, Eigen::Vector3d::Unit(unknown)}};
  } else if (unknown == 3) {
    state.rate_rad_s += step / half_s;
  } else if (unknown == 4) {
    state.drift_rad_s2 += 2.0 * step / (half_s * half_s);
  } else {
    state.biases[unknown - kMotionUnknowns] += step;
  }
  return state;
}

TEST_P(PassModels, SlopesAreThoseOfTheResidual) {
  const Scene scene{GetParam()};
  const PassModel model = scene.model();
  // Displace the state from the solution in every unknown.
  SpinState state = testing::true_state(scene.body, model);
  for (int i = 0; i < kMotionUnknowns; ++i) {
    state = stepped(model, state, i, 0.01);
  }
  for (int i = 0; i < kSensorBiases; ++i) {
    const auto bias = static_cast<SensorBias>(i);
    state.biases[i] = (i % 2 == 0 ? 0.7 : -0.7) * prior_of(bias).sigma;
  }
  int compared = 0;
  for (const PassEdge& edge : scene.edges) {
    const auto here = model.at(state).residual(edge.pulse);
    ASSERT_TRUE(here);
    for (int i = 0; i < kBatchUnknowns; ++i) {
      const double step = i == kMotionUnknowns + Co2HeightBias ? 1e-3 : 1e-6;
      const auto after = model.at(stepped(model, state, i, step)).residual(edge.pulse);
      const auto before = model.at(stepped(model, state, i, -step)).residual(edge.pulse);
      ASSERT_TRUE(after && before);
      const double slope = (after->off - before->off) / (2.0 * step);
      EXPECT_NEAR(here->slopes[i], slope, 1e-6 * here->slopes.head<3>().norm())
          << name_of(edge.pulse.channel) << ", unknown " << i;
      ++compared;
    }
  }
  EXPECT_GT(compared, 1000);
}

INSTANTIATE_TEST_SUITE_P(Horizons, PassModels,
                         ::testing::Values(HorizonModel::Sphere, HorizonModel::Ellipsoid),
                         [](const auto& model) {
                           return model.param == HorizonModel::Sphere ? "Sphere" : "Ellipsoid";
                         });

}  // namespace spindrift::pass_model_test
