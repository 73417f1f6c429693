#include "pipelines/three_axis/innovation_record.h"

#include <algorithm>
#include <array>
#include <cmath>
#include <cstddef>

#include "pipelines/statistics/distributions.h"
#include "pipelines/statistics/significance.h"
#include "pipelines/statistics/variance_factor.h"

namespace spindrift {
namespace {

// Weight of one sample in the share of rejected ones; a sensor of which every tenth sample is bad
// does not come near the limit by chance, one that is rejected altogether reaches it at the tenth.
constexpr double kRecent = 0.05;
constexpr double kMany = 0.4;
constexpr double kFewestSamples = 5.0;
// Of so many the mean squared innovation says whether the noise is as stated.
constexpr double kMostFreedoms = 900.0;
constexpr double kFewestFreedoms = 30.0;

}  // namespace

double innovation_gate(int freedom) {
  static const std::array<double, 4> kGates = {0.0, chi_square_beyond(kContradictionChance, 1.0),
                                               chi_square_beyond(kContradictionChance, 2.0),
                                               chi_square_beyond(kContradictionChance, 3.0)};
  return kGates.at(static_cast<std::size_t>(freedom));
}

void InnovationRecord::note(bool was_rejected) {
  samples_ += 1.0;
  rejected_share_ +=
      std::max(kRecent, 1.0 / samples_) * ((was_rejected ? 1.0 : 0.0) - rejected_share_);
}

void InnovationRecord::accepted(double squared_innovation, int freedom) {
  note(false);
  freedoms_ = std::min(freedoms_ + freedom, kMostFreedoms);
  squared_innovation_ += (squared_innovation - freedom * squared_innovation_) / freedoms_;
}

void InnovationRecord::rejected() { note(true); }

bool InnovationRecord::many_rejected() const {
  return samples_ >= kFewestSamples && rejected_share_ > kMany;
}

double InnovationRecord::excess_noise() const {
  return freedoms_ >= kFewestFreedoms ? variance_factor(squared_innovation_, freedoms_) : 1.0;
}

}  // namespace spindrift
