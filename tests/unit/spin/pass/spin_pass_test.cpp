#include "pipelines/spin/pass/spin_pass.h"

#include <algorithm>
#include <map>
#include <random>
#include <set>
#include <string>
#include <utility>
#include <vector>

#include "pipelines/frames/angle.h"
#include "pipelines/frames/celestial.h"
#include "tests/support/assessed.h"
#include "tests/support/matchers.h"
#include "tests/support/product_text.h"
#include "tests/support/pulse_trains.h"
#include "tests/support/recorded_pass.h"
#include "tests/support/stepped_orbit.h"

namespace spindrift::testing::spin_pass_test {

using ::testing::AnyOf;

SpinEstimate mean_of(const SpinOutput& output) {
  return last_estimate(output, SpinEstimator::Mean);
}

SpinEstimate sequential_of(const SpinOutput& output) {
  return last_estimate(output, SpinEstimator::Sequential);
}

double error_rad(const RecordedPass& pass, const SpinEstimate& estimate) {
  return angle_between_rad(estimate.axis_icrf, pass.true_axis_icrf);
}

TEST(SpinPass, FindsTheAxisOfEveryRecordedPass) {
  for (const auto& [name, limit_deg] :
       {std::pair{"nominal", 0.05}, std::pair{"dirty", 0.06}, std::pair{"coded", 0.1},
        std::pair{"north-only", 0.1}, std::pair{"gms5", 0.05}}) {
    SCOPED_TRACE(name);
    const RecordedPass pass = recorded_pass(name);
    const SpinOutput output = run(pass);
    const SpinEstimate sequential = sequential_of(output);
    for (const SpinEstimate& estimate : {mean_of(output), sequential}) {
      EXPECT_LT(error_rad(pass, estimate), limit_deg * kRadPerDeg);
      EXPECT_LT(error_rad(pass, estimate), 3.0 * sigma_rad(estimate));
    }
    EXPECT_TRUE(is_unopposed(sequential.assessment.quality));
  }
}

TEST(SpinPass, RejectsTheBadEdgesOfADirtyPassAndKeepsTheGood) {
  const RecordedPass pass = recorded_pass("dirty");
  ASSERT_EQ(pass.bad_edges.size(), 333U);
  int bad_rejected = 0;
  int good_rejected = 0;
  for (const PulseUse& use : all_of<PulseUse>(run(pass))) {
    if (use.rejected_by) {
      ++(pass.bad_edges.contains(use.pulse) ? bad_rejected : good_rejected);
    }
  }
  EXPECT_GE(bad_rejected, 0.97 * 333);
  EXPECT_LE(good_rejected, 0.01 * static_cast<double>(pass.pulses.size() - 333));
}

/// Two receivers with equal times or with independent noise.
TEST(SpinPass, OfCopiesWithinTheNoiseEveryAnswerIsDoubtful) {
  const RecordedPass pass = recorded_pass("nominal");
  for (const double jitter_s : {0.0, 1e-4}) {
    SCOPED_TRACE(jitter_s);
    std::mt19937_64 rng{316};
    const SpinOutput output =
        run(SpinPass{pass.config, pass.orbit},
            copied(pass.pulses, {.behind_s = 1e-9, .jitter_s = jitter_s}, rng));
    for (const SpinEstimate& last : {mean_of(output), sequential_of(output)}) {
      const bool noisy = jitter_s > 0.0;
      EXPECT_EQ(has(last.assessment, ReasonCode::CopiesInNoise), noisy);
      EXPECT_EQ(last.assessment.quality, noisy ? Quality::Doubtful : Quality::Ok);
      EXPECT_LT(error_rad(pass, last), 5.0 * sigma_rad(last));
    }
    EXPECT_TRUE(testing::has(output.notices, NoticeCode::CopiesBegin));
    EXPECT_EQ(number_of(output.notices, NoticeCode::Copied, "edges"),
              static_cast<double>(pass.pulses.size()));
  }
}

TEST(SpinPass, WithOneBeamNoFixIsOfTwo) {
  int one_chord = 0;
  for (const SpinFix& fix : all_of<SpinFix>(run(recorded_pass("north-only")))) {
    // When the sun angle fails its test, chord and dihedral remain.
    ASSERT_THAT(fix.geometry_case, AnyOf(2, 5));
    one_chord += fix.geometry_case == 2 ? 1 : 0;
  }
  EXPECT_GT(one_chord, 590);
}

const auto kNames = {"nominal", "dirty", "gms5", "north-only"};

TEST(SpinPass, FindsTheSpinRate) {
  for (const char* const name : kNames) {
    SCOPED_TRACE(name);
    const RecordedPass pass = recorded_pass(name);
    const SpinEstimate mean = mean_of(run(pass));
    EXPECT_NEAR(mean.spin_rate_rad_s, pass.true_rate_rad_s, 4.0 * mean.spin_rate_sigma_rad_s);
    EXPECT_LT(mean.spin_rate_sigma_rad_s, 1e-5 * mean.spin_rate_rad_s);
  }
}

TEST(SpinPass, SaysOnceWhatBecameOfEveryEdge) {
  for (const char* const name : kNames) {
    SCOPED_TRACE(name);
    RecordedPass pass = recorded_pass(name);
    std::vector<Pulse> told;
    for (const PulseUse& use : all_of<PulseUse>(run(pass))) {
      told.push_back(use.pulse);
      ASSERT_TRUE(use.revolution || use.rejected_by);
    }
    std::ranges::sort(told);
    std::ranges::sort(pass.pulses);
    EXPECT_EQ(told, pass.pulses);
  }
}

TEST(SpinPass, TakesAnIntervalOfMoreThanAPeriodForAnEdgeOfTheNextRevolution) {
  // At this period an edge that is more than a second behind counts as late.
  constexpr double kPeriod_s = 10.0;
  const RecordedPass pass = recorded_pass("coded");
  std::vector<CodedFrame> frames;
  for (int i = 0; i < 50; ++i) {
    frames.push_back({.t = shifted(pass.frames.front().t, i * kPeriod_s),
                      .period_s = kPeriod_s,
                      .delay_s = {std::nullopt, 11.0, 4.0, 5.0, 14.5, 16.0}});
  }
  std::map<PulseChannel, std::vector<TaiTime>> told;
  for (const PulseUse& use : all_of<PulseUse>(run(SpinPass{pass.config, pass.orbit}, frames))) {
    EXPECT_NE(use.rejected_by, Rejection::Late);
    told[use.pulse.channel].push_back(use.pulse.t);
  }
  EXPECT_EQ(told.size(), kPulseChannels);
  for (const auto& [channel, times] : told) {
    ASSERT_EQ(times.size(), frames.size());
    EXPECT_TRUE(std::ranges::is_sorted(times));
    EXPECT_EQ(times.front(), shifted(frames.front().t,
                                     frames.front().delay_s.at(index_of(channel)).value_or(0.0)));
  }
}

TEST(SpinPass, ComputesASilentStreamUpToTheOpenRevolution) {
  const RecordedPass pass = recorded_pass("coded");
  SpinPass spin{pass.config, pass.orbit};
  constexpr std::size_t kFrames = 50;
  const Pulse last{.t = pass.frames[kFrames - 2].t, .channel = PulseChannel::Sun1};
  const auto tells_last = [&](const SpinOutput& output) {
    return std::ranges::count(all_of<PulseUse>(output), last, &PulseUse::pulse) > 0;
  };
  for (std::size_t i = 0; i < kFrames; ++i) {
    EXPECT_FALSE(tells_last(spin.push(pass.frames[i])));
  }
  EXPECT_TRUE(tells_last(spin.fall_silent()));

  const auto late = all_of<PulseUse>(spin.push(
      Pulse{.t = shifted(pass.frames[kFrames - 1].t, -0.01), .channel = PulseChannel::Sun2}));
  EXPECT_THAT(late, ElementsAre(Field(&PulseUse::rejected_by, Rejection::Late)));
}

TEST(SpinPass, AcceptsNearlyAllOfACleanPass) {
  const auto uses = all_of<PulseUse>(run(recorded_pass("nominal")));
  const auto rejected =
      std::ranges::count_if(uses, [](const PulseUse& use) { return use.rejected_by.has_value(); });
  // Three sigma reject 0.3 % of the measurements; an edge is rejected only with both of its own.
  EXPECT_LT(static_cast<double>(rejected), 0.01 * static_cast<double>(uses.size()));
}

TEST(SpinPass, MeasurementsOfARevolutionAreToldOnce) {
  std::set<std::pair<std::int64_t, SpinQuantity>> told;
  for (const auto& measurement : all_of<SpinMeasurement>(run(recorded_pass("nominal")))) {
    ASSERT_TRUE(told.emplace(measurement.revolution, measurement.quantity).second)
        << measurement.revolution << " " << name_of(measurement.quantity);
  }
  // Six quantities in 600 revolutions, except the period of the first. One sun1 fails its test and
  // adds a mixed azimuth.
  EXPECT_EQ(told.size(), 6U * 600U - 1U + 1U);
}

TEST(SpinPass, TheSameInputGivesTheSameProducts) {
  for (const char* const name : kNames) {
    const RecordedPass pass = recorded_pass(name);
    EXPECT_EQ(texts_of(run(pass)), texts_of(run(pass))) << name;
  }
}

TEST(SpinPass, DuplicatesChangeNothingHoweverLateTheyArrive) {
  const RecordedPass pass = recorded_pass("nominal");
  for (const std::size_t behind : {0U, 100U, 2000U}) {  // The pass has six pulses a second.
    std::vector<Pulse> twice;
    for (std::size_t i = 0; i < pass.pulses.size() + behind; ++i) {
      if (i < pass.pulses.size()) {
        twice.push_back(pass.pulses[i]);
      }
      if (i >= behind) {
        twice.push_back(pass.pulses[i - behind]);
      }
    }
    EXPECT_EQ(texts_of(run(SpinPass{pass.config, pass.orbit}, twice)), texts_of(run(pass)));
  }
}

TEST(SpinPass, OfTwoFramesOfOneInstantThatSayDifferentThingsNoneCounts) {
  const RecordedPass pass = recorded_pass("coded");
  std::vector<CodedFrame> twice;
  for (const CodedFrame& frame : pass.frames) {
    twice.push_back(frame);
    twice.push_back({.t = frame.t, .period_s = frame.period_s, .delay_s = {}});
    twice.back().delay_s[index_of(PulseChannel::Sun2)] = 0.1;
  }
  std::size_t edges = 0;
  for (const SpinProduct& product : run(SpinPass{pass.config, pass.orbit}, twice).products) {
    if (const auto* const use = std::get_if<PulseUse>(&product)) {
      EXPECT_EQ(use->rejected_by, Rejection::Contradicted);
      ++edges;
    }
    EXPECT_FALSE(std::holds_alternative<SpinFix>(product));
  }
  EXPECT_GT(edges, 6 * pass.frames.size());
}

TEST(SpinPass, ALatePulseIsToldAndLeftOut) {
  const RecordedPass pass = recorded_pass("nominal");
  std::vector<Pulse> arrivals = pass.pulses;
  const auto held_back = arrivals.begin() + 300;
  const Pulse late = *held_back;
  // 60 pulses are ten revolutions of one second.
  std::rotate(held_back, held_back + 1, held_back + 60);
  auto told = all_of<PulseUse>(run(SpinPass{pass.config, pass.orbit}, arrivals));
  std::erase_if(told, [&](const PulseUse& use) { return use.pulse != late; });
  EXPECT_THAT(told, ElementsAre(AllOf(Field(&PulseUse::rejected_by, Rejection::Late),
                                      Field(&PulseUse::revolution, std::nullopt))));
}

/// Returns an edge of a channel in the middle of the pass.
std::vector<Pulse>::iterator in_the_middle(RecordedPass& pass, PulseChannel channel) {
  return std::find_if(pass.pulses.begin() + 2000, pass.pulses.end(),
                      [&](const Pulse& pulse) { return pulse.channel == channel; });
}

TEST(SpinPass, AWrongEdgeIsRejectedByTheTestItFails) {
  RecordedPass pass = recorded_pass("nominal");
  Pulse& wrong = *in_the_middle(pass, PulseChannel::NorthOut);
  wrong.t = shifted(wrong.t, 0.01);  // Twenty sigmas of its noise.
  const SpinOutput output = run(pass);
  const auto uses = all_of<PulseUse>(output);
  const auto use = std::ranges::find(uses, wrong, &PulseUse::pulse);
  ASSERT_NE(use, uses.end());
  EXPECT_EQ(use->rejected_by, Rejection::Phase);
  const auto fixes = all_of<SpinFix>(output);
  const auto fix = std::ranges::find(fixes, use->revolution, &SpinFix::revolution);
  ASSERT_NE(fix, fixes.end());
  EXPECT_EQ(fix->geometry_case, 3);  // The other measurements of that revolution are kept.
}

TEST(SpinPass, AnEdgeWithoutItsPartnerIsUsed) {
  RecordedPass pass = recorded_pass("nominal");
  const auto edge = in_the_middle(pass, PulseChannel::SouthIn);
  const TaiTime lost = edge->t;
  pass.pulses.erase(edge);
  int partners = 0;
  for (const PulseUse& use : all_of<PulseUse>(run(pass))) {
    if (use.pulse.channel == PulseChannel::SouthOut && use.pulse.t > lost &&
        use.pulse.t < shifted(lost, 0.5)) {
      EXPECT_TRUE(use.revolution);
      EXPECT_FALSE(use.rejected_by);  // `sequential` uses the edge.
      ++partners;
    }
  }
  EXPECT_EQ(partners, 1);
}

TEST(SpinPass, OutsideTheOrbitMeasurementsStandWithoutAFix) {
  const RecordedPass pass = recorded_pass("nominal");
  std::vector<Pulse> next_day = pass.pulses;
  for (Pulse& pulse : next_day) {
    pulse.t = shifted(pulse.t, 86400.0);
  }
  const SpinOutput output = run(SpinPass{pass.config, pass.orbit}, next_day);
  EXPECT_TRUE(all_of<SpinFix>(output).empty());
  EXPECT_TRUE(all_of<SpinEstimate>(output).empty());
  EXPECT_FALSE(all_of<RevolutionProduct>(output).empty());
  for (const SpinMeasurement& measurement : all_of<SpinMeasurement>(output)) {
    if (measurement.quantity != SpinQuantity::Period) {
      ASSERT_THAT(measurement.rejected_by, AnyOf(Rejection::NoOrbit, Rejection::Phase));
    }
  }
  // One notice for the first such revolution and one for their total at the end.
  EXPECT_THAT(output.notices, ElementsAre(Field(&Notice::code, NoticeCode::OutsideOrbit),
                                          Field(&Notice::code, NoticeCode::MuchOutsideOrbit)));
}

TEST(SpinPass, SaysInTheEndWhichChannelsWereSilentThroughout) {
  RecordedPass pass = recorded_pass("nominal");
  const auto silent = [&] {
    const SpinOutput output = run(pass);
    const auto notice =
        std::ranges::find(output.notices, NoticeCode::SilentChannels, &Notice::code);
    return notice == output.notices.end()
               ? std::vector<std::string>{}
               : std::get<std::vector<std::string>>(notice->values.front().value);
  };
  EXPECT_THAT(silent(), IsEmpty());
  std::erase_if(pass.pulses, [](const Pulse& pulse) {
    return pulse.channel == PulseChannel::Sun2 || pulse.channel == PulseChannel::NorthIn;
  });
  EXPECT_THAT(silent(), ElementsAre("sun2", "north_in"));
  pass.config.north.reset();
  EXPECT_THAT(silent(), ElementsAre("sun2"));
}

TEST(SpinPass, SaysInTheEndWhyThereIsNoMeanAndWhyThePriorDoesNotSettleTheAxis) {
  RecordedPass pass = recorded_pass("north-only");
  std::erase_if(pass.pulses,
                [](const Pulse& pulse) { return pulse.channel == PulseChannel::Sun2; });
  pass.config.prior = SpinPrior{.axis_icrf = -pass.true_axis_icrf, .sigma_rad = kRadPerDeg};
  const SpinOutput output = run(pass);
  const auto fixes = all_of<SpinFix>(output);
  const std::int64_t near_tangent = std::ranges::count(fixes, true, &SpinFix::near_tangent);
  const std::int64_t open = std::ranges::count_if(fixes, [](const SpinFix& fix) {
    return !fix.near_tangent && fix.resolution == Resolution::Ambiguous;
  });
  ASSERT_GT(open, 0);
  const Notice no_mean{NoticeCode::MeanNeverBegan,
                       {{"fixes", static_cast<std::int64_t>(fixes.size())},
                        {"near_tangent", near_tangent},
                        {"ambiguous", open},
                        {"not_accepted", std::int64_t{0}}}};
  EXPECT_THAT(output.notices, Contains(no_mean));
  EXPECT_TRUE(testing::has(output.notices, NoticeCode::AmbiguousPriorNoHelp));
}

/// Holds a pass without north beam and sun2, whose fixes all graze, so that several axes stay open
/// for minutes.
struct GrazingPass : RecordedPass {
  TaiTime acted;  ///< Time of the action.

  explicit GrazingPass(double until_s) : RecordedPass{recorded_pass("nominal")} {
    const TaiTime began = pulses.front().t;
    acted = shifted(began, 60.0);
    std::erase_if(pulses, [&](const Pulse& pulse) {
      using enum PulseChannel;
      return pulse.channel == Sun2 || pulse.channel == NorthIn || pulse.channel == NorthOut ||
             seconds_between(began, pulse.t) > until_s;
    });
  }
  SpinOutput run_with(const std::optional<SpinAction>& action) const {
    SpinPass spin{config, orbit};
    if (action) {
      spin.act(acted, *action);
    }
    return run(std::move(spin), pulses);
  }
  /// Returns an axis off the true one by 17 deg.
  Eigen::Vector3d wrong_icrf() const {
    return Eigen::AngleAxisd{0.3, true_axis_icrf.unitOrthogonal()} * true_axis_icrf;
  }
};

TEST(SpinPass, WhatAnOperatorKnowsOfTheAxisSettlesItUnlessTheEdgesOverruleIt) {
  const GrazingPass pass{180.0};
  EXPECT_EQ(sequential_of(pass.run_with(std::nullopt)).assessment.quality, Quality::Ambiguous);
  for (const SpinAction& action :
       {SpinAction{ChooseRoot{pass.true_axis_icrf}},
        SpinAction{SetPrior{{.axis_icrf = pass.true_axis_icrf, .sigma_rad = kRadPerDeg}}}}) {
    const SpinEstimate settled = sequential_of(pass.run_with(action));
    EXPECT_EQ(settled.assessment.quality, Quality::Ok);
    EXPECT_LT(error_rad(pass, settled), 3.0 * sigma_rad(settled));
  }
  const SpinOutput overruled =
      pass.run_with(SetPrior{{.axis_icrf = pass.wrong_icrf(), .sigma_rad = 3.0 * kRadPerDeg}});
  EXPECT_TRUE(testing::has(overruled.notices, NoticeCode::PriorContradicted));
  const SpinEstimate left = sequential_of(overruled);
  EXPECT_EQ(left.assessment.quality, Quality::Ambiguous);
  EXPECT_LT(error_rad(pass, left), 3.0 * sigma_rad(left));
}

TEST(SpinPass, ARootIsChosenAmongTheFollowedAxesAndNotAmongGrazingFixes) {
  const GrazingPass pass{100.0};
  const SpinOutput chosen = pass.run_with(ChooseRoot{pass.true_axis_icrf});
  const SpinOutput refused = pass.run_with(ChooseRoot{pass.wrong_icrf()});
  int ok = 0;
  for (const SpinOutput* const output : {&chosen, &refused}) {
    for (const SpinEstimate& estimate : all_of<SpinEstimate>(*output)) {
      if (is_unopposed(estimate.assessment.quality)) {
        EXPECT_LT(error_rad(pass, estimate), 3.0 * sigma_rad(estimate));
        ++ok;
      }
    }
  }
  EXPECT_GT(ok, 35);
  EXPECT_FALSE(testing::has(chosen.notices, NoticeCode::RootFarFromAll));
  EXPECT_TRUE(testing::has(chosen.notices, NoticeCode::RootChosen));
  EXPECT_TRUE(testing::has(refused.notices, NoticeCode::RootFarFromAll));
  EXPECT_FALSE(testing::has(refused.notices, NoticeCode::RootChosen));
}

TEST(SpinPass, ARootFarFromAllCandidatesIsNotTakenAndTheNearestIsNamed) {
  RecordedPass pass = recorded_pass("north-only");
  std::erase_if(pass.pulses,
                [](const Pulse& pulse) { return pulse.channel == PulseChannel::Sun2; });
  SpinPass spin{pass.config, pass.orbit};
  const TaiTime acted = shifted(pass.pulses.front().t, 60.0);
  const Eigen::Vector3d elsewhere_icrf =
      Eigen::AngleAxisd{1.0, pass.true_axis_icrf.unitOrthogonal()} * pass.true_axis_icrf;
  spin.act(acted, ChooseRoot{elsewhere_icrf});
  const SpinOutput output = run(std::move(spin), pass.pulses);
  const auto said = std::ranges::find(output.notices, NoticeCode::RootFarFromAll, &Notice::code);
  ASSERT_NE(said, output.notices.end());
  EXPECT_EQ(said->values.back().name, "deg");
  EXPECT_GT(std::get<double>(said->values.back().value), 5.0);
}

/// Expects doubt about the orbit in estimates from `from` on.
void expect_doubts_of_orbit(const SpinOutput& output, TaiTime from) {
  for (const SpinEstimate& estimate : all_of<SpinEstimate>(output)) {
    const bool both_sides = estimate.t > from;
    EXPECT_EQ(has(estimate.assessment, ReasonCode::OrbitSteps), both_sides);
    EXPECT_FALSE(both_sides && is_unopposed(estimate.assessment.quality));
  }
}

TEST(SpinPass, DoubtsWhatRestsOnBothSidesOfAStepOfTheOrbit) {
  const Eigen::Vector3d none = Eigen::Vector3d::Zero();
  const Eigen::Vector3d off{0.0, 0.0, 1.0};
  RecordedPass pass = recorded_pass("nominal");
  const OemSegment segment = of_few_points(pass.orbit.ephemeris()->segments().front());
  const TaiTime begins = pass.pulses.front().t;
  for (const auto& [position_km, velocity_km_s] :
       {std::pair<Eigen::Vector3d, Eigen::Vector3d>{none, 0.12 * off}, {20.0 * off, none}}) {
    const OrbitEphemeris orbit =
        stepped(segment, shifted(begins, 240.0), position_km, velocity_km_s);
    pass.orbit = Orbit{orbit};
    const SpinOutput output = run(pass);
    ASSERT_TRUE(testing::has(output.notices, NoticeCode::OrbitStepsInPass));
    expect_doubts_of_orbit(output, orbit.segments()[1].usable_from);
  }
  // The orbit continues smoothly, or its step lies outside the pass.
  for (const double after_s : {240.0, -100.0}) {
    pass.orbit =
        Orbit{stepped(segment, shifted(begins, after_s), after_s > 0.0 ? none : off, none)};
    const SpinOutput output = run(pass);
    EXPECT_FALSE(testing::has(output.notices, NoticeCode::OrbitStepsInPass));
    expect_doubts_of_orbit(output, TaiTime::max());
  }
}

TEST(SpinPass, AMarkedManoeuvreLeavesTheStepOfTheOrbitBehind) {
  RecordedPass pass = recorded_pass("nominal");
  const TaiTime burn = shifted(pass.pulses.front().t, 240.0);
  const OrbitEphemeris orbit = stepped(pass.orbit.ephemeris()->segments().front(), burn,
                                       Eigen::Vector3d::Zero(), Eigen::Vector3d{0.0, 0.0, 0.02});
  SpinPass spin{pass.config, Orbit{orbit}};
  spin.act(orbit.segments()[1].usable_from, MarkManoeuvre{});
  const SpinEstimate estimate = sequential_of(run(std::move(spin), pass.pulses));
  EXPECT_FALSE(has(estimate.assessment, ReasonCode::OrbitSteps));
}

TEST(SpinPass, EndsAlsoWhereNoFixFollowsAMarkedManoeuvre) {
  const RecordedPass pass = recorded_pass("nominal");
  const TaiTime burn = shifted(pass.pulses.front().t, 200.0);
  SpinPass spin{pass.config, pass.orbit};
  for (const PulseChannel channel : {PulseChannel::Sun1, PulseChannel::Sun2}) {
    spin.act(burn, ExcludeChannel<PulseChannel>{channel});
  }
  spin.act(burn, MarkManoeuvre{});
  EXPECT_LE(sequential_of(run(std::move(spin), pass.pulses)).t, burn);
}

/// 60 rpm with times truncated to a millisecond: each channel has a constant error during the pass.
TEST(SpinPass, TimesOnAGridAreSaidAndInTheSigmaOfEveryEstimate) {
  const RecordedPass pass = recorded_pass("../faults/times-in-ms");
  const SpinOutput output = run(pass);
  const auto said = std::ranges::find(output.notices, NoticeCode::TimesOnGrid, &Notice::code);
  ASSERT_NE(said, output.notices.end());
  EXPECT_EQ(said->values[1], (NamedValue{"grid_s", 1e-3}));
  int ok = 0;
  for (const SpinEstimate& estimate : all_of<SpinEstimate>(output)) {
    if (estimate.assessment.quality == Quality::Ok) {
      ++ok;
      EXPECT_LT(error_rad(pass, estimate), 4.0 * sigma_rad(estimate));
    }
  }
  EXPECT_GT(ok, 1000);
  EXPECT_FALSE(testing::has(run(recorded_pass("nominal")).notices, NoticeCode::TimesOnGrid));
}

TEST(SpinPass, AnEmptyPassGivesNothing) {
  const RecordedPass pass = recorded_pass("nominal");
  const SpinOutput output = run(SpinPass{pass.config, pass.orbit}, std::vector<Pulse>{});
  EXPECT_TRUE(output.products.empty());
  EXPECT_TRUE(output.notices.empty());
}

TEST(SpinPass, APassOfFiveRevolutionsGivesAnAxisWhenItEnds) {
  RecordedPass pass = recorded_pass("nominal");
  pass.pulses.resize(30);
  const SpinOutput output = run(pass);
  EXPECT_EQ(all_of<SpinFix>(output).size(), 5U);
  const SpinEstimate mean = mean_of(output);
  EXPECT_LT(error_rad(pass, mean), 3.0 * sigma_rad(mean));
}

TEST(SpinPass, TheAxisStandsWhileThePassRuns) {
  const RecordedPass pass = recorded_pass("nominal");
  SpinPass spin{pass.config, pass.orbit};
  std::size_t estimates = 0;
  for (std::size_t i = 0; i < 180; ++i) {
    estimates += all_of<SpinEstimate>(spin.push(pass.pulses[i])).size();
  }
  // The last two of thirty revolutions, with six pulses a second, are still open.
  EXPECT_GE(estimates, 27U);
}

}  // namespace spindrift::testing::spin_pass_test
