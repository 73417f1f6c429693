/// @file
/// A pass of flight held against the ground model, as it arrives.

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

/// In the order of SpacecraftKind.
using GroundModel = std::variant<SpinModel, ThreeAxisModel>;

using GroundModels = std::map<std::string, std::shared_ptr<const GroundModel>>;  ///< By spacecraft.

/// From where on the model says something, and up to where.
struct ModelSpan {
  TaiTime from;
  TaiTime to;
};
ModelSpan span_of(const GroundModel& model);

/// The times of both are what they are told to be: an offset between the clocks of flight and model
/// is not looked for, and shows in the residuals.
// NOLINTNEXTLINE(bugprone-exception-escape): its variants always hold a value.
class ModelComparison {
 public:
  /// @param band_sigmas As DepartureWatch.
  ModelComparison(std::shared_ptr<const GroundModel> model, double band_sigmas);

  struct Compared {
    std::vector<ComparedSample> samples;
    ConditionChanges changes;  ///< About channels.
  };

  /// In the order of arrival. Nothing of what the model has no sensor of.
  template <class Sample>
  Compared see(const Sample& sample) {
    return judged(std::visit(
        [&](auto& comparison) -> std::vector<ComparedSample> {
          if constexpr (requires { comparison.see(sample); }) {
            return comparison.see(sample);
          } else {
            return {};
          }
        },
        comparison_));
  }
  /// No more arrives.
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
