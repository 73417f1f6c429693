/// @file
/// The pass of one spin-stabilised satellite: pulses in, products out. The one composition of the
/// spin pipeline, run alike live, offline and in replay.
///
///     pulse -> order of time -> revolution -> period -> measurements -> screening -> fix -> mean
///
/// The first revolutions are held back until there are enough of them to tell an outlier from a
/// level (kFirstRevolutions); from then on each is settled as it closes.

#pragma once

#include <cstdint>
#include <optional>
#include <set>
#include <string>
#include <vector>

#include "pipelines/core/expected.h"
#include "pipelines/ephemeris/orbit.h"
#include "pipelines/ephemeris/sun.h"
#include "pipelines/spin/association.h"
#include "pipelines/spin/coded_frame.h"
#include "pipelines/spin/config.h"
#include "pipelines/spin/disambiguation.h"
#include "pipelines/spin/mean_axis.h"
#include "pipelines/spin/measurement.h"
#include "pipelines/spin/products.h"
#include "pipelines/spin/reorder_window.h"
#include "pipelines/spin/screening.h"

namespace spindrift {

struct SpinOutput {
  std::vector<SpinProduct> products;  ///< In the order they arose.
  std::vector<std::string> notices;   ///< What a person should know; each said once a pass.
};

/// What `config` asks for and this version does not do yet, in words: nothing is ignored silently.
std::vector<std::string> settings_without_effect(const SpinConfig& config);

class SpinPass {
 public:
  static constexpr std::size_t kFirstRevolutions = 10;

  SpinPass(const SpinConfig& config, Orbit orbit);

  SpinOutput push(const Pulse& pulse);

  /// The same edges, timed on board.
  SpinOutput push(const CodedFrame& frame);

  /// The pass has ended: settles all that is still held.
  SpinOutput finish();

 private:
  /// A revolution with all that is needed to settle it.
  struct Candidate {
    Revolution revolution;
    RevolutionMeasurements measured;
    std::optional<Sightlines> sightlines;  ///< Empty where the orbit does not reach.
    std::vector<Residual> residuals;
  };

  void associate(const std::vector<Pulse>& pulses, SpinOutput& out);
  void take(Association association, SpinOutput& out);
  void consider(const Revolution& revolution, SpinOutput& out);
  void settle_first(SpinOutput& out);
  void settle(Candidate& candidate, SpinOutput& out);
  void announce_axis(const Candidate& candidate, SpinOutput& out);
  void announce(const Candidate& candidate, const SpinFix& found, SpinOutput& out);
  void predict(Candidate& candidate, const Eigen::Vector3d& axis_icrf);
  std::optional<Sightlines> sightlines_of(const RevolutionMeasurements& measured, TaiTime t,
                                          SpinOutput& out);
  static void leave_out(const Pulse& pulse, Rejection rejected_by, SpinOutput& out);
  void say_once(const std::string& notice, SpinOutput& out);
  SpinEstimate mean_estimate(const Candidate& candidate, TaiTime t) const;

  SpinConfig config_;
  Orbit orbit_;
  ApparentSun sun_;
  ReorderWindow reorder_;
  Associator associator_;
  std::vector<Candidate> first_;  ///< Held back; empty once settled.
  bool started_ = false;
  ScreeningWindow screening_;
  Disambiguator disambiguator_;
  AxisWindow recent_axes_;
  MeanAxis mean_axis_;
  bool orbit_missed_ = false;
  bool fix_missed_ = false;
  std::set<std::string> said_;
};

}  // namespace spindrift
