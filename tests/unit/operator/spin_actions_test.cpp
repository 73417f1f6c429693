#include <Eigen/Geometry>
#include <algorithm>
#include <random>
#include <utility>
#include <vector>

#include "pipelines/frames/angle.h"
#include "pipelines/frames/celestial.h"
#include "pipelines/spin/batch/batch_estimator.h"
#include "pipelines/spin/batch/multi_start.h"
#include "pipelines/spin/batch/pass_edges.h"
#include "pipelines/spin/pass/spin_pass.h"
#include "tests/support/assessed.h"
#include "tests/support/matchers.h"
#include "tests/support/observed_spin.h"
#include "tests/support/product_text.h"
#include "tests/support/spinning_body.h"

namespace spindrift::testing::spin_actions_test {

TaiTime at(double t_s) { return shifted(kTransferStart, t_s); }

/// Holds an action that is taken before the edges of `said_s` arrive.
struct Said {
  double said_s;
  double from_s;
  SpinAction action;
};

struct Passed {
  SpinOutput output;
  PassEdges edges;
  std::optional<SpinPrior> prior;
};

Passed run(const SpinConfig& config, const Orbit& orbit, const std::vector<Pulse>& pulses,
           const std::vector<Said>& words) {
  SpinPass pass{config, orbit};
  Passed passed;
  const auto note = [&](SpinOutput output) {
    for (SpinProduct& product : output.products) {
      passed.edges.collect(product);
      passed.output.products.push_back(std::move(product));
    }
  };
  auto next = words.begin();
  for (const Pulse& pulse : pulses) {
    for (; next != words.end() && at(next->said_s) <= pulse.t; ++next) {
      pass.act(at(next->from_s), next->action);
      passed.edges.act(at(next->from_s), next->action);
    }
    note(pass.push(pulse));
  }
  note(pass.finish());
  passed.prior = pass.told_prior();
  return passed;
}

struct Scene : Surroundings {
  std::mt19937_64 rng{27};
  SpinningBody body = random_body(around, 3.0 * kRadPerDeg, rng);

  std::vector<Pulse> seen(double from_s, double to_s) { return pulses(body, from_s, to_s, rng); }
  Passed run(const std::vector<Pulse>& pulses, const std::vector<Said>& words) const {
    return spin_actions_test::run(body.config, orbit, pulses, words);
  }
};

bool is_left_out(const PulseUse& use) { return use.rejected_by == Rejection::Operator; }

TEST(SpinActions, LeaveOutAChannelFromThenOnUntilItIsTakenInAgain) {
  Scene scene;
  const auto pulses = scene.seen(0.0, 120.0);
  const auto channel = PulseChannel::NorthIn;
  const Passed passed = scene.run(
      pulses, {{.said_s = 0.0, .from_s = 40.0, .action = ExcludeChannel<PulseChannel>{channel}},
               {.said_s = 60.0, .from_s = 80.0, .action = IncludeChannel<PulseChannel>{channel}}});
  std::size_t left_out = 0;
  for (const PulseUse& use : all_of<PulseUse>(passed.output)) {
    const bool is_meant =
        use.pulse.channel == channel && use.pulse.t >= at(40.0) && use.pulse.t < at(80.0);
    EXPECT_EQ(is_left_out(use), is_meant);
    left_out += is_meant ? 1 : 0;
  }
  EXPECT_GE(left_out, 37U);
  const SpinEstimate last = last_estimate(passed.output, SpinEstimator::Sequential);
  EXPECT_TRUE(is_unopposed(last.assessment.quality));
}

TEST(SpinActions, LeaveOutASegmentOfAllChannelsAndForgetItsEdges) {
  Scene scene;
  const auto pulses = scene.seen(0.0, 120.0);
  const Passed passed = scene.run(
      pulses,
      {{.said_s = 60.0,
        .from_s = 0.0,
        .action = ExcludeSegment<PulseChannel>{.from = at(30.0), .to = at(90.0), .channel = {}}}});
  for (const PulseUse& use : all_of<PulseUse>(passed.output)) {
    if (use.pulse.t >= at(60.0)) {
      EXPECT_EQ(is_left_out(use), use.pulse.t < at(90.0));
    } else if (use.pulse.t < at(58.0)) {
      EXPECT_FALSE(is_left_out(use));  // Computed results stay.
    }
  }
  PassEdges edges = passed.edges;
  const auto kept = std::move(edges).edges();
  EXPECT_GT(kept.size(), 300U);
  for (const PassEdge& edge : kept) {
    EXPECT_TRUE(edge.pulse.t < at(30.0) || edge.pulse.t >= at(90.0));
  }
}

/// Returns the fixes from some revolutions after the loss of a beam.
std::vector<SpinFix> fixes_without_a_beam(const Passed& passed) {
  std::vector<SpinFix> fixes = all_of<SpinFix>(passed.output);
  std::erase_if(fixes, [](const SpinFix& fix) { return fix.t < at(40.0); });
  EXPECT_GT(fixes.size(), 50U);
  return fixes;
}

TEST(SpinActions, ABeamThatIsLeftOutIsNotSilent) {
  Scene scene;
  scene.body.config.north->healthy = true;
  std::vector<Pulse> pulses = scene.seen(0.0, 100.0);
  std::vector<Said> words;
  for (const PulseChannel channel : {PulseChannel::NorthIn, PulseChannel::NorthOut}) {
    words.push_back({0.0, 30.0, ExcludeChannel<PulseChannel>{channel}});
  }
  const Passed left_out = scene.run(pulses, words);
  int accepted = 0;
  for (const SpinFix& fix : fixes_without_a_beam(left_out)) {
    EXPECT_TRUE(fix.accepted || fix.resolution == Resolution::Ambiguous) << fix.revolution;
    accepted += fix.accepted ? 1 : 0;
  }
  EXPECT_GT(accepted, 50);
  // The beam is not excluded but silent, although it should see the Earth.
  std::erase_if(pulses, [](const Pulse& pulse) {
    return pulse.t >= at(30.0) &&
           (pulse.channel == PulseChannel::NorthIn || pulse.channel == PulseChannel::NorthOut);
  });
  for (const SpinFix& fix : fixes_without_a_beam(scene.run(pulses, {}))) {
    EXPECT_FALSE(fix.accepted) << fix.revolution;
  }
}

/// Holds a pass with sun slit 1 and the south beam only, where two axes fit all edges alike.
struct TwoRoots : Surroundings {
  SpinningBody body;
  std::vector<Pulse> pulses;

  TwoRoots() {
    std::mt19937_64 rng{2};
    body = random_body(around, 3.0 * kRadPerDeg, rng);
    auto edges = edges_between(body, around, 0.0, 200.0);
    std::erase_if(edges, [](const auto& edge) {
      return edge.channel == PulseChannel::Sun2 || edge.channel == PulseChannel::NorthIn ||
             edge.channel == PulseChannel::NorthOut;
    });
    pulses = noisy_pulses(body, edges, rng);
  }
  Passed run(const std::vector<Said>& words) const {
    return spin_actions_test::run(body.config, orbit, pulses, words);
  }

  /// Returns the root that is not the true axis.
  Eigen::Vector3d false_root() const {
    const SpinFix fix = all_of<SpinFix>(run({}).output).back();
    std::vector<Eigen::Vector3d> roots{fix.axis_icrf};
    for (const SpinAlternate& alternate : fix.alternates) {
      roots.push_back(alternate.axis_icrf);
    }
    return *std::ranges::max_element(roots, [&](const auto& a, const auto& b) {
      return angle_between_rad(a, body.axis_icrf) < angle_between_rad(b, body.axis_icrf);
    });
  }
};

double error_deg(const SpinEstimate& estimate, const Eigen::Vector3d& axis_icrf) {
  return angle_between_rad(estimate.axis_icrf, axis_icrf) * kDegPerRad;
}

Passed with_root(const TwoRoots& pass, const Eigen::Vector3d& root) {
  // The chosen axis is some degrees off, because only the nearer root counts.
  const Eigen::Vector3d near = Eigen::AngleAxisd{2.0 * kRadPerDeg, root.unitOrthogonal()} * root;
  return pass.run({{.said_s = 100.0, .from_s = 100.0, .action = ChooseRoot{near}}});
}

TEST(SpinActions, AChosenRootSettlesAnAmbiguousPassForAllEstimators) {
  const TwoRoots pass;
  Passed passed = with_root(pass, pass.body.axis_icrf);
  const auto fixes = all_of<SpinFix>(passed.output);
  EXPECT_EQ(fixes.front().resolution, Resolution::Ambiguous);
  EXPECT_EQ(fixes.back().resolution, Resolution::Prior);
  for (const auto estimator : {SpinEstimator::Mean, SpinEstimator::Sequential}) {
    const SpinEstimate last = last_estimate(passed.output, estimator);
    EXPECT_TRUE(is_unopposed(last.assessment.quality));
    EXPECT_LT(error_deg(last, pass.body.axis_icrf), 1.0);
  }
  SpinConfig config = pass.body.config;
  config.prior = passed.prior;
  auto starts = passed.edges.starts(config.prior);
  starts.of_pass = all_of<AxisChoice>(passed.output).back();
  EXPECT_EQ(starts.of_pass->settled_by, SettledBy::Prior);
  const auto edges = std::move(passed.edges).edges();
  const auto batch = solve_batch(config, pass.orbit, edges, starts).value();
  EXPECT_LT(error_deg(batch.estimate, pass.body.axis_icrf), 1.0);
  EXPECT_NE(batch.estimate.assessment.quality, Quality::Ambiguous);
  // What the pass settled after the first ten fixes depends on the operator's choice as they do.
  EXPECT_EQ(said_resolution(fixes.back()), Resolution::Prior);
  EXPECT_EQ(batch.choice.settled_by, SettledBy::Prior);
  EXPECT_GT(angle_between_rad(batch.choice.other_icrf.value(), pass.body.axis_icrf),
            5.0 * kRadPerDeg);
}

TEST(SpinActions, ARootIsChosenAmongTheAxesThatSequentialNames) {
  const TwoRoots pass;
  std::vector<SpinEstimate> before = all_of<SpinEstimate>(pass.run({}).output);
  std::erase_if(before, [](const SpinEstimate& estimate) {
    return estimate.estimator != SpinEstimator::Sequential || estimate.t >= at(100.0);
  });
  const auto& reasons = before.back().assessment.reasons;
  const Eigen::Vector3d named = direction_icrf(
      {.ra_rad = kRadPerDeg * number_of(reasons, ReasonCode::OtherAxis, "ra_deg"),
       .dec_rad = kRadPerDeg * number_of(reasons, ReasonCode::OtherAxis, "dec_deg")});
  const Passed passed = pass.run({{.said_s = 100.0, .from_s = 100.0, .action = ChooseRoot{named}}});
  ASSERT_TRUE(passed.prior);
  EXPECT_LT(angle_between_rad(passed.prior->axis_icrf, named), 1e-9);
}

TEST(SpinActions, WhereNothingSettlesAPassItsEdgesAllTogetherMay) {
  const TwoRoots pass;
  Passed passed = pass.run({});
  auto starts = passed.edges.starts({});
  starts.of_pass = all_of<AxisChoice>(passed.output).back();
  EXPECT_EQ(starts.of_pass->settled_by, SettledBy::Nothing);
  const auto batch =
      solve_batch(pass.body.config, pass.orbit, std::move(passed.edges).edges(), starts).value();
  EXPECT_EQ(batch.choice.axis_icrf, batch.estimate.axis_icrf);
  EXPECT_EQ(batch.choice.settled_by, SettledBy::Edges);
  EXPECT_GT(batch.choice.delta_chi_square.value(), kSettled);
}

TEST(SpinActions, AChosenRootThatTheEdgesContradictIsGivenUp) {
  const TwoRoots pass;
  const Passed passed = with_root(pass, pass.false_root());
  const auto fixes = all_of<SpinFix>(passed.output);
  EXPECT_GT(std::ranges::count(fixes, Resolution::Prior, &SpinFix::resolution), 0);
  EXPECT_TRUE(passed.prior);  // The prior is passed to `batch`, which evaluates it again.
  EXPECT_EQ(fixes.back().resolution, Resolution::Ambiguous);
}

TEST(SpinActions, APriorAgainstWhatThePassHasSettledBeginsAnew) {
  const TwoRoots pass;
  const auto prior = [](const Eigen::Vector3d& axis_icrf) {
    return SetPrior{{.axis_icrf = axis_icrf, .sigma_rad = 2.0 * kRadPerDeg}};
  };
  const Passed passed =
      pass.run({{.said_s = 0.0, .from_s = 0.0, .action = prior(pass.false_root())},
                {.said_s = 80.0, .from_s = 100.0, .action = prior(pass.body.axis_icrf)}});
  EXPECT_TRUE(
      std::ranges::any_of(all_of<SpinEstimate>(passed.output), [&](const SpinEstimate& estimate) {
        return estimate.t < at(100.0) && error_deg(estimate, pass.body.axis_icrf) > 5.0;
      }));
  const SpinEstimate last = last_estimate(passed.output, SpinEstimator::Sequential);
  EXPECT_LT(error_deg(last, pass.body.axis_icrf), 3.0);
}

TEST(SpinActions, BehindAMarkedManoeuvreNoEstimateHoldsTheAxisOfBefore) {
  Scene scene;
  SpinningBody after = scene.body;
  after.axis_icrf =
      Eigen::AngleAxisd{1.0 * kRadPerDeg, scene.around.earth_icrf_km(100.0).normalized()} *
      scene.body.axis_icrf;
  std::vector<Pulse> pulses = scene.seen(0.0, 100.0);
  const std::vector<Pulse> later = scene.pulses(after, 100.0, 160.0, scene.rng);
  pulses.insert(pulses.end(), later.begin(), later.end());
  std::ranges::sort(pulses);
  const auto worst_sigmas = [&](const std::vector<Said>& words) {
    double worst = 0.0;
    for (const SpinEstimate& estimate : all_of<SpinEstimate>(scene.run(pulses, words).output)) {
      if (estimate.t > at(104.0)) {
        worst = std::max(worst,
                         error_deg(estimate, after.axis_icrf) * kRadPerDeg / sigma_rad(estimate));
      }
    }
    return worst;
  };
  EXPECT_GT(worst_sigmas({}), 8.0);
  EXPECT_LT(worst_sigmas({{.said_s = 90.0, .from_s = 100.0, .action = MarkManoeuvre{}}}), 4.0);
}

TEST(SpinActions, AManoeuvreBeforeThePassChangesNothing) {
  Scene scene;
  const auto pulses = scene.seen(10.0, 60.0);
  const auto texts_with = [&](const std::vector<Said>& words) {
    return texts_of(scene.run(pulses, words).output);
  };
  EXPECT_EQ(texts_with({{.said_s = 0.0, .from_s = 0.0, .action = MarkManoeuvre{}}}),
            texts_with({}));
}

TEST(SpinActions, BatchForgetsWhatIsBeforeAManoeuvreOnceAnEdgeIsBehindIt) {
  PassEdges edges;
  const auto see = [&](double t_s) {
    edges.collect(PulseUse{.pulse = {.t = at(t_s), .channel = PulseChannel::Sun1},
                           .revolution = static_cast<std::int64_t>(t_s),
                           .rejected_by = {}});
  };
  see(1.0);
  edges.act(at(10.0), MarkManoeuvre{});
  see(2.0);
  EXPECT_EQ((PassEdges{edges}.edges().size()), 2U);
  see(11.0);
  see(12.0);
  EXPECT_EQ((PassEdges{edges}.edges().size()), 2U);
}

}  // namespace spindrift::testing::spin_actions_test
