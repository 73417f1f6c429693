/// @file
/// Comparison of a spinner's edges with those that the model's sensors see, in quantities that need
/// no absolute phase: no two spins stay in phase for long.
///
/// | channel | unit | what |
/// |---|---|---|
/// | `period` | s | from one edge of sun1 to the next |
/// | `sun2`, `north_in`, ... | deg | phase of the edge after sun1 in its revolution |
/// | `sun1` | | whether it comes |
///
/// Each revolution of flight is compared with the model's that begins nearest to it in time.

#pragma once

#include <array>
#include <optional>
#include <vector>

#include "pipelines/core/expected.h"
#include "pipelines/ephemeris/orbit.h"
#include "pipelines/ground_model/comparison/departure_watch.h"
#include "pipelines/ground_model/link/pulse_link.h"
#include "pipelines/ground_model/sensors/spin_edges.h"
#include "pipelines/spin/telemetry_order/pulse_reorder_window.h"

namespace spindrift {

/// Holds a revolution of the model, from an edge of sun1 to the next.
struct ModelRevolution {
  double t_s;  ///< Time since the start of the model.
  double period_s;
  /// First edge of each channel after sun1, in [0, 1) of the period; empty: there is none.
  std::array<std::optional<double>, kPulseChannels> turns;
};

struct SpinModel {
  TaiTime start;
  PulseNoise noise;                          ///< Noise by which flight is judged; above 0.
  double resolution_s;                       ///< Resolution of the intervals in coded frames.
  std::vector<ModelRevolution> revolutions;  ///< Revolutions in order of time; at least one.
};

/// @return Errors of SpinEdges; InvalidConfiguration where there is no noise, or no revolution.
Expected<SpinModel> spin_model(const SpinTruth& truth, const PulseLink& link, double resolution_s,
                               const Orbit& orbit, double duration_s);

/// Compares pulses or coded frames, in about the order of their times. Both tell the same, so only
/// the kind that comes first is used. Each interval between edges of sun1 of up to one and a half
/// of the model's periods is taken for a revolution, so that a spurious edge departs from the model
/// once. In a longer one an edge of sun1 is missing.
class SpinComparison {
 public:
  /// @param model Must outlive this object.
  explicit SpinComparison(const SpinModel& model);

  std::vector<ComparedChannel> channels() const;

  std::vector<ComparedSample> compare(const Pulse& pulse);
  std::vector<ComparedSample> compare(const CodedFrame& frame);
  /// Compares what is still held for reordering when no more samples arrive.
  std::vector<ComparedSample> finish();

 private:
  /// Revolution of flight, from an edge of sun1 to the next.
  struct Revolution {
    TaiTime t;
    std::vector<Pulse> edges;  ///< Edges in order of time, without those of sun1.
  };
  using Samples = std::vector<ComparedSample>;

  void see_in_order(const Pulse& pulse, Samples& all);
  void see_in_order(const CodedFrame& frame, Samples& all);
  void begin(Revolution next, Samples& all);
  void compare(const Revolution& revolution, TaiTime end, Samples& all);
  void note_missing_sun(TaiTime t, Samples& all);
  std::optional<std::size_t> place_near(TaiTime t) const;
  std::optional<double> turns_at(std::size_t place, PulseChannel channel) const;
  ComparedValue phase(PulseChannel channel, double turns, double model_turns,
                      double period_s) const;

  const SpinModel* model_;
  std::array<std::optional<std::size_t>, kPulseChannels> channel_of_;
  std::vector<PulseChannel> compared_;  ///< Channels after `period`, in the order of `channels()`.
  ReorderWindow pulses_;
  FrameReorderWindow frames_;
  std::optional<bool> is_coded_;
  std::optional<Revolution> open_;
  std::optional<TaiTime> first_;  ///< Time of the first edge, until one of sun1 has come.
};

}  // namespace spindrift
