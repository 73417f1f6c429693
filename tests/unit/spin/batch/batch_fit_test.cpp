#include "pipelines/spin/batch/batch_fit.h"

#include <Eigen/Geometry>
#include <cmath>
#include <random>
#include <vector>

#include "pipelines/frames/angle.h"
#include "pipelines/frames/celestial.h"
#include "tests/support/batch_pass.h"
#include "tests/support/matchers.h"

namespace spindrift::testing::batch_fit_test {

struct ExactPass : testing::ExactPass {
  /// Returns the true state rotated by `turn_rad` in the frame `spin`.
  SpinState turned(const Eigen::Vector3d& turn_rad) const {
    SpinState state = truth;
    state.q_icrf_spin = state.q_icrf_spin * Eigen::Quaterniond{Eigen::AngleAxisd{
                                                turn_rad.norm(), turn_rad.normalized()}};
    return state;
  }
  double off_rad(const SpinState& state) const {
    return state.q_icrf_spin.angularDistance(truth.q_icrf_spin);
  }
};

// Sun and Earth are held constant for ten seconds. The error is a hundredth of an edge's noise
// (pass_model_test), 5e-4 s of a turn of a second or more, averaged over hundreds of edges.
constexpr double kExact_rad = 1e-4;

TEST(BatchFit, ExactEdgesLeadBackFromDegreesAwayAndTheMinimumStays) {
  const ExactPass pass;
  std::vector<SpinState> starts(1, pass.truth);
  starts.front().rate_rad_s += 0.5 * kRadPerDeg / pass.model.half_s();
  for (const Eigen::Vector3d& turn_deg :
       {Eigen::Vector3d{2.0, 0.0, 0.0}, Eigen::Vector3d{0.0, -2.0, 0.0},
        Eigen::Vector3d{0.0, 0.0, 1.0}, Eigen::Vector3d{-1.0, 1.0, 0.5}}) {
    starts.push_back(pass.turned(turn_deg * kRadPerDeg));
  }
  for (const SpinState& start : starts) {
    const auto found = fit(pass.model, pass.edges, start, {}).value();
    EXPECT_LT(pass.off_rad(found.state), kExact_rad);
    // The angle that the rate makes over the pass must be as exact as the others.
    EXPECT_LT(std::abs(found.state.rate_rad_s - pass.truth.rate_rad_s) * pass.model.half_s(),
              kExact_rad);
    EXPECT_LT(std::abs(found.state.drift_rad_s2) * 0.5 * std::pow(pass.model.half_s(), 2),
              kExact_rad);
    EXPECT_TRUE(found.at_bound.none());
    EXPECT_TRUE(found.state.biases.isZero());
  }
  const SpinState minimum = fit(pass.model, pass.edges, pass.truth, {}).value().state;
  const SpinState again = fit(pass.model, pass.edges, minimum, {}).value().state;
  EXPECT_LT(again.q_icrf_spin.angularDistance(minimum.q_icrf_spin), 1e-7);
}

/// The coarse fit has the same model and, with so few edges, uses all of them.
TEST(BatchFit, TheCoarseFitLeadsToTheSameMinimum) {
  const ExactPass pass;
  const SpinState coarse = coarse_fit(
      pass.model, pass.edges, pass.turned(Eigen::Vector3d{3.0, -2.0, 1.0} * kRadPerDeg), {});
  EXPECT_LT(pass.off_rad(coarse), 0.05 * kRadPerDeg);
}

/// Tukey's biweight gives no weight to an edge beyond its limit.
TEST(BatchFit, EdgesFarOffHaveNoInfluence) {
  ExactPass pass;
  const SpinState clean = fit(pass.model, pass.edges, pass.truth, {}).value().state;
  std::mt19937_64 rng{62};
  std::uniform_real_distribution<double> late_s{0.01, 0.05};
  for (std::size_t i = 0; i < pass.edges.size(); i += 10) {
    pass.edges[i].pulse.t = shifted(pass.edges[i].pulse.t, late_s(rng));
  }
  const SpinState spoilt =
      fit(pass.model, pass.edges, pass.turned(Eigen::Vector3d{0.2, 0.1, 0.1} * kRadPerDeg), {})
          .value()
          .state;
  EXPECT_LT(clean.q_icrf_spin.angularDistance(spoilt.q_icrf_spin), kExact_rad);
}

/// Four times the edges must halve the error.
TEST(BatchFit, ErrorsFallWithTheRootOfTheNumberOfEdges) {
  const auto rms_rad = [](double turns) {
    double squares = 0.0;
    constexpr int kPasses = 40;
    for (int i = 0; i < kPasses; ++i) {
      BatchScene scene{static_cast<std::uint64_t>(700 + i)};
      const std::vector<PassEdge> edges = scene.pass(turns);
      const PassModel model = scene.model(edges);
      const SpinState truth = true_state(scene.body, model);
      const auto found = fit(model, edges, truth, {});
      squares += std::pow(angle_between_rad(found.value().state.axis_icrf(), truth.axis_icrf()), 2);
    }
    return std::sqrt(squares / kPasses);
  };
  // Each rms has 80 components, so the ratio has a standard deviation of 1/9 of itself.
  const double ratio = rms_rad(20.0) / rms_rad(80.0);
  EXPECT_GT(ratio, 1.4);
  EXPECT_LT(ratio, 2.8);
}

}  // namespace spindrift::testing::batch_fit_test
