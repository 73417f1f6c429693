/// @file
/// Comparison of the flight data of a pass with the ground model, as they arrive.

#pragma once

#include <map>
#include <memory>
#include <string>
#include <variant>
#include <vector>

#include "pipelines/ground_model/comparison/departure_watch.h"
#include "pipelines/ground_model/comparison/spin_comparison.h"
#include "pipelines/ground_model/comparison/three_axis_comparison.h"

namespace spindrift {

/// Holds the model of a spacecraft; the alternatives are in the order of SpacecraftKind.
using GroundModel = std::variant<SpinModel, ThreeAxisModel>;

/// Models by spacecraft.
using GroundModels = std::map<std::string, std::shared_ptr<const GroundModel>>;

/// Time span in which the model makes predictions.
struct ModelSpan {
  TaiTime from;
  TaiTime to;
};
ModelSpan span_of(const GroundModel& model);

/// Compares flight with the model. The time tags of both are taken as they are: a clock offset
/// between flight and model is not estimated, and shows in the residuals.
// NOLINTNEXTLINE(bugprone-exception-escape): its variants always hold a value.
class ModelComparison {
 public:
  /// @param band_sigmas Half-width of the band, in sigma of each residual.
  ModelComparison(std::shared_ptr<const GroundModel> model, double band_sigmas);

  /// Sets the band of what is compared from now on.
  void set_band(double band_sigmas) { watch_.set_band(band_sigmas); }

  struct Compared {
    std::vector<ComparedSample> samples;
    ConditionChanges changes;  ///< Departures of channels and their ends.
  };

  /// Compares a sample, in order of arrival; one of a sensor that the model lacks gives nothing.
  template <class Sample>
  Compared compare(const Sample& sample) {
    return judged(std::visit(
        [&](auto& comparison) -> std::vector<ComparedSample> {
          if constexpr (requires { comparison.compare(sample); }) {
            return comparison.compare(sample);
          } else {
            return {};
          }
        },
        comparison_));
  }
  /// Compares what is still held for reordering when no more samples arrive.
  Compared finish();

  std::vector<ChannelComparison> channels() const { return watch_.channels(); }

 private:
  using Comparison = std::variant<SpinComparison, ThreeAxisComparison>;
  static Comparison comparison_with(const GroundModel& model);
  static std::vector<ComparedChannel> channels_of(const Comparison& comparison);
  Compared judged(std::vector<ComparedSample> samples);

  std::shared_ptr<const GroundModel> model_;
  Comparison comparison_;
  DepartureWatch watch_;
};

}  // namespace spindrift
