#include "pipelines/spin/association/clock_start.h"

#include <algorithm>
#include <array>
#include <cmath>
#include <numbers>
#include <vector>

#include "pipelines/frames/angle.h"
#include "pipelines/spin/association/expected_phases.h"
#include "pipelines/spin/association/period_search.h"
#include "pipelines/spin/types/spin_rate.h"
#include "pipelines/time/time_span.h"

namespace spindrift {
namespace {

using enum PulseChannel;

constexpr std::array<PulseChannel, kPulseChannels> kByPreference = {Sun1,     Sun2,    NorthIn,
                                                                    NorthOut, SouthIn, SouthOut};
// Fewest edges on a comb, or agreeing notes, before the clock starts.
constexpr std::size_t kFewestSun1 = 7;
constexpr std::size_t kFewestOthers = 20;
constexpr std::size_t kFewestAtEnd = 3;
constexpr std::size_t kNotesToAgree = 3;
// A bend of the comb is not seen where it leaves the edges less than about this many scatters from
// a straight line: its ends may then be off by as much, its slope by twice that along the whole.
constexpr double kHidden_scatters = 3.0;
constexpr double kSamePeriod = 0.01;
// A pass begins where kFewestOfRun edges follow within kOneRun_turns.
constexpr std::ptrdiff_t kFewestOfRun = 3;
constexpr double kOneRun_turns = 10.0;
// One sigma of a rate uniform between those of a low orbit in either sense.
constexpr double kUnknownEarthRate_rad_s = kEarthMotion_rad_s / std::numbers::sqrt3;

auto same_period_as(const PeriodNote& one) {
  return [one](const PeriodNote& note) {
    return std::abs(note.period_s - one.period_s) <= kSamePeriod * one.period_s;
  };
}

std::vector<TaiTime> times_of(std::span<const Pulse> pulses, PulseChannel channel) {
  std::vector<TaiTime> times;
  for (const Pulse& pulse : pulses) {
    if (pulse.channel == channel) {
      times.push_back(pulse.t);
    }
  }
  return times;
}

/// Returns the note of a single turn. A lost sun1 makes a period of several turns, so this is the
/// shortest period that two notes state and that divides the middle one.
PeriodNote note_of_one_turn(const std::vector<PeriodNote>& notes, const PeriodNote& middle) {
  PeriodNote shortest = middle;
  for (const PeriodNote& note : notes) {
    const double turns = std::round(middle.period_s / note.period_s);
    const bool divides = turns > 1.0 && std::abs(middle.period_s - turns * note.period_s) <=
                                            kSamePeriod * note.period_s;
    if (divides && note.period_s < shortest.period_s &&
        std::count_if(notes.begin(), notes.end(), same_period_as(note)) >= 2) {
      shortest = note;
    }
  }
  return shortest;
}

/// Tells whether two successive edges are one period apart. A train that lost edges seems to have a
/// period of several turns, but some of its edges may still be one turn apart.
bool have_interval(const std::vector<TaiTime>& edges, double period_s) {
  return std::adjacent_find(edges.begin(), edges.end(), [period_s](TaiTime a, TaiTime b) {
           // The motion of the Earth and noise change an interval by a smaller part of it.
           return std::abs(elapsed_s(a, b) - period_s) <= 0.02 * period_s;
         }) != edges.end();
}

/// Tells whether more channels agree on another period. All turn alike, so this channel then misses
/// every other edge, or has a second one half a turn later.
bool is_outvoted(const OtherChannels& others, double period_s) {
  std::vector<double> said_s = others.periods_s;
  said_s.push_back(period_s);
  const auto votes_for = [&](double one_s) {
    return std::count_if(said_s.begin(), said_s.end(),
                         [&](double other_s) { return !is_another_period(one_s, other_s); });
  };
  return std::any_of(said_s.begin(), said_s.end(),
                     [&](double one_s) { return votes_for(one_s) > votes_for(period_s); });
}

/// Returns the clock with the first edge near the comb on turn 0. A stray edge before it that lies
/// near the comb by chance is passed over, since few edges follow it.
SpinClock counted_from(SpinClock::Setting setting, const std::vector<TaiTime>& edges,
                       PulseChannel channel, double phase_turns) {
  const SpinClock clock{setting};
  std::vector<double> turns;
  for (const TaiTime t : edges) {
    const double count = clock.phase_turns(t) - phase_turns;
    const double turn = std::round(count);
    if (std::abs(count - turn) <= gate_turns(channel) && (turns.empty() || turn > turns.back())) {
      turns.push_back(turn);
    }
  }
  const auto begins_here = [&](const double& turn) {
    const auto end = std::upper_bound(turns.begin(), turns.end(), turn + kOneRun_turns);
    return end - (turns.begin() + (&turn - turns.data())) >= kFewestOfRun;
  };
  const auto first = std::find_if(turns.begin(), turns.end(), begins_here);
  if (!turns.empty()) {
    setting.phase_turns -= first == turns.end() ? turns.front() : *first;
  }
  return SpinClock{setting};
}

}  // namespace

bool is_another_period(double one_s, double other_s) {
  // Periods of channels differ by less, unless one has half of its edges or twice as many.
  return std::max(one_s, other_s) > 1.2 * std::min(one_s, other_s);
}

OtherChannels other_channels(const SpinConfig& config, std::span<const Pulse> pulses,
                             PulseChannel channel, double period_s) {
  OtherChannels others;
  for (const PulseChannel other : kByPreference) {
    const std::vector<TaiTime> edges = times_of(pulses, other);
    if (other == channel || edges.size() < kFewestAtEnd) {
      continue;
    }
    others.are_heard = true;
    if (const auto train =
            find_pulse_train(edges, edge_sigma_s(config.noise, other), kFewestAtEnd)) {
      const bool is_multiple = train->period_s > period_s && have_interval(edges, period_s);
      others.periods_s.push_back(is_multiple ? period_s : train->period_s);
    }
  }
  return others;
}

double defined_phase_turns(const SpinConfig& config, PulseChannel channel) {
  switch (channel) {
    case Sun1:
      return 0.0;
    case Sun2:
      return config.sun_sensor.slit_separation_rad / kTurn_rad;
    default:
      return 0.5;
  }
}

double apparent_motion_s(PulseChannel channel, double period_s) {
  return sees_the_sun(channel) ? 0.0 : kUnknownEarthRate_rad_s * period_s * period_s / kTurn_rad;
}

SpinClock::Setting setting_of(const PulseTrain& comb, double noise_s) {
  const double turns = std::max(1.0, comb.turns);
  const double hidden_turns = kHidden_scatters * comb.scatter_s / comb.period_s;
  const double span_s = turns * comb.period_s;
  // A drift found as the median of several parabolas leaves, between the ends, twice what hides
  // from a straight line.
  const double drift_sigma =
      comb.drift_per_s2 == 0.0
          ? kFirstDrift_per_s2
          : std::min(kFirstDrift_per_s2, 16.0 * hidden_turns / (span_s * span_s));
  return {.t = comb.t,
          .phase_turns = 0.0,
          .period_s = comb.period_s,
          .period_sigma_s = kHidden_scatters * 2.0 * comb.scatter_s / turns,
          .sigma_s = kHidden_scatters * comb.scatter_s,
          .drift_per_s2 = comb.drift_per_s2,
          .drift_sigma_per_s2 = drift_sigma,
          .scale = comb.scatter_s / noise_s};
}

std::optional<ClockStart> start_clock(const SpinConfig& config, std::span<const Pulse> waiting,
                                      bool at_end) {
  for (const PulseChannel channel : kByPreference) {
    const std::vector<TaiTime> edges = times_of(waiting, channel);
    const double noise_s = edge_sigma_s(config.noise, channel);
    const std::size_t fewest =
        at_end ? kFewestAtEnd : (channel == Sun1 ? kFewestSun1 : kFewestOthers);
    const auto comb = find_pulse_train(edges, noise_s, fewest);
    if (!comb ||
        is_outvoted(other_channels(config, waiting, channel, comb->period_s), comb->period_s)) {
      continue;
    }
    const double phase_turns = defined_phase_turns(config, channel);
    SpinClock::Setting setting = setting_of(*comb, noise_s);
    setting.phase_turns = phase_turns;
    return ClockStart{.reference = channel,
                      .clock = counted_from(setting, edges, channel, phase_turns)};
  }
  return std::nullopt;
}

std::optional<ClockStart> start_clock(const SpinConfig& config, std::span<const PeriodNote> notes,
                                      bool at_end) {
  std::vector<PeriodNote> sane;
  std::copy_if(notes.begin(), notes.end(), std::back_inserter(sane), [](const PeriodNote& note) {
    return note.period_s > kShortestPeriod_s && note.period_s < kLongestPeriod_s;
  });
  if (sane.size() < (at_end ? 1 : kNotesToAgree)) {
    return std::nullopt;
  }
  std::vector<PeriodNote> sorted = sane;
  const auto middle = sorted.begin() + std::ssize(sorted) / 2;
  std::ranges::nth_element(sorted, middle, {}, &PeriodNote::period_s);
  const PeriodNote chosen = note_of_one_turn(sane, *middle);
  const double period_s = chosen.period_s;
  const auto agrees = same_period_as(chosen);
  const auto agreeing = std::count_if(sane.begin(), sane.end(), agrees);
  if (!at_end && agreeing < static_cast<std::ptrdiff_t>(kNotesToAgree)) {
    return std::nullopt;
  }
  const auto first = std::find_if(sane.begin(), sane.end(), agrees);
  // Each period is the mean over its turn, half a turn from its sun1.
  const double apart_s = std::abs(elapsed_s(first->t_sun1, chosen.t_sun1)) + period_s;
  const double drifted_s = period_s * period_s * kFirstDrift_per_s2 * apart_s;
  const double sigma_s = std::hypot(std::numbers::sqrt2 * config.noise.sun_s, drifted_s);
  return ClockStart{.reference = Sun1,
                    .clock = SpinClock{{.t = first->t_sun1,
                                        .phase_turns = 0.0,
                                        .period_s = period_s,
                                        .period_sigma_s = sigma_s,
                                        .sigma_s = config.noise.sun_s}}};
}

}  // namespace spindrift
