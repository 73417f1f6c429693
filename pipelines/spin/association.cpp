#include "pipelines/spin/association.h"

#include <algorithm>
#include <cmath>
#include <numbers>
#include <utility>

namespace spindrift {
namespace {

// Intervals of sun1 that must be seen before the period is believed: enough for a median that a
// lost and a spurious edge do not move.
constexpr std::size_t kStartIntervals = 9;
constexpr std::size_t kFewestIntervals = 2;
// Without a clock no more than this is kept: noise alone must not fill the memory.
constexpr std::size_t kMostWaiting = 1024;
// Intervals this close to the median are one turn; a lost edge makes 2, a spurious one parts.
constexpr double kSameInterval = 0.02;
// After this many turns of refused intervals it is the edge that they start from that is doubtful.
constexpr std::int64_t kMostTurnsRefused = 5;
// How far from its expected phase an edge may lie, turns. The Sun stands still, a chord changes as
// the beam nears the limb.
constexpr double kSunGate_turns = 0.1;
constexpr double kOtherGate_turns = 0.2;
// A revolution stays open at least this long, so that a channel seen for the first time finds it.
constexpr double kOpen_turns = 0.75;
// A chord hovering about sun1 keeps its revolution until it has drifted this far past.
constexpr double kHover_turns = 0.25;
// Intervals within so many sigmas of each other are the same, beyond twice that another period.
constexpr double kStepSigmas = 6.0;
// So many edges in a row that miss their place and agree on another one move it there.
constexpr std::size_t kStraysToAgree = 5;
// Weight of a new edge in the expected phase of its channel.
constexpr double kFollow = 0.1;

constexpr std::array<PulseChannel, kPulseChannels> kChannels = {
    PulseChannel::Sun1,     PulseChannel::Sun2,    PulseChannel::NorthIn,
    PulseChannel::NorthOut, PulseChannel::SouthIn, PulseChannel::SouthOut};

double fraction(double turns) { return turns - std::floor(turns); }

/// Of the time between two sun edges, from the stated pulse noise.
double interval_sigma_s(const SpinConfig& config) {
  return std::numbers::sqrt2 * config.noise.sun_s;
}

double gate_turns(PulseChannel channel) {
  return channel == PulseChannel::Sun1 ? kSunGate_turns : kOtherGate_turns;
}

PulseUse unassociated(const Pulse& pulse) {
  return {.pulse = pulse, .revolution = {}, .rejected_by = Rejection::Unassociated};
}

/// The phase with the smallest summed distance to the others, round the circle.
double circular_median(const std::vector<double>& phases_turns) {
  const auto spread = [&](double centre) {
    double sum = 0.0;
    for (const double phase : phases_turns) {
      sum += std::abs(std::remainder(phase - centre, 1.0));
    }
    return sum;
  };
  return *std::min_element(phases_turns.begin(), phases_turns.end(),
                           [&](double a, double b) { return spread(a) < spread(b); });
}

/// The interval that most of a run of edges agree on.
struct SteadyInterval {
  double mean_s;
  double agreeing;    ///< How many intervals do.
  std::size_t first;  ///< The edge where the first of them begins.
};

/// @param tolerance_s How far from their median agreeing intervals may lie, as a function of it.
template <class Times, class Tolerance>
std::optional<SteadyInterval> steady_interval(const Times& edges, const Tolerance& tolerance_s) {
  std::vector<double> intervals_s;
  for (std::size_t i = 1; i < edges.size(); ++i) {
    intervals_s.push_back(seconds_between(edges[i - 1], edges[i]));
  }
  std::vector<double> sorted_s = intervals_s;
  const auto middle = sorted_s.begin() + static_cast<std::ptrdiff_t>(sorted_s.size() / 2);
  std::nth_element(sorted_s.begin(), middle, sorted_s.end());

  double sum_s = 0.0;
  std::size_t agreeing = 0;
  std::size_t first = 0;
  for (std::size_t i = intervals_s.size(); i-- > 0;) {
    if (std::abs(intervals_s[i] - *middle) <= tolerance_s(*middle)) {
      sum_s += intervals_s[i];
      ++agreeing;
      first = i;
    }
  }
  if (*middle <= 0.0 || 2 * agreeing <= intervals_s.size()) {
    return std::nullopt;
  }
  const auto count = static_cast<double>(agreeing);
  return SteadyInterval{.mean_s = sum_s / count, .agreeing = count, .first = first};
}

}  // namespace

Associator::Associator(const SpinConfig& config)
    : config_{config}, period_window_{config.screening, config.noise.sun_s} {
  expected_turns_.at(index_of(PulseChannel::Sun1)) = 0.0;
}

Association Associator::push(const Pulse& pulse) {
  Association out;
  if (clock_) {
    place(pulse, out);
    return out;
  }
  waiting_.push_back(pulse);
  if (pulse.channel == PulseChannel::Sun1 && start_clock(kStartIntervals)) {
    out = place_waiting();
  } else if (waiting_.size() > kMostWaiting) {
    out.left_over.push_back(unassociated(waiting_.front()));
    waiting_.erase(waiting_.begin());
  }
  return out;
}

Association Associator::finish() {
  Association out;
  if (!clock_ && start_clock(kFewestIntervals)) {
    out = place_waiting();
  }
  for (const Pulse& pulse : std::exchange(waiting_, {})) {
    out.left_over.push_back(unassociated(pulse));
  }
  while (!open_.empty()) {
    close(open_.front());
    out.closed.push_back(open_.front());
    open_.pop_front();
  }
  return out;
}

bool Associator::start_clock(std::size_t fewest_intervals) {
  std::vector<TaiTime> sun1;
  for (const Pulse& pulse : waiting_) {
    if (pulse.channel == PulseChannel::Sun1) {
      sun1.push_back(pulse.t);
    }
  }
  if (sun1.size() < fewest_intervals + 1) {
    return false;
  }
  const auto turn = steady_interval(sun1, [](double median_s) { return kSameInterval * median_s; });
  if (turn) {
    clock_ = Clock{.t_sun1 = sun1[turn->first],
                   .revolution = 0,
                   .period = {.period_s = turn->mean_s,
                              .sigma_s = interval_sigma_s(config_) / turn->agreeing}};
  }
  return turn.has_value();
}

/// After a step in the spin rate the last sun1 edges agree with one another and not with the clock:
/// a new one starts at `sun1`, its count not behind the old one's.
void Associator::restart_clock_after_step(const Pulse& sun1) {
  recent_sun1_.push_back(sun1.t);
  if (recent_sun1_.size() <= kStartIntervals) {
    return;
  }
  const double tolerance_s = kStepSigmas * interval_sigma_s(config_);
  const auto turn = steady_interval(recent_sun1_, [&](double) { return tolerance_s; });
  recent_sun1_.pop_front();
  if (!turn) {
    return;
  }
  // Several turns of the clock are lost edges, not a step.
  const double turns = std::max(1.0, std::round(turn->mean_s / clock_->period.period_s));
  if (std::abs(turn->mean_s - turns * clock_->period.period_s) <= 2.0 * tolerance_s) {
    return;
  }
  auto number = std::max(static_cast<std::int64_t>(std::round(phase_turns(sun1.t))), first_open_);
  if (!open_.empty() && open_.back().edge(PulseChannel::Sun1)) {
    number = std::max(number, open_.back().number + 1);
  }
  clock_ = Clock{
      .t_sun1 = sun1.t,
      .revolution = number,
      .period = {.period_s = turn->mean_s, .sigma_s = interval_sigma_s(config_) / turn->agreeing}};
  period_window_ = SpinPeriodWindow{config_.screening, config_.noise.sun_s};
  strays_ = {};
}

void Associator::learn_phases() {
  for (const PulseChannel channel : kChannels) {
    std::vector<double> phases;
    for (const Pulse& pulse : waiting_) {
      if (pulse.channel == channel && channel != PulseChannel::Sun1) {
        phases.push_back(fraction(phase_turns(pulse.t)));
      }
    }
    if (!phases.empty()) {
      expected_turns_.at(index_of(channel)) = unwrapped(channel, circular_median(phases));
    }
  }
}

Association Associator::place_waiting() {
  Association out;
  learn_phases();
  for (const Pulse& pulse : std::exchange(waiting_, {})) {
    place(pulse, out);
  }
  return out;
}

double Associator::phase_turns(TaiTime t) const {
  return static_cast<double>(clock_->revolution) +
         seconds_between(clock_->t_sun1, t) / clock_->period.period_s;
}

/// The phase of a channel first seen, on the turn where its expected phase shall live: sun2 about
/// the slit separation, an in-edge in [0, 1), an out-edge within the turn behind its in-edge.
double Associator::unwrapped(PulseChannel channel, double phase_turns) const {
  const auto behind = [&](PulseChannel in) {
    const std::optional<double>& start = expected_turns_.at(index_of(in));
    return start ? *start + fraction(phase_turns - *start) : fraction(phase_turns);
  };
  const auto ahead = [&](PulseChannel out) {
    const std::optional<double>& end = expected_turns_.at(index_of(out));
    return end ? *end - fraction(*end - phase_turns) : fraction(phase_turns);
  };
  switch (channel) {
    case PulseChannel::Sun1:
      return 0.0;
    case PulseChannel::Sun2: {
      const double centre = config_.sun_sensor.slit_separation_rad / (2.0 * std::numbers::pi);
      return centre + std::remainder(phase_turns - centre, 1.0);
    }
    case PulseChannel::NorthIn:
      return ahead(PulseChannel::NorthOut);
    case PulseChannel::SouthIn:
      return ahead(PulseChannel::SouthOut);
    case PulseChannel::NorthOut:
      return behind(PulseChannel::NorthIn);
    case PulseChannel::SouthOut:
      return behind(PulseChannel::SouthIn);
  }
  return fraction(phase_turns);
}

void Associator::place(const Pulse& pulse, Association& out) {
  if (pulse.channel == PulseChannel::Sun1) {
    restart_clock_after_step(pulse);
  }
  const double phase = phase_turns(pulse.t);
  std::optional<double>& expected = expected_turns_.at(index_of(pulse.channel));
  if (!expected) {
    expected = unwrapped(pulse.channel, phase);
  }
  close_before(phase, out);

  double turns = std::round(phase - *expected);
  double off_turns = std::abs(phase - *expected - turns);
  if (off_turns <= gate_turns(pulse.channel)) {
    strays_.at(index_of(pulse.channel)).clear();
  } else if (pulse.channel != PulseChannel::Sun1 && found_again(pulse)) {
    turns = std::round(phase_turns(pulse.t) - *expected);
    off_turns = 0.0;
  }
  Revolution* const revolution = off_turns <= gate_turns(pulse.channel)
                                     ? open_revolution(static_cast<std::int64_t>(turns))
                                     : nullptr;
  if (revolution == nullptr) {
    out.left_over.push_back(unassociated(pulse));
    return;
  }
  // Of two edges of one channel, the nearer to where it is expected stays.
  std::optional<TaiTime>& edge = revolution->edges.at(index_of(pulse.channel));
  if (!edge) {
    edge = pulse.t;
  } else if (off_turns < std::abs(phase_turns(*edge) - *expected - turns)) {
    out.left_over.push_back(unassociated({.t = *edge, .channel = pulse.channel}));
    edge = pulse.t;
  } else {
    out.left_over.push_back(unassociated(pulse));
  }
}

/// Adds to the strays of the channel; true when they agree on a new place, which is then expected.
bool Associator::found_again(const Pulse& pulse) {
  std::deque<TaiTime>& strays = strays_.at(index_of(pulse.channel));
  strays.push_back(pulse.t);
  if (strays.size() < kStraysToAgree) {
    return false;
  }
  std::vector<double> phases(strays.size());
  std::transform(strays.begin(), strays.end(), phases.begin(),
                 [this](TaiTime t) { return fraction(phase_turns(t)); });
  strays.pop_front();
  const double median = circular_median(phases);
  const bool agree = std::all_of(phases.begin(), phases.end(), [&](double phase) {
    return std::abs(std::remainder(phase - median, 1.0)) <= kOtherGate_turns;
  });
  if (agree) {
    expected_turns_.at(index_of(pulse.channel)) = unwrapped(pulse.channel, median);
    strays.clear();
  }
  return agree;
}

/// Empty when that revolution is closed already, or precedes the first sun1.
Revolution* Associator::open_revolution(std::int64_t number) {
  if (number < first_open_) {
    return nullptr;
  }
  auto place = std::find_if(open_.begin(), open_.end(),
                            [&](const Revolution& r) { return r.number >= number; });
  if (place == open_.end() || place->number != number) {
    place = open_.insert(
        place, Revolution{.number = number, .edges = {}, .period_candidate = {}, .period = {}});
  }
  return &*place;
}

void Associator::close_before(double phase_turns, Association& out) {
  double last_turns = kOpen_turns;
  for (const std::optional<double>& expected : expected_turns_) {
    last_turns = std::max(last_turns, expected.value_or(0.0));
  }
  const double reach_turns = last_turns + kOtherGate_turns;
  while (!open_.empty() && phase_turns > static_cast<double>(open_.front().number) + reach_turns) {
    close(open_.front());
    out.closed.push_back(open_.front());
    open_.pop_front();
  }
}

void Associator::close(Revolution& revolution) {
  first_open_ = revolution.number + 1;
  follow(revolution);
  const std::optional<TaiTime>& sun1 = revolution.edge(PulseChannel::Sun1);
  if (sun1 && revolution.number > clock_->revolution) {
    revolution.period_candidate =
        period_window_.add(clock_->t_sun1, *sun1, revolution.number - clock_->revolution);
    if (period_window_.size() >= kStartIntervals && period_window_.period()) {
      clock_->period = *period_window_.period();
    }
    if (revolution.period_candidate->accepted ||
        revolution.number - clock_->revolution >= kMostTurnsRefused) {
      clock_->t_sun1 = *sun1;
      clock_->revolution = revolution.number;
    }
  }
  revolution.period = clock_->period;
}

void Associator::follow(const Revolution& revolution) {
  for (const PulseChannel channel : kChannels) {
    const std::optional<TaiTime>& edge = revolution.edge(channel);
    std::optional<double>& expected = expected_turns_.at(index_of(channel));
    if (edge && channel != PulseChannel::Sun1) {
      const double seen = phase_turns(*edge) - static_cast<double>(revolution.number);
      *expected += kFollow * (seen - *expected);
    }
  }
  using enum PulseChannel;
  for (const auto& [in, out] : {std::pair{NorthIn, NorthOut}, std::pair{SouthIn, SouthOut}}) {
    std::optional<double>& in_turns = expected_turns_.at(index_of(in));
    std::optional<double>& out_turns = expected_turns_.at(index_of(out));
    const double first = in_turns.value_or(out_turns.value_or(0.0));
    const double shift = first > 1.0 + kHover_turns ? -1.0 : (first < -kHover_turns ? 1.0 : 0.0);
    for (std::optional<double>* turns : {&in_turns, &out_turns}) {
      if (*turns) {
        **turns += shift;
      }
    }
  }
}

}  // namespace spindrift
