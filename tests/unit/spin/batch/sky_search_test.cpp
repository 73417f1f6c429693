#include "pipelines/spin/batch/sky_search.h"

#include <Eigen/Geometry>
#include <algorithm>
#include <vector>

#include "pipelines/frames/angle.h"
#include "pipelines/frames/celestial.h"
#include "pipelines/spin/batch/batch_fit.h"
#include "pipelines/spin/batch/initial_state.h"
#include "pipelines/spin/batch/pass_information.h"
#include "tests/support/batch_pass.h"
#include "tests/support/matchers.h"

namespace spindrift::testing::sky_search_test {

using Eigen::Vector3d;

/// Holds a pass and the best state about an axis near a given one.
struct Searched {
  std::vector<PassEdge> edges;
  PassModel model;

  SpinState fitted(const Vector3d& axis_icrf) const {
    const SpinState start = initial_state(model, edges, axis_icrf).value();
    return fit(model, edges, coarse_fit(model, edges, start, {}), {}).value().state;
  }
  double misfit(const SpinState& state) const {
    return information_of(model, edges, state).misfit();
  }
  std::vector<Vector3d> others(const SpinState& state) const {
    return competing_axes(state, model, edges, {});
  }
};

Searched usual_pass(BatchScene& scene) {
  auto edges = scene.pass(20.0);
  PassModel model = scene.model(edges);
  return {.edges = std::move(edges), .model = std::move(model)};
}

TEST(SkySearch, APassOfAllSensorsHasNoOtherAxis) {
  BatchScene scene{71};
  const Searched pass = usual_pass(scene);
  EXPECT_TRUE(pass.others(pass.fitted(scene.body.axis_icrf)).empty());
}

TEST(SkySearch, FromAFalseAxisTheTrueOneIsTheFirst) {
  BatchScene scene{73};
  const Searched pass = usual_pass(scene);
  SpinState wrong = true_state(scene.body, pass.model);
  wrong.q_icrf_spin = frame_about(scene.body.axis_icrf.unitOrthogonal());
  const auto others = pass.others(wrong);
  ASSERT_FALSE(others.empty());
  EXPECT_LT(angle_between_rad(others.front(), scene.body.axis_icrf), 0.1 * kRadPerDeg);
}

/// Holds a pass with sun slit 1 and the south beam only, where two axes fit all edges alike.
struct TwoRoots {
  BatchScene scene{2};
  Searched pass = searched();

  Searched searched() {
    auto edges = edges_of_turns(scene.body, scene.around, 30.0);
    std::erase_if(edges, [](const Edge& edge) {
      return edge.channel == PulseChannel::Sun2 || edge.channel == PulseChannel::NorthIn ||
             edge.channel == PulseChannel::NorthOut;
    });
    auto counted = noisy_pass(scene.body, edges, scene.rng);
    PassModel model = scene.model(counted);
    return {.edges = std::move(counted), .model = std::move(model)};
  }
};

TEST(SkySearch, WhereTwoAxesFitAllEdgesEachNamesTheOther) {
  const TwoRoots two;
  const Searched& pass = two.pass;
  const SpinState best = pass.fitted(two.scene.body.axis_icrf);
  EXPECT_LT(angle_between_rad(best.axis_icrf(), two.scene.body.axis_icrf), 2.0 * kRadPerDeg);
  const auto others = pass.others(best);
  ASSERT_FALSE(others.empty());
  const SpinState other = pass.fitted(others.front());
  EXPECT_LT(pass.misfit(other), pass.misfit(best) + 100.0);
  const auto back = pass.others(other);
  ASSERT_FALSE(back.empty());
  EXPECT_LT(angle_between_rad(back.front(), best.axis_icrf()), 0.2 * kRadPerDeg);
}

/// With few edges the sample contains all of them, so the result can be checked on the edges.
TEST(SkySearch, NamesFewAndDistinctAxesBestFirstThatExplainTheEdgesAboutAsWell) {
  const TwoRoots two;
  const Searched& pass = two.pass;
  ASSERT_LE(pass.edges.size(), 400U);
  const SpinState best = pass.fitted(two.scene.body.axis_icrf);
  const auto others = pass.others(best);
  EXPECT_LE(others.size(), 4U);
  EXPECT_FALSE(others.empty());
  double last = 0.0;
  for (const Vector3d& axis : others) {
    const double misfit = pass.misfit(pass.fitted(axis));
    EXPECT_LT(misfit, pass.misfit(best) + 100.0);
    EXPECT_GE(misfit, last - 1e-3);
    last = misfit;
    EXPECT_NEAR(axis.norm(), 1.0, 1e-9);
    EXPECT_GT(angle_between_rad(axis, best.axis_icrf()), 1.0 * kRadPerDeg);
    EXPECT_EQ(std::ranges::count_if(others,
                                    [&](const Vector3d& other) {
                                      return angle_between_rad(axis, other) < 1.0 * kRadPerDeg;
                                    }),
              1);
  }
}

}  // namespace spindrift::testing::sky_search_test
