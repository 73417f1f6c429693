#include "pipelines/spin/batch/changepoint.h"

#include <cmath>
#include <numbers>

#include "pipelines/frames/angle.h"
#include "pipelines/spin/batch/batch_fit.h"
#include "pipelines/time/time_span.h"
#include "tests/support/batch_pass.h"
#include "tests/support/matchers.h"

namespace spindrift::testing::changepoint_test {

constexpr double kTurns = 128.0;
constexpr double kChangeTurn = 80.0;

struct Scene : testing::BatchScene {
  Scene() : BatchScene{1829} {}

  /// Returns the state that fits the edges best.
  SpinState fitted(std::span<const PassEdge> edges) const {
    const PassModel of = model(edges);
    return fit(of, edges, true_state(body, of), {}).value().state;
  }
  std::optional<Changepoint> changepoint(std::span<const PassEdge> edges) const {
    return find_changepoint(model(edges), edges, fitted(edges));
  }
  double misfit(std::span<const PassEdge> edges) const {
    return information_of(model(edges), edges, fitted(edges)).squares;
  }
};

/// Returns the edges of one body before a revolution and those of another from it on.
std::vector<PassEdge> joined(std::vector<PassEdge> before, std::vector<PassEdge> after,
                             std::int64_t from_revolution) {
  std::erase_if(before, [&](const PassEdge& edge) { return edge.revolution >= from_revolution; });
  std::erase_if(after, [&](const PassEdge& edge) { return edge.revolution < from_revolution; });
  before.insert(before.end(), after.begin(), after.end());
  return before;
}

SpinningBody tilted(SpinningBody body, double by_rad) {
  body.axis_icrf = Eigen::AngleAxisd{by_rad, body.axis_icrf.unitOrthogonal()} * body.axis_icrf;
  return body;
}

/// Changes the rate by `share` from a turn on, which shifts edges the more the later they are.
std::vector<PassEdge> faster_from(const SpinningBody& body, double turn, double share,
                                  std::vector<PassEdge> edges) {
  const TaiTime at = later_by_s(kTransferStart, body.seconds_of(turn));
  for (PassEdge& edge : edges) {
    const double since_s = std::max(seconds_between(at, edge.pulse.t), 0.0);
    edge.pulse.t -= std::chrono::nanoseconds{std::llround(1e9 * share * since_s)};
  }
  return edges;
}

double turns_apart(const SpinningBody& body, TaiTime t, double turn) {
  return seconds_between(kTransferStart, t) * body.rate_rad_s / (2.0 * std::numbers::pi) - turn;
}

// 1/64 of the pass is two turns; where the likelihood is flat, the neighbouring one may be found.
constexpr double kNear_turns = 6.0;

struct ChangepointTest : ::testing::Test {
  Scene scene;
};

TEST_F(ChangepointTest, OneAttitudeAtOneRateHasNone) {
  for (int pass = 0; pass < 30; ++pass) {
    scene.body = random_body(scene.around, 3.0 * kRadPerDeg, scene.rng);
    const auto edges = scene.pass(kTurns);
    EXPECT_FALSE(scene.changepoint(edges)) << "pass " << pass;
  }
}

TEST_F(ChangepointTest, AStepOfTheRateIsFoundWhereItWas) {
  const auto edges = faster_from(scene.body, kChangeTurn, 3e-5, scene.pass(kTurns));
  const auto change = scene.changepoint(edges).value();
  EXPECT_NEAR(turns_apart(scene.body, change.t, kChangeTurn), 0.0, kNear_turns);
  EXPECT_EQ(edges[change.first_edge].pulse.t, change.t);
}

TEST_F(ChangepointTest, TheGainIsWhatTwoFitsExplainMore) {
  const auto edges = faster_from(scene.body, kChangeTurn, 2e-5, scene.pass(kTurns));
  const auto change = scene.changepoint(edges).value();
  const std::span<const PassEdge> all{edges};
  const double gain = scene.misfit(all) - scene.misfit(all.first(change.first_edge)) -
                      scene.misfit(all.subspan(change.first_edge));
  // The detector takes one linear step instead of a fit and uses the mean of Tukey's weight.
  EXPECT_NEAR(change.gain / gain, 1.0, 0.05);
}

TEST_F(ChangepointTest, ASmallTiltIsFoundWhereItWas) {
  const auto edges =
      joined(scene.pass(kTurns), scene.pass_of(tilted(scene.body, 0.3 * kRadPerDeg), kTurns),
             static_cast<std::int64_t>(kChangeTurn));
  const auto change = scene.changepoint(edges).value();
  EXPECT_NEAR(turns_apart(scene.body, change.t, kChangeTurn), 0.0, kNear_turns);
}

TEST_F(ChangepointTest, NoiseBeyondWhatIsStatedIsNoChange) {
  const auto stated = scene.body.config.noise;
  scene.body.config.noise = {.sun_s = 2.0 * stated.sun_s, .infrared_s = 2.0 * stated.infrared_s};
  const auto edges = scene.pass(kTurns);
  scene.body.config.noise = stated;
  EXPECT_FALSE(scene.changepoint(edges));
}

TEST_F(ChangepointTest, OfTwoLargeOnesTheLastIsFound) {
  const auto here = scene.pass(kTurns);
  const auto there = scene.pass_of(tilted(scene.body, 10.0 * kRadPerDeg), kTurns);
  const auto edges = joined(joined(here, there, 40), here, 90);
  const PassModel model = scene.model(edges);
  const auto change = find_changepoint(model, edges, true_state(scene.body, model)).value();
  EXPECT_NEAR(turns_apart(scene.body, change.t, 90.0), 0.0, kNear_turns);
}

/// Delays `some` consecutive edges by half a second.
std::vector<PassEdge> spoilt(std::vector<PassEdge> edges, std::size_t from, std::size_t some) {
  for (std::size_t i = from; i < from + some; ++i) {
    edges[i].pulse.t += std::chrono::milliseconds{500};
  }
  return edges;
}

TEST_F(ChangepointTest, AFewOutliersAreNoneAndManyOnEndAreOne) {
  auto edges = scene.pass(kTurns);
  edges.resize(57);
  const PassModel model = scene.model(edges);
  const SpinState state = scene.fitted(edges);
  for (const std::size_t from : {0U, 1U, 20U, 40U, 50U}) {
    EXPECT_FALSE(find_changepoint(model, spoilt(edges, from, 7), state)) << from;
  }
  const auto change = find_changepoint(model, spoilt(edges, 42, 15), state).value();
  EXPECT_EQ(change.first_edge, 42U);
}

TEST_F(ChangepointTest, ALinkThatBecomesBadIsNone) {
  auto edges = scene.pass(kTurns);
  const SpinState state = scene.fitted(edges);
  const PassModel model = scene.model(edges);
  for (std::size_t i = edges.size() / 2; i < edges.size(); i += 3) {
    edges = spoilt(std::move(edges), i, 1);
  }
  EXPECT_FALSE(find_changepoint(model, edges, state));
}

TEST_F(ChangepointTest, OneEdgeCannotChange) {
  auto edges = scene.pass(kTurns);
  const SpinState state = scene.fitted(edges);
  edges.resize(1);
  EXPECT_FALSE(find_changepoint(scene.model(edges), edges, state));
}

TEST_F(ChangepointTest, AStateThatHasNoneOfTheEdgesShowsNone) {
  const auto edges = scene.pass(kTurns);
  const PassModel model = scene.model(edges);
  SpinState opposite = true_state(scene.body, model);
  opposite.q_icrf_spin = opposite.q_icrf_spin * Eigen::Quaterniond{Eigen::AngleAxisd{
                                                    std::numbers::pi, Eigen::Vector3d::UnitX()}};
  EXPECT_FALSE(find_changepoint(model, edges, opposite));
}

}  // namespace spindrift::testing::changepoint_test
