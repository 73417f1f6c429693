#include "pipelines/observation/innovation_gate.h"

#include <array>
#include <cstddef>

#include "pipelines/statistics/distributions.h"
#include "pipelines/statistics/significance.h"

namespace spindrift {

double innovation_gate(int freedom) {
  static const std::array<double, 4> kGates = {0.0, chi_square_beyond(kContradictionChance, 1.0),
                                               chi_square_beyond(kContradictionChance, 2.0),
                                               chi_square_beyond(kContradictionChance, 3.0)};
  return kGates.at(static_cast<std::size_t>(freedom));
}

}  // namespace spindrift
