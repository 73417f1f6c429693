/// Association of realistic passes: lost, doubled and displaced edges, dead sensors, silences, and
/// a moving Earth.

#include <Eigen/Geometry>
#include <algorithm>
#include <cmath>
#include <functional>
#include <limits>
#include <numbers>
#include <optional>
#include <random>
#include <set>
#include <vector>

#include "pipelines/ephemeris/kepler_orbit.h"
#include "pipelines/spin/association/association.h"
#include "tests/support/edge_train.h"
#include "tests/support/matchers.h"
#include "tests/support/pulse_trains.h"
#include "tests/support/recorded_pass.h"
#include "tests/support/spinning_body.h"
#include "tests/unit/spin/association/dirty_train.h"

namespace spindrift::testing::association_dirt_test {

using enum PulseChannel;

TEST(AssociationDirt, RejectsTheBadEdgesOfADirtyPassAndKeepsTheGood) {
  const RecordedPass pass = recorded_pass("dirty");
  const std::set<Pulse>& bad = pass.bad_edges;
  const Association all = associate(pass.pulses, pass.config);
  const auto good = good_edges(all);
  int bad_rejected = 0;
  int good_rejected = 0;
  for (const Pulse& pulse : pass.pulses) {
    if (!good.contains(pulse)) {
      ++(bad.contains(pulse) ? bad_rejected : good_rejected);
    }
  }
  ASSERT_EQ(bad.size(), 333U);
  EXPECT_GE(bad_rejected, 0.97 * 333);
  EXPECT_LE(good_rejected, 0.01 * static_cast<double>(pass.pulses.size() - bad.size()));
}

TEST(AssociationDirt, FindsThePeriodUnderHeavyDirt) {
  std::mt19937_64 rng{301};
  for (const double rpm : {5.0, 11.0, 33.3, 60.0, 100.0, 147.0, 200.0}) {
    for (int trial = 0; trial < 30; ++trial) {
      SCOPED_TRACE(::testing::Message() << rpm << " rpm, trial " << trial);
      const Pass pass = made({.period_s = 60.0 / rpm,
                              .turns = 60,
                              .dirt = {.lost = 0.2, .spurious = 0.1, .spoilt = 0.1}},
                             rng);
      const Association all = associate(pass.pulses);
      ASSERT_FALSE(all.closed.empty());
      ASSERT_NEAR(all.closed.front().period.period_s * rpm / 60.0, 1.0, 1e-3);
      ASSERT_NEAR(all.closed.back().period.period_s * rpm / 60.0, 1.0, 1e-3);
      // The first turns are lost because the count begins at an existing sun1, plus 1 %.
      expect_counted(pass, all, 0.06);
    }
  }
}

TEST(AssociationDirt, JudgesTheFirstEdgesAsWellAsLaterOnes) {
  std::mt19937_64 rng{302};
  int bad = 0;
  int bad_accepted = 0;
  int good = 0;
  int good_rejected = 0;
  for (int trial = 0; trial < 100; ++trial) {
    const Pass pass = made({.turns = 12, .dirt = {.lost = 0.03, .spoilt = 0.08}}, rng);
    const auto found = good_edges(associate(pass.pulses));
    for (const Pulse& pulse : pass.pulses) {
      if (pass.turns.contains(pulse)) {
        ++good;
        good_rejected += found.contains(pulse) ? 0 : 1;
      } else {
        ++bad;
        bad_accepted += found.contains(pulse) ? 1 : 0;
      }
    }
  }
  EXPECT_LE(bad_accepted, 0.03 * bad);
  // The edges before the first existing sun1 cannot be counted: 8 % of the first turns.
  EXPECT_LE(good_rejected, 0.02 * good);
}

/// Expects the edges of the first receiver to be used and those of the second to be left out as
/// copies.
void expect_first_of_copies_used(const Pass& first, const Association& all) {
  for (const PulseUse& use : all.left_over) {
    ASSERT_FALSE(first.turns.contains(use.pulse)) << name_of(use.pulse.channel);
    ASSERT_EQ(use.rejected_by, Rejection::Copy);
  }
  EXPECT_EQ(all.copies.size(), all.left_over.size());
  EXPECT_FALSE(all.closed.empty());
}

TEST(AssociationDirt, OfCopiesTheEarliestCounts) {
  std::mt19937_64 rng{310};
  for (const double behind_s : {1e-9, 1e-3, 0.005, 0.02}) {
    for (const double rpm : {40.0, 60.0, 100.0}) {
      SCOPED_TRACE(::testing::Message() << behind_s << " s at " << rpm << " rpm");
      const Pass pass = made({.period_s = 60.0 / rpm, .turns = 60}, rng);
      const Association all = associate(copied(pass.pulses, {.behind_s = behind_s}, rng));
      expect_first_of_copies_used(pass, all);
      EXPECT_EQ(all.copies.size(), pass.pulses.size());
      for (const CopiedEdge& copy : all.copies) {
        ASSERT_NEAR(copy.apart_s, behind_s, 2e-9);
      }
    }
  }
}

TEST(AssociationDirt, ACopyOfOneChannelLeavesTheOthers) {
  std::mt19937_64 rng{311};
  for (const PulseChannel channel : kEveryChannel) {
    SCOPED_TRACE(name_of(channel));
    const Pass pass = made({.turns = 60}, rng);
    expect_first_of_copies_used(
        pass, associate(copied(pass.pulses, {.behind_s = 0.005, .channels = {channel}}, rng)));
  }
}

/// Limit well above the 0.27 % of good edges that three sigma reject.
constexpr double kOneInAHundred = 0.01;

/// The channels must stay with the edges received so far, not with those earlier than expected.
TEST(AssociationDirt, CopiesThatBeginMidwayMoveNoChannel) {
  std::mt19937_64 rng{312};
  for (const double behind_s : {-0.005, 0.005}) {
    SCOPED_TRACE(behind_s);
    const Pass pass = made({.turns = 60}, rng);
    const Association all =
        associate(copied(pass.pulses, {.behind_s = behind_s, .from_share = 0.5}, rng));
    expect_counted(pass, all, kOneInAHundred);
    // Thirty turns have copies; the first few of them are not yet recognised.
    EXPECT_GE(all.copies.size(), 25U * kPulseChannels);
  }
}

/// The first receiver's channel begins late, when it is already tracked on the second's edges.
TEST(AssociationDirt, AllChannelsAreOfTheSameReceiverInTheEnd) {
  std::mt19937_64 rng{315};
  for (const PulseChannel channel : kEveryChannel) {
    SCOPED_TRACE(name_of(channel));
    const Pass pass = made({.turns = 80}, rng);
    std::vector<Pulse> pulses = copied(pass.pulses, {.behind_s = 0.005}, rng);
    std::erase_if(pulses, [&](const Pulse& pulse) {
      const auto turn = pass.turns.find(pulse);
      return pulse.channel == channel && turn != pass.turns.end() && turn->second < 12;
    });
    const auto good = good_edges(associate(pulses));
    int of_first = 0;
    for (const auto& [pulse, turn] : pass.turns) {
      of_first += turn >= 40 && good.contains(pulse) ? 1 : 0;
    }
    // Three sigma reject 0.27 %.
    EXPECT_GE(of_first, 0.98 * 40 * kPulseChannels);
  }
}

TEST(AssociationDirt, AChannelThatHasHalfOfItsEdgesOrTwiceAsManyMovesNoPeriod) {
  std::mt19937_64 rng{313};
  for (const double rpm : {5.0, 60.0, 200.0}) {
    for (const PulseChannel channel : {Sun1, Sun2}) {
      SCOPED_TRACE(::testing::Message() << name_of(channel) << " at " << rpm << " rpm");
      const double period_s = 60.0 / rpm;
      const Pass pass = made({.period_s = period_s, .turns = 100}, rng);
      const Pass half{.pulses = halved(pass.pulses, channel), .turns = pass.turns};
      const auto expect_period = [&](const Pass& good, const std::vector<Pulse>& pulses) {
        const Association all = associate(pulses);
        ASSERT_FALSE(all.closed.empty());
        EXPECT_NEAR(all.closed.back().period.period_s, period_s, 1e-4 * period_s);
        expect_counted(good, all, kOneInAHundred);
      };
      expect_period(half, half.pulses);
      for (const double from_share : {0.0, 0.5}) {
        expect_period(pass, copied(pass.pulses,
                                   {.behind_s = 0.5 * period_s,
                                    .jitter_s = 1e-4,
                                    .channels = {channel},
                                    .from_share = from_share},
                                   rng));
      }
    }
  }
}

/// Without sun2 nothing shows which of the two sun1 is real.
TEST(AssociationDirt, OfTwoSun1HalfATurnApartWithoutSun2NoneIsUsed) {
  std::mt19937_64 rng{314};
  Pass pass = made({.turns = 100}, rng);
  std::erase_if(pass.pulses, [](const Pulse& pulse) { return pulse.channel == Sun2; });
  const auto good = good_edges(
      associate(copied(pass.pulses, {.behind_s = 0.5, .jitter_s = 1e-4, .channels = {Sun1}}, rng)));
  EXPECT_GT(good.size(), 350U);
  for (const auto& [pulse, turn] : good) {
    EXPECT_NE(pulse.channel, Sun1) << turn;
  }
}

TEST(AssociationDirt, ASpoiltSun1IsRejectedAloneAndKeptWithItsRevolution) {
  std::mt19937_64 rng{304};
  const Pass pass = made({.turns = 60}, rng);
  std::vector<Pulse> pulses = pass.pulses;
  TaiTime spoilt_t;
  for (Pulse& pulse : pulses) {
    if (pulse.channel == Sun1 && pass.turns.at(pulse) == 40) {
      pulse.t = spoilt_t = shifted(pulse.t, 0.005);
    }
  }
  const Association all = associate(pulses);
  ASSERT_EQ(all.closed.size(), 60U);
  const Revolution& spoilt = all.closed.at(40);
  EXPECT_EQ(spoilt.edge(Sun1), spoilt_t);
  EXPECT_EQ(spoilt.edge_rejections.at(index_of(Sun1)), Rejection::Phase);
  const Observation& place = spoilt.edge_places.at(index_of(Sun1)).value();
  EXPECT_EQ(place.t, spoilt_t);
  EXPECT_NEAR(place.residual.value[0], 0.005, 5e-4);
  EXPECT_EQ(place.rejected_by, Rejection::Phase);
  EXPECT_GT(place.nis, place.limit);
  EXPECT_EQ(spoilt.period_candidate.value().rejected_by, Rejection::Phase);
  // The start of the revolution is the clock's expectation, within five sigmas of the edge.
  EXPECT_NEAR(seconds_between(kStart, spoilt.t_start), 40.0, 5e-4);
  for (const std::size_t next : {39U, 41U}) {
    EXPECT_TRUE(all.closed.at(next).good_edge(Sun1));
    EXPECT_FALSE(all.closed.at(next).period_candidate->rejected_by);
    EXPECT_EQ(all.closed.at(next).t_start, *all.closed.at(next).edge(Sun1));
  }
}

TEST(AssociationDirt, FollowsTheEarthFromALowOrbitAtAnyRate) {
  const Orbit orbit{KeplerOrbit::make({.epoch = kStart,
                                       .semi_major_axis_km = 6878.0,
                                       .eccentricity = 0.001,
                                       .inclination_rad = 0.9,
                                       .raan_rad = 0.5,
                                       .argument_of_perigee_rad = 3.0,
                                       .mean_anomaly_rad = 0.35})
                        .value()};
  const auto position_km = [&](double t_s) {
    return Eigen::Vector3d{orbit.at(shifted(kStart, t_s)).value().position_icrf_km};
  };
  SunEarthEphemeris around = at_rest({1.0, 0.2, 0.1}, {});
  around.earth_icrf_km = [&](double t_s) -> Eigen::Vector3d { return -position_km(t_s); };
  std::mt19937_64 rng{305};
  for (const double rpm : {5.0, 20.0, 60.0, 200.0}) {
    SCOPED_TRACE(rpm);
    const SpinningBody body{.axis_icrf = position_km(0.0).cross(position_km(600.0)).normalized(),
                            .rate_rad_s = rpm * 2.0 * std::numbers::pi / 60.0,
                            .first_turn_rad = 1.0,
                            .config = usual_config()};
    const std::vector<Pulse> pulses = pulses_from(
        edges_between(body, around, 0.0, 60.0 / rpm * 150.0), kStart, body.config.noise, rng);
    const auto good = good_edges(associate(pulses));
    // Three sigma reject 0.27 % of 900 edges; the turn before the first sun1 is lost too.
    EXPECT_GE(good.size() + 20, pulses.size());
  }
}

TEST(AssociationDirt, RunsOnAnotherChannelWhereSun1IsDead) {
  std::mt19937_64 rng{306};
  for (const double rpm : {5.0, 60.0, 200.0}) {
    for (const bool sun2_too : {false, true}) {
      SCOPED_TRACE(::testing::Message() << rpm << " rpm, sun2 dead " << sun2_too);
      const double earth_drift = 5e-4 / (rpm * 2.0 * std::numbers::pi / 60.0);
      const Pass pass = without(
          made({.period_s = 60.0 / rpm,
                .turns = 150,
                .earth_drift = earth_drift,
                .dirt = {.lost = 0.05, .spurious = 0.03, .spoilt = 0.05}},
               rng),
          [&](const Pulse& p) { return p.channel == Sun1 || (sun2_too && p.channel == Sun2); });
      const Association all = associate(pass.pulses);
      expect_counted(pass, all, 0.03);
      EXPECT_LT(all.closed.back().period.sigma_s * rpm / 60.0, sun2_too ? 2e-3 : 1e-4);
      for (const Revolution& revolution : all.closed) {
        ASSERT_FALSE(revolution.edge(Sun1));
        ASSERT_NEAR(revolution.period.period_s, 60.0 / rpm, 4.0 * revolution.period.sigma_s);
        if (const auto sun2 = revolution.good_edge(Sun2); sun2 && revolution.number > 30) {
          ASSERT_EQ(revolution.t_start, *sun2);
        }
      }
    }
  }
}

TEST(AssociationDirt, CountsRightWhereEdgesAreDoubledAndSpoiltByLittle) {
  std::mt19937_64 rng{309};
  for (const double rpm : {6.0, 17.0, 60.0}) {
    for (int trial = 0; trial < 12; ++trial) {
      SCOPED_TRACE(::testing::Message() << rpm << " rpm, trial " << trial);
      const Pass pass = made({.period_s = 60.0 / rpm,
                              .turns = static_cast<int>(30.0 * rpm),
                              .dirt = {.lost = 0.05,
                                       .spurious = 0.1,
                                       .spoilt = 0.12,
                                       .most_off_turns = 0.005,
                                       .doubled = 0.08}},
                             rng);
      expect_counted(pass, associate(pass.pulses), 0.05);
    }
  }
}

/// Describes passes without some of their edges.
struct Deaf {
  const char* name;
  unsigned seed;
  Train train;
  std::function<bool(const Pulse&)> lost;
  double most_rejected;  ///< Share of the good edges that may be rejected.
};

class ABeamThatRunsTheClock : public ::testing::TestWithParam<Deaf> {};

TEST_P(ABeamThatRunsTheClock, CountsRight) {
  std::mt19937_64 rng{GetParam().seed};
  for (int trial = 0; trial < 20; ++trial) {
    SCOPED_TRACE(trial);
    const Pass pass = without(made(GetParam().train, rng), GetParam().lost);
    expect_counted(pass, associate(pass.pulses), GetParam().most_rejected);
  }
}

const std::vector<Deaf> kDeaf = {
    {"InALowOrbitWhileTheRateDrifts",
     310,
     {.period_s = 5.5,
      .turns = 150,
      .earth_drift = 1e-3,
      .period_drift = -2.7e-4,
      .dirt = {.lost = 0.25}},
     [](const Pulse& p) { return sees_the_sun(p.channel); },
     0.03},
    // The slits need some turns to be learnt, the beams one or two after sun1 counts.
    {"AndHandsItToASun1ThatAppears",
     312,
     {.period_s = 7.2,
      .turns = 100,
      .earth_drift = 1.5e-3,
      .earth_bend = 1e-5,
      .period_drift = -3e-4,
      .dirt = {.spoilt = 0.1, .most_off_turns = 0.005}},
     [](const Pulse& p) { return sees_the_sun(p.channel) && seconds_in(p) < 112.0; },
     0.06},
    {"AndTookItOverBeforeTheRateSteps",
     311,
     {.period_s = 5.5, .turns = 250, .earth_drift = 1e-3, .step_turn = 150, .step = 0.98},
     [](const Pulse& p) {
       return p.channel != NorthOut && (p.channel != NorthIn || seconds_in(p) > 400.0);
     },
     0.05}};

INSTANTIATE_TEST_SUITE_P(AssociationDirt, ABeamThatRunsTheClock, ::testing::ValuesIn(kDeaf),
                         [](const auto& deaf) { return deaf.param.name; });

TEST(AssociationDirt, ChangesOverToASun1ThatAppearsAndBackWhenItDies) {
  std::mt19937_64 rng{307};
  for (const bool sun2_too : {false, true}) {
    SCOPED_TRACE(sun2_too);
    const Pass pass =
        without(made({.turns = 400, .earth_drift = 5e-5, .dirt = {.lost = 0.03}}, rng),
                [&](const Pulse& p) {
                  const bool dead = seconds_in(p) < 99.5 || seconds_in(p) > 249.5;
                  return dead && (p.channel == Sun1 || (sun2_too && p.channel == Sun2));
                });
    const Association all = associate(pass.pulses);
    const Mistakes counted = mistakes(pass, all);
    // Before the first sun1 it is unknown after which sun1 a chord is to be counted.
    EXPECT_LE(counted.rejected, 0.01 * counted.good);
    int sun1_edges = 0;
    for (std::size_t i = 1; i < all.closed.size(); ++i) {
      ASSERT_EQ(all.closed[i].number, all.closed[i - 1].number + 1);
      sun1_edges += all.closed[i].good_edge(Sun1) ? 1 : 0;
    }
    EXPECT_GE(sun1_edges, 0.95 * 150);
    ASSERT_NEAR(all.closed.back().period.period_s, 1.0, 4.0 * all.closed.back().period.sigma_s);
    // During the 150 turns without sun1, t_start is its expected time except for the Earth's
    // motion.
    EXPECT_NEAR(seconds_between(kStart, all.closed.back().t_start), 399.0, 0.01);
  }
}

TEST(AssociationDirt, CountsRightThroughSilencesOfTenMinutes) {
  std::mt19937_64 rng{308};
  for (const double rpm : {5.0, 60.0, 200.0}) {
    for (const int before : {15, 100}) {
      for (const double drift : {0.0, -1e-7, 1e-7}) {
        for (int trial = 0; trial < 10; ++trial) {
          SCOPED_TRACE(::testing::Message() << rpm << " rpm, " << before << " turns before, drift "
                                            << drift << ", trial " << trial);
          const double period_s = 60.0 / rpm;
          const int silent = static_cast<int>(600.0 / period_s);
          const double from_s = (before - 0.1) * period_s;
          const Pass pass =
              without(made({.period_s = period_s,
                            .turns = before + silent + 60,
                            .period_drift = drift,
                            .dirt = {.lost = 0.02, .spoilt = 0.02}},
                           rng),
                      [&](const Pulse& p) {
                        return seconds_in(p) > from_s && seconds_in(p) < from_s + silent * period_s;
                      });
          expect_counted(pass, associate(pass.pulses), 0.1);
        }
      }
    }
  }
}

/// Expects each edge in a revolution or left over.
void expect_all_accounted_for(const Association& all, const std::vector<Pulse>& pulses) {
  std::size_t edges = all.left_over.size();
  for (const Revolution& revolution : all.closed) {
    edges += kPulseChannels - static_cast<std::size_t>(
                                  std::ranges::count(revolution.edges, std::optional<TaiTime>{}));
  }
  EXPECT_EQ(edges, pulses.size());
}

TEST(AssociationDirt, NoTimeIsTooAbsurd) {
  constexpr std::int64_t kLeast = std::numeric_limits<std::int64_t>::min();
  constexpr std::int64_t kMost = std::numeric_limits<std::int64_t>::max();
  std::mt19937_64 rng{309};
  const Pass pass = made({.turns = 40}, rng);
  for (const bool clock_runs : {false, true}) {
    std::vector<Pulse> pulses = clock_runs ? pass.pulses : std::vector<Pulse>{};
    for (std::size_t i = 0; i < 200; ++i) {
      const auto channel = static_cast<PulseChannel>(i % kPulseChannels);
      const auto step = static_cast<std::int64_t>(i);
      pulses.push_back({.t = tai_from_ns(kLeast + step * 1'000'000'000), .channel = channel});
      pulses.push_back({.t = tai_from_ns(kMost - step * 700'000'000), .channel = channel});
      pulses.push_back({.t = tai_from_ns(0), .channel = channel});
      pulses.push_back({.t = tai_from_ns(step * 40'000'000'000'000'000), .channel = channel});
    }
    const Association all = associate(pulses);
    for (const Revolution& revolution : all.closed) {
      ASSERT_TRUE(std::isfinite(revolution.period.period_s) && revolution.period.period_s > 0.0);
    }
    expect_all_accounted_for(all, pulses);
  }
}

/// The stated noise of an edge may exceed a turn; then no turn can be counted.
TEST(Association, EveryEdgeIsAccountedForHoweverNoisyItIsSaidToBe) {
  for (const double rpm : {5.0, 60.0, 200.0}) {
    for (const double noise_s : {1e-9, 1e-3, 1e-2, 3e-2, 0.1}) {
      SCOPED_TRACE(::testing::Message() << rpm << " rpm, " << noise_s << " s");
      SpinConfig config = usual_config();
      config.noise.sun_s = noise_s;
      std::mt19937_64 rng{61};
      std::normal_distribution<double> jitter_s{0.0, 1e-4};
      std::vector<Pulse> pulses;
      for (int turn = 0; turn < 300; ++turn) {
        for (const auto& [channel, phase] : {std::pair{Sun1, 0.0}, std::pair{NorthIn, 0.4}}) {
          const double t_s = (turn + phase) * 60.0 / rpm + jitter_s(rng);
          pulses.push_back({.t = shifted(kStart, t_s), .channel = channel});
        }
      }
      expect_all_accounted_for(associate(pulses, config), pulses);
    }
  }
}

}  // namespace spindrift::testing::association_dirt_test
