#include "pipelines/spin/fixes_by_case.h"

#include <algorithm>
#include <cmath>
#include <optional>
#include <vector>

namespace spindrift {

double most_shift_sigmas(double share) {
  const double left_out = 1.0 - share;
  if (!(left_out > 0.0)) {
    return 0.0;
  }
  return std::min(std::sqrt(-2.0 * std::log(share)),
                  left_out / share * std::sqrt(-2.0 * std::log(left_out)));
}

void FixesByCase::add(int geometry_case, const SpinConfig& config,
                      const RevolutionMeasurements& measured, const Sightlines& sightlines,
                      const Eigen::Vector3d& axis_icrf) {
  OfCase& fixes =
      cases_.try_emplace(geometry_case, OfCase{.equations = AngleEquations{reference_icrf_}})
          .first->second;
  fixes.equations.add(config, measured, sightlines, axis_icrf);
  ++fixes.count;
}

MeanOfCases FixesByCase::mean(const std::map<int, double>& left_out) const {
  struct Selection {
    const OfCase* fixes;
    double share;
  };
  std::vector<Selection> selections;
  for (const auto& [geometry_case, fixes] : cases_) {
    const auto missing = left_out.find(geometry_case);
    const auto settled = static_cast<double>(fixes.count);
    const double all = settled + (missing == left_out.end() ? 0.0 : missing->second);
    selections.push_back({.fixes = &fixes, .share = settled / all});
  }
  std::stable_sort(selections.begin(), selections.end(),
                   [](const Selection& a, const Selection& b) { return a.share > b.share; });
  AngleEquations equations{reference_icrf_};
  Eigen::Matrix2d shifts = Eigen::Matrix2d::Zero();
  Eigen::Matrix2d settled = Eigen::Matrix2d::Zero();
  std::size_t count = 0;
  std::optional<MeanOfCases> best;
  for (const auto& [fixes, share] : selections) {
    const Eigen::Matrix2d information = fixes->equations.normal().topLeftCorner<2, 2>();
    const double shift_sigmas = most_shift_sigmas(share);
    equations += fixes->equations;
    count += fixes->count;
    shifts += shift_sigmas * shift_sigmas * static_cast<double>(fixes->count) * information;
    settled += share * information;
    const Eigen::Matrix2d noise_rad2 = equations.covariance_rad2();
    const Eigen::Matrix2d covariance_rad2 = noise_rad2 + equations.scatter_rad2(shifts);
    if (!best || covariance_rad2.trace() < best->covariance_rad2.trace()) {
      best = MeanOfCases{
          .equations = equations,
          .covariance_rad2 = covariance_rad2,
          .count = count,
          .settled_share = equations.scatter_rad2(settled).trace() / noise_rad2.trace()};
    }
  }
  return *best;
}

}  // namespace spindrift
