#include "pipelines/spin/association/expected_phases.h"

#include <algorithm>
#include <cmath>
#include <iterator>
#include <set>
#include <utility>
#include <vector>

#include "pipelines/frames/angle.h"
#include "pipelines/spin/association/copies.h"
#include "pipelines/spin/association/robust_line.h"

namespace spindrift {
namespace {

using enum PulseChannel;

constexpr double kEarthWander_rad_s2 = 2e-6;
constexpr double kMostEarthRates = 3.0;
// The Sun's phase shifts when the axis moves.
constexpr double kSunDrift = 1e-4;
constexpr double kSunWander = 1e-6;
// A chord hovering about sun1 keeps its revolution until it has drifted this far past.
constexpr double kHover_turns = 0.25;
// This many edges in a row that miss their place and agree on another move it there; fewer where no
// more were accepted at the old one. Strays of a silent channel, one in fifty turns, do so by
// chance once in ten million turns, as they must come within kAgreeWithin revolutions.
constexpr std::size_t kStraysToAgree = 5;
constexpr std::size_t kFewestToAgree = 3;
// Widest scatter of a channel that scatters more than stated; it needs kStraysToAgree turns.
constexpr double kWidest_turns = 0.02;
constexpr std::size_t kMostStrays = 9;
constexpr int kAgreeWithin = 20;

double fraction(double turns) { return turns - std::floor(turns); }

/// Counts the turns of the points, since an edge may come doubled.
std::size_t turns_among(const std::vector<PhasePoint>& points) {
  std::set<double> turns;
  std::transform(points.begin(), points.end(), std::inserter(turns, turns.end()),
                 [](const PhasePoint& point) { return point.turn; });
  return turns.size();
}

/// Tells whether `fewest_turns` turns have an edge within `off` of the line, or kStraysToAgree
/// turns one that scatters more.
bool is_no_chance(const std::vector<PhasePoint>& points, const RobustLine& line, double off,
                  std::size_t fewest_turns) {
  std::vector<PhasePoint> near;
  std::copy_if(
      points.begin(), points.end(), std::back_inserter(near),
      [&](const PhasePoint& point) { return std::abs(point.phase - line.at(point.turn)) <= off; });
  return turns_among(near) >= fewest_turns ||
         (turns_among(line.agreeing) >= kStraysToAgree && line.scatter <= kWidest_turns);
}

/// Tells whether more than half of the turns with an edge on the line also have one elsewhere.
bool has_another_place(std::span<const double> counts, const RobustLine& line) {
  std::vector<double> behind;  // Phases behind the line, further than a copy.
  std::vector<double> turns;
  for (const double count : counts) {
    const double turn = std::floor(count - line.phase + kCopies_turns);
    const double off = count - turn - line.at(turn);
    if (off > kCopies_turns && off < 1.0 - kCopies_turns) {
      behind.push_back(off);
      turns.push_back(turn);
    }
  }
  if (behind.empty()) {
    return false;
  }
  const double place = circular_median(behind);
  std::set<double> there;
  for (std::size_t i = 0; i < behind.size(); ++i) {
    if (std::abs(behind[i] - place) <= kCopies_turns) {
      there.insert(turns[i]);
    }
  }
  const auto both =
      std::count_if(line.agreeing.begin(), line.agreeing.end(),
                    [&](const PhasePoint& point) { return there.contains(point.turn); });
  return 2 * both > std::ssize(line.agreeing);
}

}  // namespace

double earth_wander_turns(PulseChannel channel, double period_s) {
  return sees_the_sun(channel) ? kSunWander : kEarthWander_rad_s2 * period_s * period_s / kTurn_rad;
}

ExpectedPhases::ExpectedPhases(const SpinConfig& config)
    : noise_{config.noise},
      gate_sigma_{config.screening.sigma},
      interference_s_{config.screening.interference_s},
      slit_separation_turns_{config.sun_sensor.slit_separation_rad / kTurn_rad} {}

double ExpectedPhases::noise_turns(PulseChannel channel) const {
  return edge_sigma_s(noise_, channel) / period_s_;
}

DriftNoise ExpectedPhases::drift_noise(PulseChannel channel, double clock_sigma_turns) const {
  return {.measured = std::hypot(noise_turns(channel), clock_sigma_turns),
          .wander = wander(channel)};
}

double ExpectedPhases::most_drift(PulseChannel channel) const {
  return sees_the_sun(channel) && sees_the_sun(reference_)
             ? kSunDrift
             : kMostEarthRates * kEarthMotion_rad_s * period_s_ / kTurn_rad;
}

double ExpectedPhases::wander(PulseChannel channel) const {
  return std::max(earth_wander_turns(channel, period_s_),
                  earth_wander_turns(reference_, period_s_));
}

void ExpectedPhases::define(PulseChannel channel, std::int64_t turn, double phase_turns) {
  of(channel).phase = DriftFilter{{.x = static_cast<double>(turn),
                                   .value = phase_turns,
                                   .value_sigma = noise_turns(channel),
                                   .change = 0.0,
                                   .change_sigma = most_drift(channel) / kMostEarthRates}};
  of(channel).known = true;
  of(channel).in_a_row = 0;
  of(channel).last_seen = revolution_;
}

std::optional<RobustLine> ExpectedPhases::place_of(PulseChannel channel,
                                                   std::span<const double> counts,
                                                   std::size_t fewest_turns) const {
  if (counts.empty()) {
    return std::nullopt;
  }
  std::vector<double> phases(counts.size());
  std::transform(counts.begin(), counts.end(), phases.begin(), fraction);
  const double median = circular_median(phases);
  const double place = unwrapped(channel, median, counts.back());
  std::vector<PhasePoint> points(counts.size());
  std::transform(counts.begin(), counts.end(), points.begin(), [&](double count) {
    const double turn = std::round(count - place);
    return PhasePoint{.turn = turn, .phase = count - turn};
  });
  auto line = fit_robust_line(points, noise_turns(channel), most_drift(channel));
  return is_no_chance(points, *line, gate_sigma_ * noise_turns(channel), fewest_turns)
             ? std::move(line)
             : std::nullopt;
}

bool ExpectedPhases::can_be_at(PulseChannel channel, double count) const {
  const PulseChannel other = channel == Sun1 ? Sun2 : Sun1;
  if (!sees_the_sun(channel) || !knows(other)) {
    return true;
  }
  const double behind = count - at(other, count);
  const double lag = (channel == Sun2 ? behind : -behind) - slit_separation_turns_;
  // The lag between the slits differs from their separation by less: beyond, the Sun is on the
  // other side of the body.
  return std::abs(std::remainder(lag, 1.0)) < 0.25;
}

bool ExpectedPhases::learn(PulseChannel channel, std::span<const double> counts,
                           std::size_t fewest_turns, double clock_sigma_turns) {
  // Most edges that a channel is learnt from.
  counts = counts.last(std::min(counts.size(), std::size_t{32}));
  const auto only_place = [&](std::span<const double> some) {
    auto line = place_of(channel, some, fewest_turns);
    return line && !has_another_place(some, *line) ? std::move(line) : std::nullopt;
  };
  auto line = only_place(counts);
  if (!line) {
    std::vector<double> possible;
    std::copy_if(counts.begin(), counts.end(), std::back_inserter(possible),
                 [&](double count) { return can_be_at(channel, count); });
    line = only_place(possible);
  }
  if (!line) {
    return false;
  }
  const auto edges = static_cast<double>(line->agreeing.size());
  // A few edges tell less of the drift than its possible range does.
  const double possible = most_drift(channel) / kMostEarthRates;
  const double seen = std::hypot(line->scatter * std::sqrt(12.0) / (edges * std::sqrt(edges)),
                                 wander(channel) * std::sqrt(edges));
  const double change = line->drift * possible * possible / (possible * possible + seen * seen);
  const double first = line->agreeing.front().turn;
  of(channel).phase = DriftFilter{
      {.x = first,
       .value = line->phase + change * (first - line->turn),
       .value_sigma = std::hypot(2.0 * line->scatter / std::sqrt(edges), clock_sigma_turns),
       .change = change,
       .change_sigma = possible * seen / std::hypot(possible, seen),
       .scale = line->scatter / noise_turns(channel)}};
  of(channel).known = true;
  of(channel).last_seen = revolution_;
  return true;
}

void ExpectedPhases::end_revolution() {
  ++revolution_;
  for (Channel& channel : channels_) {
    // A channel is silent after this many revolutions without a good edge.
    if (&channel != &of(reference_) && revolution_ - channel.last_seen > 30) {
      channel.known = false;
      channel.accepted = 0;
      channel.in_a_row = 0;
    }
    std::erase_if(channel.strays, [this](const Stray& stray) {
      return revolution_ - stray.revolution > kAgreeWithin;
    });
  }
}

DriftTest ExpectedPhases::test(PulseChannel channel, std::int64_t turn, double phase_turns,
                               double clock_sigma_turns) const {
  return of(channel).phase->test(static_cast<double>(turn), phase_turns,
                                 drift_noise(channel, clock_sigma_turns),
                                 {.sigma = gate_sigma_, .most = gate_turns(channel)});
}

DriftTest ExpectedPhases::follow(PulseChannel channel, std::int64_t turn, double phase_turns,
                                 double clock_sigma_turns) {
  Channel& own = of(channel);
  const DriftTest tested = own.phase->follow(static_cast<double>(turn), phase_turns,
                                             drift_noise(channel, clock_sigma_turns),
                                             {.sigma = gate_sigma_, .most = gate_turns(channel)});
  if (tested.passed()) {
    own.strays.clear();
    ++own.accepted;
    ++own.in_a_row;
    own.last_seen = revolution_;
  } else {
    own.in_a_row = 0;
  }
  return tested;
}

double ExpectedPhases::phase_sigma(PulseChannel channel, double turn) const {
  return of(channel).phase->sigma_at(turn, {.measured = 0.0, .wander = wander(channel)});
}

double ExpectedPhases::drift_sigma(PulseChannel channel, double turn) const {
  return of(channel).phase->change_sigma_at(turn, {.measured = 0.0, .wander = wander(channel)});
}

double ExpectedPhases::sigma_turns(PulseChannel channel, double turn,
                                   double clock_sigma_turns) const {
  const double noise = noise_turns(channel);
  const double expected =
      channel == reference_
          ? clock_sigma_turns
          : of(channel).phase->sigma_at(turn, {.measured = noise, .wander = wander(channel)});
  return std::hypot(noise, expected);
}

std::optional<EdgeGap> ExpectedPhases::gap(PulseChannel one, PulseChannel other, double turn,
                                           double clock_sigma_turns) const {
  if (!knows(one) || !knows(other)) {
    return std::nullopt;
  }
  const double apart = std::abs(std::remainder(at(one, turn) - at(other, turn), 1.0));
  const double sigma = std::hypot(sigma_turns(one, turn, clock_sigma_turns),
                                  sigma_turns(other, turn, clock_sigma_turns));
  return EdgeGap{.gap_s = apart * period_s_,
                 .least_s = interference_s_ + kInterferenceSigmas * sigma * period_s_};
}

bool ExpectedPhases::stray(PulseChannel channel, double count, double displaced_turns,
                           double clock_sigma_turns) {
  Channel& own = of(channel);
  own.in_a_row = 0;
  if (!own.known && !can_be_at(channel, count)) {
    return false;
  }
  const auto place =
      std::upper_bound(own.strays.begin(), own.strays.end(), count,
                       [](double later, const Stray& stray) { return later < stray.count; });
  own.strays.insert(place, {.count = count, .revolution = revolution_});
  if (own.strays.size() > kMostStrays) {
    own.strays.pop_front();
  }
  const std::size_t needed = std::clamp(own.accepted, kFewestToAgree, kStraysToAgree);
  if (own.strays.size() < needed) {
    return false;
  }
  std::vector<PhasePoint> points;
  for (const Stray& other : own.strays) {
    const double turn = std::round(other.count - count);
    points.push_back({.turn = turn, .phase = other.count - count - turn});
  }
  const double scale = own.phase ? own.phase->scale() : 1.0;
  const double noise = std::hypot(scale * noise_turns(channel), displaced_turns);
  const auto line = fit_robust_line(points, noise, most_drift(channel));
  if ((own.known && line->scatter > gate_sigma_ * noise) || turns_among(line->agreeing) < needed ||
      line->agreeing.back().phase != points.back().phase) {
    return false;
  }
  if (!own.known && strays_have_another_place(channel, count, *line)) {
    return false;
  }
  std::vector<double> counts(line->agreeing.size());
  std::transform(line->agreeing.begin(), line->agreeing.end(), counts.begin(),
                 [&](const PhasePoint& point) { return count + point.turn + point.phase; });
  const bool agree = learn(channel, counts, needed, clock_sigma_turns);
  if (agree) {
    own.strays.clear();
    own.accepted = needed;
    own.in_a_row = static_cast<int>(needed);
  }
  return agree;
}

/// @param line Line through phases relative to `count`.
bool ExpectedPhases::strays_have_another_place(PulseChannel channel, double count,
                                               RobustLine line) const {
  const std::deque<Stray>& strays = of(channel).strays;
  std::vector<double> counts(strays.size());
  std::transform(strays.begin(), strays.end(), counts.begin(),
                 [](const Stray& stray) { return stray.count; });
  line.phase += count;
  return has_another_place(counts, line);
}

void ExpectedPhases::shift(std::int64_t turn, double phase_turns, double drift) {
  for (Channel& channel : channels_) {
    if (channel.phase) {
      channel.phase->shift(static_cast<double>(turn), -phase_turns, -drift);
    }
  }
  forget_strays();
}

void ExpectedPhases::forget_strays() {
  for (Channel& channel : channels_) {
    channel.strays.clear();
  }
}

double ExpectedPhases::latest(double turn) const {
  double latest = 0.0;
  for (const Channel& channel : channels_) {
    if (channel.known) {
      latest = std::max(latest, channel.phase->at(turn));
    }
  }
  return latest;
}

/// Returns the phase of a newly seen channel on the turn that it is expected in: near the slits for
/// the Sun, in [0, 1) for an in-edge, within a turn behind its in-edge for an out-edge.
double ExpectedPhases::unwrapped(PulseChannel channel, double phase_turns, double turn) const {
  const auto behind = [&](PulseChannel in) {
    const double start = knows(in) ? at(in, turn) : 0.0;
    return start + fraction(phase_turns - start);
  };
  const auto ahead = [&](PulseChannel out) {
    if (!knows(out)) {
      return fraction(phase_turns);
    }
    const double end = at(out, turn);
    return end - fraction(end - phase_turns);
  };
  switch (channel) {
    case Sun1:
      return std::remainder(phase_turns, 1.0);
    case Sun2: {
      const double centre = slit_separation_turns_;
      return centre + std::remainder(phase_turns - centre, 1.0);
    }
    case NorthIn:
      return ahead(NorthOut);
    case SouthIn:
      return ahead(SouthOut);
    case NorthOut:
      return behind(NorthIn);
    case SouthOut:
      return behind(SouthIn);
  }
  return fraction(phase_turns);
}

void ExpectedPhases::keep_chords_near() {
  for (const auto& [in, out] : {std::pair{NorthIn, NorthOut}, std::pair{SouthIn, SouthOut}}) {
    std::optional<DriftFilter>& in_phase = of(in).phase;
    std::optional<DriftFilter>& out_phase = of(out).phase;
    const std::optional<DriftFilter>& first = in_phase ? in_phase : out_phase;
    if (!first) {
      continue;
    }
    const double phase = first->value();
    const double move = phase > 1.0 + kHover_turns ? -1.0 : (phase < -kHover_turns ? 1.0 : 0.0);
    for (std::optional<DriftFilter>* channel : {&in_phase, &out_phase}) {
      if (*channel && move != 0.0) {
        (*channel)->shift(0.0, move, 0.0);
      }
    }
  }
}

}  // namespace spindrift
