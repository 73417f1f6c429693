/// @file
/// Association: decides by spin phase, never by order of arrival, which edge belongs to which
/// revolution and which is accepted.
///
/// A clock counts spin phase in turns from the sun1 edges, or from those of another channel while
/// sun1 is silent. Each channel is expected at its own phase, which is learnt from edges that agree
/// and followed as the Earth moves; an edge belongs to the revolution with the nearest expected
/// phase. So a chord that straddles or hovers about the next sun1 stays with one revolution. An
/// edge further from its expectation than the screening limit is kept and rejected. After a silence
/// too long for the clock to tell which turn it is, the clock starts afresh and counts on from the
/// best guess. When the edges of a channel agree on another phase (the Earth moved during a
/// silence, the spin rate stepped), that phase is adopted.
///
/// Of several copies of an edge, the earliest that lies where it is expected counts. Taking the
/// copy nearest to its expectation would depend on the edges before it, and errors would not
/// average out.

#pragma once

#include <cstdint>
#include <deque>
#include <optional>
#include <vector>

#include "pipelines/spin/association/copies.h"
#include "pipelines/spin/association/expected_phases.h"
#include "pipelines/spin/association/interfering_pairs.h"
#include "pipelines/spin/association/period_intervals.h"
#include "pipelines/spin/association/period_search.h"
#include "pipelines/spin/association/spin_clock.h"
#include "pipelines/spin/types/config.h"
#include "pipelines/spin/types/products.h"
#include "pipelines/spin/types/pulse.h"
#include "pipelines/spin/types/revolution.h"

namespace spindrift {

struct Association {
  std::vector<Revolution> closed;                            ///< Closed revolutions, by number.
  std::vector<PulseUse> left_over;                           ///< Edges placed in no revolution.
  std::vector<CopiedEdge> copies = {};                       ///< Copies among `left_over`.
  std::vector<InterferingChannels> began_to_interfere = {};  ///< Pairs new in this pass.
};

class Associator {
 public:
  explicit Associator(const SpinConfig& config);

  /// Places an edge, or keeps it until the clock has started.
  /// @param pulse Not earlier than the previous pulse.
  Association push(const Pulse& pulse);

  /// Takes an edge spoilt by another channel: it is rejected, but shows roughly where its own is.
  Association push_spoilt(const Pulse& pulse, const EdgeGap& spoilt_by);

  /// Takes the spin period that coded telemetry states, before the edges of its frame. It lets the
  /// clock start in a pass of a few frames, and is the period candidate where no interval ends at
  /// its sun1.
  void note_period(TaiTime t_sun1, double period_s);

  /// Ends the pass and closes the open revolutions.
  Association finish();

  /// Returns the pairs that have interfered so far in the pass.
  const std::vector<InterferingChannels>& interfering() const {
    return interfering_pairs_.interfering();
  }
  /// Tells whether noise has decided, so far in the pass, which of several copies counted.
  bool noise_chose_among_copies() const { return noise_chose_among_copies_; }

 private:
  /// The turn with the expected edge nearest to a pulse, and whether it is near enough to be it.
  struct TurnTest {
    std::int64_t turn;
    DriftTest tested;  ///< Phase test, turns.
  };

  void place_or_wait(const Pulse& pulse, Association& out);
  void try_to_start(bool at_end, Association& out);
  void learn_phases();
  void give_up_clock(const Pulse& pulse, Association& out);
  double clock_sigma_turns(double phase_turns) const;
  bool counts(TaiTime t) const;
  std::vector<Pulse> telling_edges();
  void note_recent(const Pulse& pulse);
  bool is_of_all_channels(const PulseTrain& comb) const;
  bool others_keep_to_the_clock(const PulseTrain& comb, double off_turns, double phase_turns) const;
  bool lies_within(double most_turns, double turn, TaiTime t) const;
  bool is_good_reference(const Pulse& pulse) const;
  void restart_after_step(const Pulse& pulse);
  void place(const Pulse& pulse, const std::optional<EdgeGap>& spoilt_by, Association& out);
  TurnTest test_of(const Pulse& pulse) const;
  Revolution* revolution_of(const Pulse& pulse);
  void put(Revolution& revolution, const Pulse& pulse, const std::optional<EdgeGap>& spoilt_by,
           Association& out);
  bool is_expected(const Revolution& revolution, const Pulse& pulse) const;
  bool earliest_counts(const Revolution& revolution, const Pulse& earliest) const;
  bool is_copy(const Pulse& pulse, double apart_s) const;
  void leave_over(const Pulse& pulse, const std::optional<EdgeGap>& spoilt_by, double apart_s,
                  Association& out);
  void tell_why_unassociated(PulseUse& use, double apart_s) const;
  Revolution* open_revolution(std::int64_t number);
  void close_before(double phase_turns, Association& out);
  void close_front(Association& out);
  double displaced_turns(const Revolution& revolution, PulseChannel channel) const;
  void judge_lone(Revolution& revolution) const;
  void judge_reference(Revolution& revolution);
  void reject_phase(Revolution& revolution, PulseChannel channel,
                    const std::optional<DriftTest>& tested) const;
  void judge_others(Revolution& revolution);
  void judge_neighbours(Revolution& revolution) const;
  void count_silence(const Revolution& revolution);
  void change_reference(PulseChannel channel, std::int64_t turn);
  TaiTime t_start_of(const Revolution& revolution) const;

  double reference_wander() const;
  SpinPeriod period_at(TaiTime t) const;
  double reach_turns(PulseChannel channel, double phase_turns) const;

  SpinConfig config_;
  std::vector<Pulse> waiting_;  ///< Edges kept until the period is known.

  std::optional<SpinClock> clock_;
  std::optional<SpinClock> lost_clock_;          ///< Clock given up after a long silence.
  std::optional<double> count_sigma_turns_;      ///< Turn-count sigma for the next to close.
  PulseChannel reference_ = PulseChannel::Sun1;  ///< The channel that sets the clock.
  bool sun1_known_ = false;                      ///< Whether phase 0 is that of sun1.
  int turns_without_reference_ = 0;
  RateStepDetector rate_step_;
  std::deque<Pulse> recent_;  ///< The latest edges, without copies.
  Copies copies_;
  bool noise_chose_among_copies_ = false;
  ExpectedPhases phases_;
  InterferingPairs interfering_pairs_;
  PeriodIntervals intervals_;

  std::deque<Revolution> open_;  ///< Open revolutions with an edge, by number.
  std::int64_t first_open_ = 0;  ///< Revolutions before this one are closed.
};

}  // namespace spindrift
