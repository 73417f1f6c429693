/// @file
/// Association: which edge belongs to which revolution, and which is accepted; by spin phase, never
/// by the order of arrival.
///
/// A clock counts spin phase in turns from the sun1 edges; where sun1 is silent, from those of
/// another channel. Each channel is expected at its own phase, learnt from edges that agree and
/// followed as the Earth moves; an edge belongs to the revolution whose expected phase it is
/// nearest to. So a chord that straddles the next sun1, or hovers about it, stays with one
/// revolution. An edge further from its expectation than the screening's sigmas is kept with its
/// revolution and rejected. After a silence too long for the clock to say what turn it is, it
/// starts afresh, and the count goes on from the best guess. When the edges of a channel agree on
/// another phase (the Earth moved during a silence, the spin rate stepped), that one is adopted.
///
/// Of copies the earliest counts that lies where it is expected: of those within the noise of each
/// other the nearest would be chosen by what came before it, and their errors would not average
/// out.

#pragma once

#include <cstdint>
#include <deque>
#include <optional>
#include <vector>

#include "pipelines/spin/association/copies.h"
#include "pipelines/spin/association/expected_phases.h"
#include "pipelines/spin/association/interfering_pairs.h"
#include "pipelines/spin/association/period_intervals.h"
#include "pipelines/spin/association/rate_step.h"
#include "pipelines/spin/association/spin_clock.h"
#include "pipelines/spin/types/config.h"
#include "pipelines/spin/types/products.h"
#include "pipelines/spin/types/pulse.h"
#include "pipelines/spin/types/revolution.h"

namespace spindrift {

struct Association {
  std::vector<Revolution> closed;                            ///< In order of number.
  std::vector<PulseUse> left_over;                           ///< Edges that found no place.
  std::vector<CopiedEdge> copies = {};                       ///< Of those.
  std::vector<InterferingChannels> began_to_interfere = {};  ///< In this pass for the first time.
};

class Associator {
 public:
  explicit Associator(const SpinConfig& config);

  /// @param pulse Not earlier than the one before.
  Association push(const Pulse& pulse);

  /// An edge that one of another channel has spoilt: it is not to be used, but says about where its
  /// channel is.
  Association push_spoilt(const Pulse& pulse);

  /// What the spacecraft itself says of its period (coded telemetry), before the edges of that
  /// frame: a pass of a few frames needs no more to start the clock, and the value is tested as the
  /// revolution's candidate where no interval ends at its sun1.
  void note_period(TaiTime t_sun1, double period_s);

  /// The pass has ended: closes what is open.
  Association finish();

  /// So far in the pass.
  const std::vector<InterferingChannels>& interfering() const {
    return interfering_pairs_.interfering();
  }
  /// Likewise: which of several edges counted was left to noise.
  bool noise_chose_among_copies() const { return noise_chose_among_copies_; }

 private:
  /// The turn whose edge a pulse is nearest to, and whether it is near enough to be that.
  struct Count {
    std::int64_t turn;
    bool near;
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
  bool is_good_reference(const Pulse& pulse) const;
  void restart_after_step(const Pulse& pulse);
  void place(const Pulse& pulse, bool spoilt, Association& out);
  Count count_of(const Pulse& pulse) const;
  Revolution* revolution_of(const Pulse& pulse);
  void put(Revolution& revolution, const Pulse& pulse, std::optional<Rejection> spoilt_by,
           Association& out);
  bool is_expected(const Revolution& revolution, const Pulse& pulse) const;
  bool earliest_counts(const Revolution& revolution, const Pulse& earliest) const;
  bool is_copy(const Pulse& pulse, double apart_s) const;
  void leave_over(const Pulse& pulse, std::optional<Rejection> spoilt_by, double apart_s,
                  Association& out);
  Revolution* open_revolution(std::int64_t number);
  void close_before(double phase_turns, Association& out);
  void close_front(Association& out);
  double displaced_turns(const Revolution& revolution, PulseChannel channel) const;
  void judge_lone(Revolution& revolution) const;
  void judge_reference(Revolution& revolution);
  void judge_others(Revolution& revolution);
  void judge_neighbours(Revolution& revolution) const;
  void count_silence(const Revolution& revolution);
  void change_reference(PulseChannel channel, std::int64_t turn);
  TaiTime t_start_of(const Revolution& revolution) const;

  double reference_wander() const;
  SpinPeriod period_at(TaiTime t) const;
  double reach_turns(PulseChannel channel, double phase_turns) const;

  SpinConfig config_;
  std::vector<Pulse> waiting_;  ///< Until the period is known.

  std::optional<SpinClock> clock_;
  std::optional<SpinClock> lost_clock_;          ///< Before a silence too long for it.
  std::optional<double> count_sigma_turns_;      ///< For the revolution that closes next.
  PulseChannel reference_ = PulseChannel::Sun1;  ///< The channel that sets the clock.
  bool sun1_known_ = false;                      ///< Phase 0 is where sun1 is.
  int turns_without_reference_ = 0;
  RateStepDetector rate_step_;
  std::deque<Pulse> recent_;  ///< The last, without copies.
  Copies copies_;
  bool noise_chose_among_copies_ = false;
  ExpectedPhases phases_;
  InterferingPairs interfering_pairs_;
  PeriodIntervals intervals_;

  std::deque<Revolution> open_;  ///< In order of number; only those with an edge.
  std::int64_t first_open_ = 0;  ///< Revolutions before this one are closed.
};

}  // namespace spindrift
