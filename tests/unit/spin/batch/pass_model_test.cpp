/// The equations of `batch`, compared with the oracle and with finite differences away from the
/// solution.

#include "pipelines/spin/batch/pass_model.h"

#include <random>

#include "pipelines/frames/angle.h"
#include "tests/support/batch_pass.h"
#include "tests/support/matchers.h"

namespace spindrift::testing::pass_model_test {

struct Scene {
  std::mt19937_64 rng{11};
  Orbit orbit = transfer_orbit();
  SunEarthEphemeris around;
  SpinningBody body;
  std::vector<PassEdge> edges;

  explicit Scene(HorizonModel horizon)
      : around{seen_from(orbit, usual_horizon_km(horizon))},
        body{random_body(around, 4.0 * kRadPerDeg, rng)} {
    body.config.horizon.model = horizon;
    edges = counted(body, pulses_from(edges_of_turns(body, around, 20.0), kTransferStart));
  }

  PassModel model() const { return PassModel::make(body.config, orbit, edges).value(); }
};

class PassModels : public ::testing::TestWithParam<HorizonModel> {};

TEST_P(PassModels, TheTrueStateLeavesNothingOver) {
  const Scene scene{GetParam()};
  const PassModel model = scene.model();
  const SpinState truth = true_state(scene.body, model);
  for (const PassEdge& edge : scene.edges) {
    const auto residual = model.at(truth).residual(edge.pulse).value();
    // 1/100 of the noise, since Sun and Earth are held constant for ten seconds.
    EXPECT_NEAR(residual.off, 0.0, 0.01) << name_of(edge.pulse.channel);
  }
}

TEST_P(PassModels, SlopesAreThoseOfTheResidual) {
  const Scene scene{GetParam()};
  const PassModel model = scene.model();
  // Displace the state from the solution in every unknown.
  SpinState state = true_state(scene.body, model);
  for (int i = 0; i < kMotionUnknowns; ++i) {
    state = stepped(model, state, i, 0.01);
  }
  for (int i = 0; i < kSensorBiases; ++i) {
    const auto bias = static_cast<SensorBias>(i);
    state.biases[i] = (i % 2 == 0 ? 0.07 : -0.07) * range_of(bias).bound;
  }
  ASSERT_GT(scene.edges.size() * kBatchUnknowns, 1000U);
  for (const PassEdge& edge : scene.edges) {
    expect_slopes(model, state, edge.pulse, kBatchUnknowns, 1e-6);
  }
}

INSTANTIATE_TEST_SUITE_P(Horizons, PassModels,
                         ::testing::Values(HorizonModel::Sphere, HorizonModel::Ellipsoid),
                         [](const auto& model) {
                           return model.param == HorizonModel::Sphere ? "Sphere" : "Ellipsoid";
                         });

}  // namespace spindrift::testing::pass_model_test
