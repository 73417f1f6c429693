#include "pipelines/reconstruction/reconstruction_assessment.h"

#include <algorithm>
#include <string>
#include <utility>

#include "pipelines/frames/angle.h"
#include "pipelines/frames/uncertain_attitude.h"
#include "pipelines/statistics/significance.h"
#include "pipelines/three_axis/products.h"

namespace spindrift {
namespace {

using enum ReasonCode;

bool is_many(std::int64_t some, std::int64_t others, double share) {
  return static_cast<double>(some) > share * static_cast<double>(some + others);
}

class Doubts {
 public:
  /// Adds a reason if the count is positive.
  void count(ReasonCode code, std::int64_t count, bool is_doubt) {
    if (count > 0) {
      add({code, {{"count", count}}}, is_doubt);
    }
  }
  void add(Reason reason, bool is_doubt) {
    assessment.reasons.push_back(std::move(reason));
    if (is_doubt) {
      assessment.quality = Quality::Doubtful;
    }
  }

  Assessment assessment;
};

void add_sun(const Observations& all, const Reconstruction& result, Doubts& doubts) {
  const SensorResiduals& sun = result.sun;
  doubts.count(SunVectors, sun.count, false);
  doubts.count(SunOutliers, sun.outliers, is_many(sun.outliers, sun.count, kManyOutliers));
  doubts.count(SunVectorsShadowed, all.in_shadow, false);
  doubts.count(ShadowUnknown, all.shadow_unknown, false);
}

void add_gyro(const Observations& all, Doubts& doubts) {
  if (all.rates.gaps() > 0) {
    const double longest_s = all.rates.longest_gap_s();
    // In a long gap the body may turn and stop, which no sigma covers.
    doubts.add({GyroGaps, {{"count", all.rates.gaps()}, {"longest_s", longest_s}}},
               longest_s > 10.0);
  }
  doubts.count(GyroSaturated, all.gyro_left_out_by(Rejection::Saturated), true);
  doubts.count(GyroFrozen, all.gyro_left_out_by(Rejection::Frozen), true);
  const std::int64_t outliers = all.gyro_left_out_by(Rejection::Outlier);
  doubts.count(GyroOutliers, outliers,
               all.first_is_outlier || is_many(outliers, all.gyro_samples, kManyOutliers));
}

void add_noise(const char* sensor, const SensorResiduals& residuals, Doubts& doubts) {
  if (residuals.noise && *residuals.noise > kLouder) {
    doubts.add({SensorNoise, {{"sensor", sensor}, {"factor", *residuals.noise}}}, true);
  }
}

void add_bias(const GyroSensor& gyro, const Reconstruction& result, const FittedFile& file,
              Doubts& doubts) {
  for (const OpenBiasDirection& open : result.open_bias) {
    std::vector<NamedValue> values{{"sigma_deg_s", degrees(open.sigma_rad_s)}};
    if (open.off_sun_rad) {
      values.push_back({"off_sun_deg", degrees(*open.off_sun_rad)});
    }
    doubts.add({open.off_sun_rad ? GyroBiasOpenBySun : GyroBiasOpen, std::move(values)}, false);
  }
  if (result.bias &&
      (result.bias->rad_s + file.change.segment<3>(SharedGyroBias)).cwiseAbs().maxCoeff() >
          kFarOffPriorSigmas * gyro.bias_sigma_rad_s) {
    doubts.add({GyroBiasFarOff, {{"prior_sigmas", kFarOffPriorSigmas}}}, true);
  }
}

}  // namespace

Assessment assess(const ReconstructionRequest& request, const Observations& all,
                  const Reconstruction& result, const StarConsensus& stars,
                  const FittedFile& file) {
  const bool unchecked = result.sun.count == 0 && result.star.count == 1;
  Doubts doubts{.assessment = {unchecked ? Quality::Converging : Quality::Ok}};
  doubts.count(StarFixes, result.star.count, false);
  const std::int64_t gated = std::ssize(stars.gated());
  doubts.count(StarFixesGated, gated, is_many(gated, std::ssize(stars.accepted), 1.0 / 3.0));
  if (stars.contradict) {
    doubts.add({StarFixesContradict}, true);
  }
  add_sun(all, result, doubts);
  add_gyro(all, doubts);
  add_noise("gyro", result.gyro, doubts);
  add_noise("sun", result.sun, doubts);
  add_noise("star", result.star, doubts);
  add_bias(*request.sensors.gyro, result, file, doubts);
  if (file.beyond) {
    doubts.add({AlignmentOff,
                {{"key", "three_axis.alignment." + std::string{file.beyond->key}},
                 {"sigmas", file.beyond->sigmas}}},
               true);
  }
  const ReconstructedAttitude& separation = result.events.front().attitude;
  if (!request.sensors.inertia && separation.t < all.origin) {
    doubts.add({ConstantRate}, false);
  }
  const double open_rad = separation.sigma_rad();
  if (!(open_rad < kOpen_rad)) {
    doubts.add({AttitudeOpen, {{"deg", degrees(open_rad)}}}, true);
  }
  return std::move(doubts.assessment);
}

}  // namespace spindrift
