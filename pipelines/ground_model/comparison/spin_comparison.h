/// @file
/// Edges of a spinner against those that the model's sensors see, in quantities that need no
/// absolute phase: no two spins stay in phase for long.
///
/// | channel | unit | what |
/// |---|---|---|
/// | `period` | s | from one edge of sun1 to the next |
/// | `sun2`, `north_in`, ... | deg | phase of the edge behind sun1, of the turn until the next sun1
/// | | `sun1` | | whether it comes |
///
/// Each revolution of flight is held against the model's that begins nearest to it in time.

#pragma once

#include <array>
#include <optional>
#include <vector>

#include "pipelines/core/expected.h"
#include "pipelines/ephemeris/orbit.h"
#include "pipelines/ground_model/comparison/compared_sample.h"
#include "pipelines/ground_model/link/pulse_link.h"
#include "pipelines/ground_model/sensors/spin_edges.h"
#include "pipelines/spin/telemetry_order/pulse_reorder_window.h"

namespace spindrift {

/// From an edge of sun1 to the next.
struct ModelRevolution {
  double t_s;  ///< Behind the start.
  double period_s;
  /// Of the channel's first edge behind sun1, [0, 1) of the period; empty: there is none.
  std::array<std::optional<double>, kPulseChannels> turns;
};

struct SpinModel {
  TaiTime start;
  PulseNoise noise;                          ///< By which flight is judged, above 0.
  double resolution_s;                       ///< Of intervals in coded frames.
  std::vector<ModelRevolution> revolutions;  ///< In order, one at least.
};

/// @return as SpinEdges; InvalidConfiguration where there is no noise, or no revolution.
Expected<SpinModel> spin_model(const SpinTruth& truth, const PulseLink& link, double resolution_s,
                               const Orbit& orbit, double duration_s);

/// Takes pulses or frames, in about the order of their times: whichever come first, since they tell
/// the same. Each interval between edges of sun1 of up to one and a half of the model's periods is
/// taken for a revolution: where an edge comes out of nothing it is away from the model, once. In a
/// longer one sun1 is missing.
class SpinComparison {
 public:
  /// @param model Outlives it.
  explicit SpinComparison(const SpinModel& model);

  std::vector<ComparedChannel> channels() const;

  std::vector<ComparedSample> see(const Pulse& pulse);
  std::vector<ComparedSample> see(const CodedFrame& frame);
  /// What is held to come in order: there is no more.
  std::vector<ComparedSample> finish();

 private:
  /// Of flight.
  struct Revolution {
    TaiTime t;
    std::vector<Pulse> edges;  ///< In order of time, without sun1.
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
  std::vector<PulseChannel> compared_;  ///< Behind `period`, in its order.
  ReorderWindow pulses_;
  FrameReorderWindow frames_;
  std::optional<bool> is_coded_;
  std::optional<Revolution> open_;
  std::optional<TaiTime> first_;  ///< Edge, while none of sun1 has come.
};

}  // namespace spindrift
