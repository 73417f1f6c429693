/// The equations of a nutating and coning body: the ground model's edges have no residuals, and the
/// derivatives match finite differences away from the solution.

#include "pipelines/spin/batch/nutation_stretch.h"

#include <cmath>
#include <numbers>

#include "pipelines/frames/angle.h"
#include "tests/support/batch_pass.h"
#include "tests/support/matchers.h"
#include "tests/support/wobbling_pass.h"

namespace spindrift::testing::nutation_stretch_test {

constexpr double kDuration_s = 60.0;

/// Holds a body with a growing nutation of 2 deg and a coning of 1 deg.
struct Scene {
  WobblingPasses passes{31, kDuration_s};
  SpinTruth truth = passes.drawn();
  std::vector<PassEdge> edges;

  Scene() {
    truth.motion.nutation = {.half_angle_rad = 2.0 * kRadPerDeg,
                             .inertia_ratio = 0.3,
                             .first_azimuth_rad = 1.0,
                             .growth_per_s = 0.1 / kDuration_s};
    truth.motion.coning = {.tilt_rad = 1.0 * kRadPerDeg, .azimuth_rad = 2.0};
    passes.config().noise = {.sun_s = 0.0, .infrared_s = 0.0};
    edges = passes.edges(truth);
    passes.config().noise = {.sun_s = 1e-4, .infrared_s = 5e-4};
  }

  PassModel model() { return PassModel::make(passes.config(), transfer_orbit(), edges).value(); }

  SpinState state(const PassModel& model) const {
    const SpinMotion& motion = truth.motion;
    const double middle_s = seconds_between(truth.start, model.middle());
    Eigen::Matrix3d R_icrf_axes;
    R_icrf_axes << tangent_basis(motion.axis_icrf), motion.axis_icrf;
    const Eigen::AngleAxisd azimuth{motion.azimuth_rad(middle_s), Eigen::Vector3d::UnitZ()};
    // The hinge is a quarter turn ahead of the direction in which the spin axis leans. The frame
    // `spin` is ahead of `axes` by the azimuth.
    const double turned_rad = motion.azimuth_rad(middle_s) - motion.first_azimuth_rad;
    const double hinge_rad = motion.nutation.first_azimuth_rad +
                             motion.nutation.per_turn() * turned_rad + 0.5 * std::numbers::pi -
                             motion.azimuth_rad(middle_s);
    const double half_angle_rad = motion.nutation.half_angle_at_rad(middle_s);
    NutationStretch stretch{.begin = edges.front().pulse.t,
                            .end = edges.back().pulse.t + std::chrono::nanoseconds{1},
                            .per_turn = motion.nutation.per_turn(),
                            .unknowns = {half_angle_rad * std::cos(hinge_rad),
                                         half_angle_rad * std::sin(hinge_rad), 0.0, 0.0}};
    stretch.unknowns[2] = motion.nutation.growth_per_s * stretch.half_s();
    SensorBiases biases = SensorBiases::Zero();
    biases[ConingX] = motion.coning.tilt_rad * std::sin(motion.coning.azimuth_rad);
    biases[ConingY] = motion.coning.tilt_rad * std::cos(motion.coning.azimuth_rad);
    return {.q_icrf_spin = Eigen::Quaterniond{R_icrf_axes * azimuth.toRotationMatrix()},
            .rate_rad_s = motion.rate_rad_s,
            .drift_rad_s2 = 0.0,
            .biases = biases,
            .nutation = {stretch}};
  }
};

TEST(NutationStretch, TheTrueMotionLeavesNothingOver) {
  Scene scene;
  const PassModel model = scene.model();
  const SpinState state = scene.state(model);
  ASSERT_GT(scene.edges.size(), 300U);
  for (const PassEdge& edge : scene.edges) {
    const auto residual = model.at(state).residual(edge.pulse).value();
    // Sun and Earth are held constant for ten seconds, so the curvature of the orbit matters.
    EXPECT_NEAR(residual.off, 0.0, 0.03) << name_of(edge.pulse.channel);
  }
}

TEST(NutationStretch, SlopesAreThoseOfTheResidual) {
  Scene scene;
  const PassModel model = scene.model();
  SpinState state = scene.state(model);
  for (int i = 0; i < kBatchUnknowns + kNutationUnknowns; ++i) {
    state = stepped(model, state, i, i == kMotionUnknowns + Co2HeightBias ? 3.0 : 0.003);
  }
  for (const PassEdge& edge : scene.edges) {
    // rotation_per_vector neglects the third power of 2 deg.
    expect_slopes(model, state, edge.pulse, kBatchUnknowns + kNutationUnknowns, 1e-5);
  }
}

}  // namespace spindrift::testing::nutation_stretch_test
