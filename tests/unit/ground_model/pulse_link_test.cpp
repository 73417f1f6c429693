#include "pipelines/ground_model/link/pulse_link.h"

#include <algorithm>
#include <cmath>

#include "tests/support/matchers.h"

namespace spindrift::pulse_link_test {

using enum PulseChannel;

constexpr TaiTime kStart = tai_from_ns(1795143637000000000);
constexpr int kTurns = 20000;

/// Returns one edge a second for each channel, a tenth of a second apart.
std::vector<TrueEdge> regular_edges() {
  std::vector<TrueEdge> edges;
  for (int turn = 0; turn < kTurns; ++turn) {
    for (std::size_t channel = 0; channel < kPulseChannels; ++channel) {
      edges.push_back({.t_s = turn + 0.1 * static_cast<double>(channel),
                       .channel = static_cast<PulseChannel>(channel)});
    }
  }
  return edges;
}

PulseLink silent_link() {
  return {.seed = 1, .noise = {.sun_s = 0.0, .infrared_s = 0.0}, .channels = {}, .silences = {}};
}

ReceivedPass received(const PulseLink& link) {
  return receive(link, regular_edges(), kStart, kTurns, kTurns);
}

std::int64_t count(const ReceivedPass& pass, std::optional<Damage> damage) {
  return std::ranges::count_if(pass.pulses,
                               [&](const ReceivedPulse& pulse) { return pulse.damage == damage; });
}

/// Expects a binomial count within five standard deviations, which fails by chance once in two
/// million times.
void expect_binomial(std::int64_t count, double trials, double probability) {
  EXPECT_NEAR(static_cast<double>(count), trials * probability,
              5.0 * std::sqrt(trials * probability * (1.0 - probability)));
}

/// Returns the delay against the regular time of the channel.
double late_s(const Pulse& pulse) {
  const double t_s =
      seconds_between(kStart, pulse.t) - 0.1 * static_cast<double>(index_of(pulse.channel));
  return t_s - std::round(t_s);
}

TEST(PulseLink, WithoutNoiseOrFaultsGivesTheEdgesToTheNanosecond) {
  const auto edges = regular_edges();
  const ReceivedPass pass = received(silent_link());
  ASSERT_EQ(pass.pulses.size(), edges.size());
  EXPECT_EQ(pass.missing, 0);
  for (std::size_t i = 0; i < edges.size(); ++i) {
    ASSERT_EQ(pass.pulses[i].pulse, (Pulse{shifted(kStart, edges[i].t_s), edges[i].channel}));
    ASSERT_FALSE(pass.pulses[i].damage);
  }
}

TEST(PulseLink, AddsNoiseOfTheGivenSigma) {
  PulseLink link = silent_link();
  link.noise = {.sun_s = 1e-4, .infrared_s = 5e-4};
  double sun = 0.0;
  double infrared = 0.0;
  for (const auto& [pulse, damage] : received(link).pulses) {
    const bool is_sun = pulse.channel == Sun1 || pulse.channel == Sun2;
    (is_sun ? sun : infrared) += std::pow(late_s(pulse) / (is_sun ? 1e-4 : 5e-4), 2);
  }
  // Five sigma of chi-square over its degrees of freedom.
  EXPECT_NEAR(sun / (2.0 * kTurns), 1.0, 5.0 * std::sqrt(2.0 / (2.0 * kTurns)));
  EXPECT_NEAR(infrared / (4.0 * kTurns), 1.0, 5.0 * std::sqrt(2.0 / (4.0 * kTurns)));
}

TEST(PulseLink, LosesSpoilsDoublesAndAddsAsOftenAsAsked) {
  PulseLink link = silent_link();
  link.channels.fill({.lost = 0.05, .spoilt = 0.04, .doubled = 0.03, .spurious = 0.02});
  link.spoilt_min_s = 0.002;
  link.spoilt_max_s = 0.02;
  link.doubled_max_s = 0.001;
  const ReceivedPass pass = received(link);
  const double edges = 6.0 * kTurns;
  expect_binomial(pass.missing, edges, 0.05);
  expect_binomial(count(pass, Damage::Spoilt), edges, 0.95 * 0.04);
  expect_binomial(count(pass, Damage::Doubled), edges, 0.95 * 0.03);
  expect_binomial(count(pass, Damage::Spurious), edges, 0.02);
  EXPECT_EQ(count(pass, std::nullopt) + count(pass, Damage::Spoilt) + pass.missing, 6 * kTurns);
  EXPECT_TRUE(std::ranges::is_sorted(
      pass.pulses, [](const auto& a, const auto& b) { return a.pulse < b.pulse; }));
  for (const auto& [pulse, damage] : pass.pulses) {
    if (damage == Damage::Spoilt) {
      ASSERT_GE(std::abs(late_s(pulse)), 0.002 - 1e-9);
      ASSERT_LE(std::abs(late_s(pulse)), 0.02 + 1e-9);
    }
  }
}

TEST(PulseLink, HearsNothingOfADeadChannelNorDuringASilence) {
  PulseLink link = silent_link();
  link.channels.fill({.spurious = 0.5});
  link.channels.at(index_of(NorthIn)).dead = true;
  link.silences = {{.from_s = 100.0, .to_s = 200.0}, {.from_s = 150.0, .to_s = 400.05}};
  const ReceivedPass pass = received(link);
  for (const auto& [pulse, damage] : pass.pulses) {
    const double t_s = seconds_between(kStart, pulse.t);
    ASSERT_NE(name_of(pulse.channel), "north_in");
    ASSERT_FALSE(t_s >= 100.0 && t_s < 400.05) << t_s;
  }
  // Five channels lack 300 s, sun1 also second 400, and the sixth channel is missing entirely.
  EXPECT_EQ(pass.missing, 1501 + kTurns);
}

TEST(PulseLink, KeepsApartWhatASilenceSwallows) {
  PulseLink link = silent_link();
  const auto all = received(link).pulses;
  link.silences = {{.from_s = 100.0, .to_s = 200.0}, {.from_s = 150.0, .to_s = 400.05}};
  const ReceivedPass pass = received(link);
  ASSERT_EQ(pass.silenced.size(), 6U * 300U + 1U);
  ASSERT_EQ(pass.pulses.size() + pass.silenced.size(), all.size());
  for (std::size_t i = 0; i < pass.silenced.size(); ++i) {
    ASSERT_EQ(pass.silenced[i], all[6U * 100U + i].pulse);
  }
}

TEST(PulseLink, SpoilsNeighboursOfDifferentChannelsOnly) {
  PulseLink link = silent_link();
  link.interference_s = 0.002;
  const std::vector<TrueEdge> edges = {
      {.t_s = 1.0, .channel = Sun1}, {.t_s = 1.001, .channel = NorthIn},
      {.t_s = 2.0, .channel = Sun1}, {.t_s = 2.001, .channel = Sun1},
      {.t_s = 3.0, .channel = Sun1}, {.t_s = 3.0021, .channel = NorthIn}};
  const ReceivedPass pass = receive(link, edges, kStart, 4.0, 3);
  ASSERT_EQ(pass.pulses.size(), 6U);
  for (const auto& [pulse, damage] : pass.pulses) {
    const double t_s = seconds_between(kStart, pulse.t);
    EXPECT_EQ(damage, t_s < 1.5 ? std::optional{Damage::Interference} : std::nullopt) << t_s;
    if (damage) {
      const double true_s = pulse.channel == Sun1 ? 1.0 : 1.001;
      EXPECT_LE(std::abs(t_s - true_s), 0.001);
      EXPECT_NE(t_s, true_s);
    }
  }
}

TEST(PulseLink, GivesTheSamePassForTheSameSeedAndAnotherForAnother) {
  PulseLink link = silent_link();
  link.noise = {.sun_s = 1e-4, .infrared_s = 5e-4};
  const auto same = [](const ReceivedPulse& a, const ReceivedPulse& b) {
    return a.pulse == b.pulse && a.damage == b.damage;
  };
  const auto first = received(link).pulses;
  const auto again = received(link).pulses;
  EXPECT_TRUE(std::equal(first.begin(), first.end(), again.begin(), again.end(), same));
  link.seed = 2;
  const auto other = received(link).pulses;
  EXPECT_FALSE(std::equal(first.begin(), first.end(), other.begin(), other.end(), same));
}

TEST(PulseLink, LeavesOneEdgesChancesAloneWhenAnotherFaultChanges) {
  PulseLink link = silent_link();
  link.noise = {.sun_s = 1e-4, .infrared_s = 5e-4};
  const auto whole = received(link).pulses;
  link.channels.at(index_of(Sun2)).lost = 1.0;
  const auto thinned = received(link).pulses;
  std::vector<Pulse> expected;
  for (const ReceivedPulse& received_pulse : whole) {
    if (received_pulse.pulse.channel != Sun2) {
      expected.push_back(received_pulse.pulse);
    }
  }
  ASSERT_EQ(thinned.size(), expected.size());
  EXPECT_TRUE(std::equal(thinned.begin(), thinned.end(), expected.begin(),
                         [](const ReceivedPulse& a, const Pulse& b) { return a.pulse == b; }));
}

}  // namespace spindrift::pulse_link_test
