#include "pipelines/three_axis/alignment_evidence.h"

#include <algorithm>
#include <cmath>

#include "pipelines/statistics/distributions.h"
#include "pipelines/statistics/significance.h"

namespace spindrift {
namespace {

/// Returns the chi-square that this many numbers exceed as rarely as one exceeds 4 sigma.
double far_off(double freedom) {
  static const double chance = chi_square_tail(kFarOffPriorSigmas * kFarOffPriorSigmas, 1.0);
  return chi_square_beyond(chance, std::max(freedom, 1.0));
}

}  // namespace

/// Where the errors are as stated, the covariance of their estimate is what the innovations have
/// taken from the stated one. What they have taken next to nothing from does not count.
std::optional<ErrorBeyond> error_beyond(const FilterErrors& estimate, const FilterAlignment& prior,
                                        const FilterAlignment& left) {
  std::optional<ErrorBeyond> most;
  const auto see = [&]<int kCount>(std::string_view key, int first) {
    using Covariance = Eigen::Matrix<double, kCount, kCount>;
    const Eigen::Matrix<double, kCount, 1> off = estimate.segment<kCount>(first);
    if (off.isZero(0.0)) {
      return;
    }
    const Covariance stated = prior.block<kCount, kCount>(first, first);
    const Covariance shown = stated - left.block<kCount, kCount>(first, first);
    const Covariance little = 1e-2 * stated.trace() / kCount * Covariance::Identity();
    const Eigen::LDLT<Covariance> solver{shown + little};
    const double square = off.dot(solver.solve(off));
    if (square <= kFarOffPriorSigmas * kFarOffPriorSigmas ||
        square <= far_off(solver.solve(shown).trace())) {
      return;
    }
    const double sigmas = std::sqrt(off.dot((stated + little).ldlt().solve(off)));
    if (!most || sigmas > most->sigmas) {
      most = ErrorBeyond{.key = key, .sigmas = sigmas};
    }
  };
  see.operator()<3>("star_tracker_deg", StarTrackerError);
  see.operator()<3>("sun_sensor_deg", SunSensorError);
  see.operator()<3>("magnetometer_deg", MagnetometerError);
  see.operator()<3>("magnetometer_bias_nt", MagnetometerBiasError);
  see.operator()<3>("gyro_scale", GyroScaleError);
  see.operator()<6>("gyro_deg", GyroAxisError);
  see.operator()<3>("time_tag_s", StarTrackerTimeError);
  return most;
}

}  // namespace spindrift
