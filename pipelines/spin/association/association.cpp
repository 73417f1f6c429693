#include "pipelines/spin/association/association.h"

#include <algorithm>
#include <array>
#include <cmath>
#include <set>
#include <utility>
#include <vector>

#include "pipelines/spin/association/clock_start.h"
#include "pipelines/time/time_span.h"

namespace spindrift {
namespace {

// A revolution stays open at least this long, so that a channel seen for the first time finds it.
constexpr double kOpen_turns = 0.75;
constexpr double kChordGate_turns = 0.2;
// A clock less certain than this may have miscounted the turns of a silence: it starts afresh.
constexpr double kLost_turns = 0.2;
// A channel is learnt from the edges that waited for the clock when it was seen in at least
// kFewestSeen turns, and in at least one of kMostTurnsAnEdge turns.
constexpr std::size_t kFewestSeen = 3;
constexpr std::size_t kMostTurnsAnEdge = 3;

constexpr std::array<PulseChannel, kPulseChannels> kChannels = {
    PulseChannel::Sun1,     PulseChannel::Sun2,    PulseChannel::NorthIn,
    PulseChannel::NorthOut, PulseChannel::SouthIn, PulseChannel::SouthOut};

PulseUse left_over(const Pulse& pulse, Rejection rejected_by = Rejection::Unassociated) {
  return {.pulse = pulse, .revolution = {}, .rejected_by = rejected_by};
}

PulseUse spoilt_use(const Pulse& pulse, const EdgeGap& spoilt_by) {
  PulseUse use = left_over(pulse, Rejection::Interference);
  use.gap = spoilt_by;
  return use;
}

/// Returns what a test in turns found, in seconds. An edge of a later phase than expected came
/// late.
Observation observation(const Pulse& pulse, const DriftTest& tested, double period_s,
                        Rejection test) {
  return Observation::of(pulse.t, source_of(pulse.channel), tested.off * period_s,
                         tested.sigma * period_s, tested.limit * period_s, test);
}

}  // namespace

Associator::Associator(const SpinConfig& config)
    : config_{config},
      phases_{config},
      interfering_pairs_{config.screening.interference_s},
      intervals_{config.screening, config.noise.sun_s} {}

void Associator::note_period(TaiTime t_sun1, double period_s) {
  intervals_.keep({.t_sun1 = t_sun1, .period_s = period_s});
}

Association Associator::push(const Pulse& pulse) {
  Association out;
  place_or_wait(pulse, out);
  return out;
}

Association Associator::push_spoilt(const Pulse& pulse, const EdgeGap& spoilt_by) {
  Association out;
  if (clock_ && counts(pulse.t)) {
    place(pulse, spoilt_by, out);
  } else {
    out.left_over.push_back(spoilt_use(pulse, spoilt_by));
  }
  return out;
}

void Associator::place_or_wait(const Pulse& pulse, Association& out) {
  if (clock_) {
    const double phase = clock_->phase_turns(pulse.t);
    if (phase > static_cast<double>(first_open_) && clock_sigma_turns(phase) > kLost_turns) {
      give_up_clock(pulse, out);
    }
  }
  if (clock_) {
    place(pulse, {}, out);
    return;
  }
  waiting_.push_back(pulse);
  try_to_start(false, out);
  // Most edges kept without a clock: noise alone must not fill the memory.
  if (!clock_ && waiting_.size() > 1024) {
    out.left_over.push_back(left_over(waiting_.front()));
    waiting_.erase(waiting_.begin());
  }
}

Association Associator::finish() {
  Association out;
  if (!clock_) {
    try_to_start(true, out);
  }
  for (const Pulse& pulse : std::exchange(waiting_, {})) {
    out.left_over.push_back(left_over(pulse));
  }
  while (!open_.empty()) {
    close_front(out);
  }
  return out;
}

void Associator::try_to_start(bool at_end, Association& out) {
  // The edges must show where the other channels are; those of the last turn, and of a chord that
  // straddles sun1, may not have come yet.
  const auto sun1_edges = std::count_if(waiting_.begin(), waiting_.end(), [](const Pulse& pulse) {
    return pulse.channel == PulseChannel::Sun1;
  });
  std::optional<ClockStart> start;
  if (at_end || sun1_edges >= static_cast<std::ptrdiff_t>(kFewestSeen) + 2) {
    start = start_clock(config_, intervals_.notes(), at_end);
  }
  if (!start) {
    start = start_clock(config_, waiting_, at_end);
  }
  if (!start) {
    return;
  }
  clock_ = start->clock;
  reference_ = start->reference;
  if (!waiting_.empty() && !counts(waiting_.back().t)) {
    clock_.reset();
    return;
  }
  sun1_known_ = reference_ == PulseChannel::Sun1;
  intervals_.begin_anew(edge_sigma_s(config_.noise, reference_));
  phases_.set_period(clock_->period_s());
  phases_.set_reference(reference_);
  if (lost_clock_) {
    const double guess = lost_clock_->phase_turns(clock_->t_of(0.0));
    first_open_ = std::max(first_open_, static_cast<std::int64_t>(std::llround(guess)));
    clock_->add_turns(first_open_);
    lost_clock_.reset();
  }
  phases_.define(reference_, first_open_, defined_phase_turns(config_, reference_));
  learn_phases();
  for (const Pulse& pulse : std::exchange(waiting_, {})) {
    place_or_wait(pulse, out);
  }
}

/// Gives up the clock after a silence too long for it to tell which turn `pulse` is in.
void Associator::give_up_clock(const Pulse& pulse, Association& out) {
  while (!open_.empty()) {
    close_front(out);
  }
  count_sigma_turns_ = clock_sigma_turns(clock_->phase_turns(pulse.t));
  lost_clock_ = std::exchange(clock_, std::nullopt);
  phases_ = ExpectedPhases{config_};
  turns_without_reference_ = 0;
  rate_step_.forget();
  recent_.clear();
  intervals_.forget_notes_before(pulse.t);
}

/// Returns the waiting edges without their copies, and without those that came alone where copies
/// usually lie apart.
std::vector<Pulse> Associator::telling_edges() {
  for (const Pulse& pulse : waiting_) {
    copies_.behind_first_s(pulse, clock_->period_s());
  }
  std::vector<Pulse> first;
  std::vector<bool> alone;
  std::array<std::size_t, kPulseChannels> last{};
  for (const Pulse& pulse : waiting_) {
    if (copies_.behind_first_s(pulse, clock_->period_s())) {
      alone.at(last.at(index_of(pulse.channel))) = false;
    } else {
      last.at(index_of(pulse.channel)) = first.size();
      first.push_back(pulse);
      alone.push_back(true);
    }
  }
  std::vector<Pulse> telling;
  for (std::size_t i = 0; i < first.size(); ++i) {
    const PulseChannel channel = first[i].channel;
    if (!alone[i] || !copies_.are_apart(channel, edge_sigma_s(config_.noise, channel))) {
      telling.push_back(first[i]);
    }
  }
  return telling;
}

/// Learns the channels that have edges in enough turns; the others are learnt once they have.
void Associator::learn_phases() {
  std::array<std::vector<double>, kPulseChannels> counts;
  std::set<double> turns;
  for (const Pulse& pulse : telling_edges()) {
    const double count = clock_->phase_turns(pulse.t);
    counts.at(index_of(pulse.channel)).push_back(count);
    if (pulse.channel == reference_) {
      turns.insert(std::round(count - phases_.at(reference_, count)));
    }
  }
  // The last turn may be incomplete.
  const std::size_t whole = std::max<std::size_t>(turns.size(), 2) - 1;
  const std::size_t fewest = std::max(std::min(whole, kFewestSeen), whole / kMostTurnsAnEdge);
  for (const PulseChannel channel : kChannels) {
    const std::vector<double>& own = counts.at(index_of(channel));
    if (channel != reference_ && !own.empty()) {
      phases_.learn(channel, own, fewest, clock_sigma_turns(own.back()));
    }
  }
}

void Associator::note_recent(const Pulse& pulse) {
  recent_.push_back(pulse);
  // Edges of all channels are kept for a few more turns than a step of the rate is searched in.
  if (recent_.size() > 16 * kPulseChannels) {
    recent_.pop_front();
  }
}

/// Tells whether other channels share the period: a second edge of the reference alone is no step.
bool Associator::is_of_all_channels(const PulseTrain& comb) const {
  const auto begin = std::find_if(recent_.begin(), recent_.end(), [&](const Pulse& pulse) {
    return elapsed_s(comb.t, pulse.t) >= -kOnComb_sigma * comb.scatter_s;
  });
  const OtherChannels others =
      other_channels(config_, std::vector<Pulse>(begin, recent_.end()), reference_, comb.period_s);
  return !others.are_heard ||
         std::any_of(others.periods_s.begin(), others.periods_s.end(),
                     [&](double period_s) { return !is_another_period(period_s, comb.period_s); });
}

/// Tells whether, of the other channels that would notice it if the body was as far off the clock,
/// more have kept to the clock than have left it while the reference gave the edges of the comb:
/// then the reference is wrong, not the rate. Nearer to its place than a copy may be, it may be of
/// another receiver.
/// @param off_turns How far the last edge of the reference, at `phase_turns`, is off.
bool Associator::others_keep_to_the_clock(const PulseTrain& comb, double off_turns,
                                          double phase_turns) const {
  const double clock_sigma = clock_sigma_turns(phase_turns);
  int keep = 0;
  for (const PulseChannel channel : kChannels) {
    if (channel != reference_ && phases_.knows(channel) &&
        off_turns > 2.0 * config_.screening.sigma *
                        phases_.sigma_turns(channel, phase_turns, clock_sigma)) {
      keep += phases_.in_a_row(channel) >= static_cast<int>(comb.edges) ? 1 : -1;
    }
  }
  return off_turns > kCopies_turns && keep > 0;
}

/// Tells whether an edge of the reference at `t` lies within the limits of its expectation.
/// @param most_turns Absolute limit.
bool Associator::lies_within(double most_turns, double turn, TaiTime t) const {
  return clock_
      ->test(turn + phases_.at(reference_, turn), t, edge_sigma_s(config_.noise, reference_),
             reference_wander(), {.sigma = config_.screening.sigma, .most = most_turns})
      .passed();
}

bool Associator::is_good_reference(const Pulse& pulse) const {
  const double phase = clock_->phase_turns(pulse.t);
  const double turn = std::round(phase - phases_.at(reference_, phase));
  return lies_within(gate_turns(reference_), turn, pulse.t);
}

/// Sets the clock anew after a step of the spin rate, when the latest reference edges agree with
/// one another and not with the clock. The count of turns does not go back.
void Associator::restart_after_step(const Pulse& pulse) {
  const double phase = clock_->phase_turns(pulse.t);
  const double expected = phases_.at(reference_, phase);
  const double turn = std::round(phase - expected);
  const double noise_s = edge_sigma_s(config_.noise, reference_);
  rate_step_.add(pulse.t, is_good_reference(pulse));
  const auto comb = rate_step_.new_pulse_train(clock_->scale() * noise_s, clock_->period_s());
  if (!comb || others_keep_to_the_clock(*comb, std::abs(phase - expected - turn), phase) ||
      (is_another_period(comb->period_s, clock_->period_s()) && !is_of_all_channels(*comb))) {
    return;
  }
  SpinClock::Setting setting = setting_of(*comb, noise_s);
  const SpinClock teeth{setting};
  auto number = std::max(static_cast<std::int64_t>(turn), first_open_);
  if (!open_.empty() && open_.back().edge(reference_)) {
    const double turns_behind =
        teeth.phase_turns(pulse.t) - teeth.phase_turns(*open_.back().edge(reference_));
    number = std::max(number, open_.back().number + std::int64_t{std::llround(turns_behind)});
  }
  setting.phase_turns =
      static_cast<double>(number) + expected - std::round(teeth.phase_turns(pulse.t));
  clock_ = SpinClock{setting};
  // The comb has the period of the reference edges, so that their phase does not drift.
  phases_.define(reference_, number, expected);
  intervals_.begin_anew(noise_s);
  rate_step_.forget();
  phases_.set_period(comb->period_s);
  phases_.forget_strays();
}

double Associator::clock_sigma_turns(double phase_turns) const {
  return clock_->sigma_s(phase_turns, reference_wander()) / clock_->period_s();
}

/// Tells whether the clock is certain of the turn at `t`.
bool Associator::counts(TaiTime t) const {
  return clock_sigma_turns(clock_->phase_turns(t)) <= kLost_turns;
}

double Associator::reference_wander() const {
  return sees_the_sun(reference_) ? 0.0 : earth_wander_turns(reference_, clock_->period_s());
}

/// Returns the clock's period. Its sigma includes the Earth's apparent motion, which the clock
/// cannot tell from the body's.
SpinPeriod Associator::period_at(TaiTime t) const {
  SpinPeriod period = clock_->period_at(t, reference_wander());
  period.sigma_s = std::hypot(period.sigma_s, apparent_motion_s(reference_, period.period_s));
  return period;
}

/// Returns how far from its expectation an edge still counts with a turn: further after a silence.
double Associator::reach_turns(PulseChannel channel, double phase_turns) const {
  // However long the silence, an edge counts with a turn only if it lies nearer to it than this.
  return std::clamp(config_.screening.sigma * clock_sigma_turns(phase_turns), gate_turns(channel),
                    0.4);
}

void Associator::place(const Pulse& pulse, const std::optional<EdgeGap>& spoilt_by,
                       Association& out) {
  const auto behind_s = copies_.behind_first_s(pulse, clock_->period_s());
  if (!behind_s) {
    note_recent(pulse);
    if (pulse.channel == reference_ && !spoilt_by) {
      restart_after_step(pulse);
    }
  } else if (pulse.channel == reference_ && is_good_reference(pulse) &&
             !copies_.disagree_with_others(reference_)) {
    rate_step_.replace_last(pulse.t);
  }
  const double phase = clock_->phase_turns(pulse.t);
  const double first_phase = clock_->phase_turns(later_by_s(pulse.t, -behind_s.value_or(0.0)));
  close_before(phase, out);
  const bool lies_near = phases_.knows(pulse.channel) && test_of(pulse).tested.passed();
  // Where copies matter, the first shows where its channel is, but only once a copy has come.
  const bool tells = behind_s.has_value() ==
                     copies_.are_apart(pulse.channel, edge_sigma_s(config_.noise, pulse.channel));
  if (pulse.channel != reference_ && !lies_near && tells) {
    phases_.stray(pulse.channel, first_phase,
                  spoilt_by ? interfering_pairs_.displacement_s() / clock_->period_s() : 0.0,
                  clock_sigma_turns(phase));
  }
  if (Revolution* const revolution = revolution_of(pulse)) {
    put(*revolution, pulse, spoilt_by, out);
  } else {
    leave_over(pulse, spoilt_by, behind_s.value_or(clock_->period_s()), out);
  }
}

Associator::TurnTest Associator::test_of(const Pulse& pulse) const {
  const double phase = clock_->phase_turns(pulse.t);
  const double count = phase - phases_.at(pulse.channel, phase);
  const double turn = std::round(count);
  return {.turn = static_cast<std::int64_t>(turn),
          .tested = {.off = count - turn,
                     .sigma = phases_.sigma_turns(pulse.channel, phase, clock_sigma_turns(phase)),
                     .limit = reach_turns(pulse.channel, phase)}};
}

/// Returns null when no turn is near, its revolution is closed, or its channel is unknown.
Revolution* Associator::revolution_of(const Pulse& pulse) {
  if (!phases_.knows(pulse.channel)) {
    return nullptr;
  }
  const auto& [turn, tested] = test_of(pulse);
  return tested.passed() ? open_revolution(turn) : nullptr;
}

/// Puts an edge into its revolution. Of two edges of one channel the nearer to its expectation
/// stays, unless they are copies and the earliest counts.
void Associator::put(Revolution& revolution, const Pulse& pulse,
                     const std::optional<EdgeGap>& spoilt_by, Association& out) {
  const auto turn = static_cast<double>(revolution.number);
  const double expected = turn + phases_.at(pulse.channel, turn);
  const auto off = [&](TaiTime t) { return std::abs(clock_->phase_turns(t) - expected); };
  std::optional<TaiTime>& edge = revolution.edges.at(index_of(pulse.channel));
  std::optional<EdgeGap>& gap = revolution.edge_gaps.at(index_of(pulse.channel));
  if (edge) {
    const Pulse earlier{.t = *edge, .channel = pulse.channel};
    const double apart_s = elapsed_s(earlier.t, pulse.t);
    const bool copied = is_copy(pulse, apart_s);
    const bool earlier_counts =
        off(earlier.t) <= off(pulse.t) || (copied && earliest_counts(revolution, earlier));
    bool& has_copy = revolution.has_copy.at(index_of(pulse.channel));
    has_copy = has_copy || apart_s <= kCopies_turns * clock_->period_s();
    if (copied) {
      copies_.note_choice(pulse.channel, !earlier_counts);
    }
    if (earlier_counts) {
      leave_over(pulse, spoilt_by, apart_s, out);
      return;
    }
    leave_over(earlier, gap, apart_s, out);
  }
  edge = pulse.t;
  gap = spoilt_by;
  revolution.edge_rejections.at(index_of(pulse.channel)) =
      spoilt_by ? std::optional{Rejection::Interference} : std::nullopt;
}

/// Tells whether the earliest copy counts although a later one lies nearer to the expectation. It
/// does where it is within the limits; where the copies are too close to matter; where they come in
/// any order, since all channels are then early by the same amount and no limit of one channel may
/// cut that; and where this channel has followed the later of two receivers and others the earlier.
bool Associator::earliest_counts(const Revolution& revolution, const Pulse& earliest) const {
  const PulseChannel channel = earliest.channel;
  return !copies_.are_apart(channel, edge_sigma_s(config_.noise, channel)) ||
         noise_chose_among_copies_ || copies_.disagree_with_others(channel) ||
         is_expected(revolution, earliest);
}

/// Tells whether the edge lies within the limits of its expectation in that revolution.
bool Associator::is_expected(const Revolution& revolution, const Pulse& pulse) const {
  const auto turn = static_cast<double>(revolution.number);
  if (pulse.channel != reference_) {
    return phases_
        .test(pulse.channel, revolution.number, clock_->phase_turns(pulse.t) - turn,
              clock_sigma_turns(turn))
        .passed();
  }
  return lies_within(reach_turns(reference_, turn), turn, pulse.t);
}

/// @param apart_s Time from another edge of its channel.
bool Associator::is_copy(const Pulse& pulse, double apart_s) const {
  return apart_s <= kCopies_turns * clock_->period_s() && copies_.are_usual(pulse.channel);
}

/// @param apart_s Time from the edge of its channel that counts.
void Associator::leave_over(const Pulse& pulse, const std::optional<EdgeGap>& spoilt_by,
                            double apart_s, Association& out) {
  PulseUse use = spoilt_by ? spoilt_use(pulse, *spoilt_by) : left_over(pulse);
  if (!spoilt_by && is_copy(pulse, apart_s)) {
    use.rejected_by = Rejection::Copy;
    use.gap = {.gap_s = apart_s, .least_s = kCopies_turns * clock_->period_s()};
    out.copies.push_back({.pulse = pulse, .apart_s = apart_s});
    noise_chose_among_copies_ =
        noise_chose_among_copies_ ||
        copies_.are_in_any_order(pulse.channel, edge_sigma_s(config_.noise, pulse.channel));
  }
  if (use.rejected_by == Rejection::Unassociated && phases_.knows(pulse.channel)) {
    tell_why_unassociated(use, apart_s);
  }
  out.left_over.push_back(use);
}

/// Adds what was found of an edge whose channel is known: it lies nowhere near its phase, or so
/// near to another edge of its channel that both cannot be of different turns.
/// @param apart_s Time from that edge.
void Associator::tell_why_unassociated(PulseUse& use, double apart_s) const {
  const DriftTest tested = test_of(use.pulse).tested;
  const EdgeGap gap{.gap_s = apart_s, .least_s = (1.0 - tested.limit) * clock_->period_s()};
  if (!tested.passed()) {
    use.said = observation(use.pulse, tested, clock_->period_s(), Rejection::Unassociated);
  } else if (gap.gap_s < gap.least_s) {
    use.gap = gap;
  }
}

/// Returns null when that revolution is closed or precedes the first.
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
  const double reach = std::max(kOpen_turns, phases_.latest(phase_turns)) + kChordGate_turns;
  while (!open_.empty() && phase_turns > static_cast<double>(open_.front().number) + reach) {
    close_front(out);
  }
}

void Associator::close_front(Association& out) {
  Revolution& revolution = open_.front();
  first_open_ = revolution.number + 1;
  revolution.count_sigma_turns = std::exchange(count_sigma_turns_, std::nullopt);
  const auto turn = static_cast<double>(revolution.number);
  const auto began =
      interfering_pairs_.expect(phases_, turn, clock_sigma_turns(turn), clock_->t_of(turn));
  out.began_to_interfere.insert(out.began_to_interfere.end(), began.begin(), began.end());
  judge_lone(revolution);
  judge_reference(revolution);
  judge_others(revolution);
  revolution.t_start = t_start_of(revolution);
  judge_neighbours(revolution);
  revolution.period_candidate = intervals_.candidate(
      revolution, reference_, [this](TaiTime t) { return period_at(t).period_s; });
  revolution.period = period_at(revolution.t_start);
  count_silence(revolution);
  phases_.keep_chords_near();
  phases_.end_revolution();
  out.closed.push_back(revolution);
  open_.pop_front();
}

/// Returns one sigma of the displacement by interference, turns. All edges of channels expected to
/// interfere have it: were it given to spoilt ones only, the channels would seem too far apart.
double Associator::displaced_turns(const Revolution& revolution, PulseChannel channel) const {
  const bool displaced =
      interfering_pairs_.gap_of(channel) || revolution.edge_rejections.at(index_of(channel));
  return displaced ? interfering_pairs_.displacement_s() / clock_->period_s() : 0.0;
}

/// Rejects an edge that came alone where copies usually lie apart, since it may be any of them.
void Associator::judge_lone(Revolution& revolution) const {
  for (const PulseChannel channel : kChannels) {
    std::optional<Rejection>& rejection = revolution.edge_rejections.at(index_of(channel));
    if (revolution.edge(channel) && !rejection && !revolution.has_copy.at(index_of(channel)) &&
        copies_.are_apart(channel, edge_sigma_s(config_.noise, channel))) {
      rejection = Rejection::Copy;
    }
  }
}

void Associator::judge_reference(Revolution& revolution) {
  const std::optional<TaiTime>& edge = revolution.edge(reference_);
  if (!edge || revolution.edge_rejections.at(index_of(reference_)) == Rejection::Copy) {
    return;
  }
  const auto turn = static_cast<double>(revolution.number);
  const double noise_s = std::hypot(edge_sigma_s(config_.noise, reference_),
                                    displaced_turns(revolution, reference_) * clock_->period_s());
  const DriftTest tested =
      clock_->follow(turn + phases_.at(reference_, turn), *edge, noise_s, reference_wander(),
                     {.sigma = config_.screening.sigma, .most = reach_turns(reference_, turn)});
  phases_.set_period(clock_->period_s());
  if (!tested.passed()) {
    // The clock tests its own phase at the edge, which is ahead where the edge came early.
    reject_phase(revolution, reference_,
                 DriftTest{.off = -tested.off, .sigma = tested.sigma, .limit = tested.limit});
  }
}

/// Rejects an edge that the clock has not expected there, unless it is rejected already.
/// @param tested Empty: no phase is expected of its channel.
void Associator::reject_phase(Revolution& revolution, PulseChannel channel,
                              const std::optional<DriftTest>& tested) const {
  std::optional<Rejection>& rejection = revolution.edge_rejections.at(index_of(channel));
  if (rejection) {
    return;
  }
  rejection = Rejection::Phase;
  if (tested) {
    revolution.edge_places.at(index_of(channel)) =
        observation({.t = *revolution.edge(channel), .channel = channel}, *tested,
                    clock_->period_s(), Rejection::Phase);
  }
}

void Associator::judge_others(Revolution& revolution) {
  const auto turn = static_cast<double>(revolution.number);
  const double clock_sigma = clock_sigma_turns(turn);
  for (const PulseChannel channel : kChannels) {
    const std::optional<TaiTime>& edge = revolution.edge(channel);
    if (!edge || channel == reference_ ||
        revolution.edge_rejections.at(index_of(channel)) == Rejection::Copy) {
      continue;
    }
    const double count = clock_->phase_turns(*edge);
    const double displaced = displaced_turns(revolution, channel);
    std::optional<DriftTest> tested;
    if (phases_.knows(channel)) {
      // Spoilt edges are followed too, since most edges of a channel may be spoilt.
      tested = phases_.follow(channel, revolution.number, count - turn,
                              std::hypot(clock_sigma, displaced));
    }
    if (!(tested && tested->passed()) && !phases_.stray(channel, count, displaced, clock_sigma)) {
      reject_phase(revolution, channel, tested);
    }
  }
}

/// Rejects the remaining edges of channels expected to interfere: they escaped by their noise, so
/// all of them lie too far from each other, and their mean is wrong.
void Associator::judge_neighbours(Revolution& revolution) const {
  for (const PulseChannel channel : kChannels) {
    std::optional<Rejection>& rejection = revolution.edge_rejections.at(index_of(channel));
    const std::optional<EdgeGap>& gap = interfering_pairs_.gap_of(channel);
    if (revolution.edge(channel) && !rejection && gap) {
      rejection = Rejection::Interference;
      revolution.edge_gaps.at(index_of(channel)) = gap;
    }
  }
}

/// Hands the clock over to sun1, or from an infrared channel to sun2, once that is fit, and to
/// another channel when the reference has long been silent.
void Associator::count_silence(const Revolution& revolution) {
  using enum PulseChannel;
  turns_without_reference_ = revolution.good_edge(reference_) ? 0 : turns_without_reference_ + 1;
  const auto is_fit = [&](PulseChannel channel) {
    // A channel is fit to set the clock after this many good edges in a row.
    return channel != reference_ && revolution.good_edge(channel) && phases_.in_a_row(channel) >= 3;
  };
  if (is_fit(Sun1)) {
    change_reference(Sun1, revolution.number);
  } else if (!sees_the_sun(reference_) && is_fit(Sun2)) {
    change_reference(Sun2, revolution.number);
  } else if (turns_without_reference_ >= 10) {
    // Another channel takes over after this many revolutions without a good reference edge.
    const auto* const fit = std::find_if(kChannels.begin(), kChannels.end(), is_fit);
    if (fit != kChannels.end()) {
      change_reference(*fit, revolution.number);
    }
  }
}

void Associator::change_reference(PulseChannel channel, std::int64_t turn) {
  const auto turn_d = static_cast<double>(turn);
  const bool was_the_earth = !sees_the_sun(reference_);
  // From here on the phase of the old reference is followed again.
  phases_.define(reference_, turn, phases_.at(reference_, turn_d));
  reference_ = channel;
  phases_.set_reference(channel);
  turns_without_reference_ = 0;
  rate_step_.forget();
  intervals_.begin_anew(edge_sigma_s(config_.noise, channel));
  const bool is_sun1 = channel == PulseChannel::Sun1;
  if (is_sun1 || (channel == PulseChannel::Sun2 && !sun1_known_)) {
    // The Sun stands still: phase and drift of its edge are the clock's errors.
    const double late_turns = phases_.at(channel, turn_d) - defined_phase_turns(config_, channel);
    const double drift = phases_.drift(channel);
    clock_->shift(turn, late_turns, drift);
    if (was_the_earth) {
      // Part of what was taken for the body's drift is the Earth's apparent motion.
      clock_->loosen(phases_.phase_sigma(channel, turn_d), phases_.drift_sigma(channel, turn_d),
                     kEarthAcceleration_per_s2);
    }
    phases_.shift(turn, late_turns, drift);
  }
  sun1_known_ = sun1_known_ || is_sun1;
}

TaiTime Associator::t_start_of(const Revolution& revolution) const {
  const PulseChannel channel = sun1_known_ ? PulseChannel::Sun1 : reference_;
  if (const auto edge = revolution.good_edge(channel)) {
    return *edge;
  }
  const auto turn = static_cast<double>(revolution.number);
  return clock_->t_of(turn + (sun1_known_ ? 0.0 : phases_.at(reference_, turn)));
}

}  // namespace spindrift
