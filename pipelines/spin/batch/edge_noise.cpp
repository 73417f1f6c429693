#include "pipelines/spin/batch/edge_noise.h"

#include <algorithm>
#include <array>
#include <cmath>
#include <iterator>
#include <vector>

#include "pipelines/statistics/significance.h"

namespace spindrift {
namespace {

double median_of(std::vector<double>& values) {
  const auto middle = values.begin() + std::ssize(values) / 2;
  std::nth_element(values.begin(), middle, values.end());
  return middle == values.end() ? 0.0 : *middle;
}

}  // namespace

PulseNoise noise_seen(const PassModel& model, std::span<const PassEdge> edges,
                      const SpinState& state) {
  std::array<std::vector<double>, kPulseChannels> off;  // Residuals in sigmas.
  const PassAtState at = model.at(state);
  for (const PassEdge& edge : edges) {
    if (const auto met = at.meet(edge.pulse)) {
      off.at(index_of(edge.pulse.channel)).push_back(met->off_rad / met->sigma_rad);
    }
  }
  std::vector<double> of_slits;
  std::vector<double> of_beams;
  for (std::size_t channel = 0; channel < kPulseChannels; ++channel) {
    const double median = median_of(off.at(channel));
    std::vector<double>& deviations =
        sees_the_sun(static_cast<PulseChannel>(channel)) ? of_slits : of_beams;
    std::transform(off.at(channel).begin(), off.at(channel).end(), std::back_inserter(deviations),
                   [median](double value) { return std::abs(value - median); });
  }
  const auto times_stated = [](std::vector<double>& deviations) {
    return std::max(1.0, median_of(deviations) / kMedianDeviation);
  };
  const PulseNoise& stated = model.config().noise;
  return {.sun_s = stated.sun_s * times_stated(of_slits),
          .infrared_s = stated.infrared_s * times_stated(of_beams),
          .grid_s = stated.grid_s};
}

}  // namespace spindrift
