/// Initial phase, rate and drift about an approximate axis, compared with the oracle's body.

#include "pipelines/spin/batch/initial_state.h"

#include <cmath>
#include <random>

#include "pipelines/frames/angle.h"
#include "pipelines/frames/celestial.h"
#include "tests/support/batch_pass.h"
#include "tests/support/matchers.h"

namespace spindrift::testing::initial_state_test {

constexpr double kTurns = 100.0;

struct Scene : testing::BatchScene {
  std::vector<PassEdge> edges =
      counted(body, pulses_from(edges_of_turns(body, around, kTurns), kTransferStart));

  Scene() : BatchScene{1815} {}

  PassModel model() const { return BatchScene::model(edges); }
  SpinState first() const { return initial_state(model(), edges, body.axis_icrf).value(); }
};

/// Returns the largest difference of the rotation angle at the ends and the middle of the pass.
double apart_rad(const PassModel& model, const SpinState& one, const SpinState& other) {
  const double phase_rad = 2.0 * std::atan2((one.q_icrf_spin.conjugate() * other.q_icrf_spin).z(),
                                            (one.q_icrf_spin.conjugate() * other.q_icrf_spin).w());
  double most_rad = 0.0;
  for (const double part : {-1.0, 0.0, 1.0}) {
    const double dt_s = part * model.half_s();
    const double turned_rad = (other.rate_rad_s - one.rate_rad_s) * dt_s +
                              0.5 * (other.drift_rad_s2 - one.drift_rad_s2) * dt_s * dt_s;
    most_rad = std::max(most_rad, std::abs(wrapped_rad(phase_rad + turned_rad)));
  }
  return most_rad;
}

struct FirstClockTest : ::testing::Test {
  Scene scene;
};

TEST_F(FirstClockTest, IsThatOfTheBodyAboutItsAxis) {
  const PassModel model = scene.model();
  const SpinState first = scene.first();
  EXPECT_LT(angle_between_rad(first.axis_icrf(), scene.body.axis_icrf), 1e-12);
  // Sun and Earth are held constant for ten seconds; the limit is 1/100 of a sun edge's noise.
  EXPECT_LT(apart_rad(model, true_state(scene.body, model), first), 6e-6);
}

TEST_F(FirstClockTest, ADriftOfTheRateIsFound) {
  const PassModel even = scene.model();
  // A delay of c dt^2 belongs to a body whose rate w falls by 2 c w a second.
  const double late_s = 2e-4;
  const double half_s = even.half_s();
  for (PassEdge& edge : scene.edges) {
    const double part = seconds_between(even.middle(), edge.pulse.t) / half_s;
    edge.pulse.t += std::chrono::nanoseconds{std::llround(1e9 * late_s * part * part)};
  }
  const double rate_rad_s = scene.body.rate_rad_s;
  EXPECT_NEAR(scene.first().drift_rad_s2 / (-2.0 * rate_rad_s * late_s / (half_s * half_s)), 1.0,
              0.01);
}

TEST(FirstClock, EdgesCountedToAnotherTurnAreCountedAnew) {
  std::bernoulli_distribution wrong{0.2};
  for (const bool at_random : {true, false}) {
    Scene scene;
    const PassModel model = scene.model();
    const SpinState well_counted = scene.first();
    for (PassEdge& edge : scene.edges) {
      edge.revolution += at_random ? wrong(scene.rng) : edge.revolution > 70;
    }
    EXPECT_LT(apart_rad(model, well_counted, scene.first()), 1e-9) << at_random;
  }
}

TEST_F(FirstClockTest, CountsFromAnyNumberOn) {
  const SpinState from_zero = scene.first();
  for (PassEdge& edge : scene.edges) {
    edge.revolution += 1'000'000;
  }
  EXPECT_EQ(scene.first().rate_rad_s, from_zero.rate_rad_s);
  EXPECT_EQ(scene.first().drift_rad_s2, from_zero.drift_rad_s2);
}

TEST_F(FirstClockTest, AnAxisDegreesOffMakesItNoMoreDegreesWrong) {
  const PassModel model = scene.model();
  const SpinState truth = true_state(scene.body, model);
  for (const double off_deg : {1.0, 5.0, 15.0}) {
    SCOPED_TRACE(off_deg);
    const Eigen::Vector3d axis_icrf = start_near(scene.body, off_deg * kRadPerDeg, scene.rng);
    const auto first = initial_state(model, scene.edges, axis_icrf);
    ASSERT_TRUE(first) << first.error().message;
    EXPECT_LT(angle_between_rad(first->axis_icrf(), axis_icrf), 1e-12);
    EXPECT_LT(std::abs(first->rate_rad_s - truth.rate_rad_s) * model.half_s(),
              off_deg * kRadPerDeg);
  }
}

TEST_F(FirstClockTest, ThreeTurnsSuffice) {
  std::erase_if(scene.edges, [](const PassEdge& edge) { return edge.revolution >= 3; });
  const PassModel model = scene.model();
  EXPECT_LT(apart_rad(model, true_state(scene.body, model), scene.first()), 6e-6);
}

TEST_F(FirstClockTest, AnAxisThatHasNoneOfTheEdgesIsRefused) {
  std::erase_if(scene.edges, [](const PassEdge& edge) {
    return edge.pulse.channel == PulseChannel::Sun1 || edge.pulse.channel == PulseChannel::Sun2;
  });
  // Beams across the axis miss an Earth that lies on the axis.
  const Eigen::Vector3d axis_icrf = scene.around.earth_icrf_km(0.0).normalized();
  EXPECT_THAT(initial_state(scene.model(), scene.edges, axis_icrf),
              IsRefused(ErrorCode::Unobservable, HasSubstr("no edge is one that a body")));
}

}  // namespace spindrift::testing::initial_state_test
