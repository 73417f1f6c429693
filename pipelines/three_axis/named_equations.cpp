#include "pipelines/three_axis/named_equations.h"

#include <cstddef>

namespace spindrift {

NormalEquations named_equations(TaiTime t, std::span<const int> errors,
                                const Eigen::MatrixXd& information, const Eigen::VectorXd& score) {
  NormalEquations equations{
      .t = t, .names = {}, .b0 = Eigen::VectorXd::Zero(score.size()), .n = {}, .g = {}};
  Eigen::VectorXd units{score.size()};
  for (const int error : errors) {
    const auto& [name, unit] = kAttitudeAlignmentNames.at(static_cast<std::size_t>(error));
    units[static_cast<Eigen::Index>(equations.names.size())] = unit;
    equations.names.emplace_back(name);
  }
  equations.n = units.asDiagonal() * information * units.asDiagonal();
  equations.g = units.cwiseProduct(score);
  return equations;
}

}  // namespace spindrift
