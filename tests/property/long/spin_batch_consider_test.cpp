/// Misplaced sensors that the configuration does not mention: `batch` adds biases or not, and its
/// consider sigma covers the resulting errors.

#include <gtest/gtest.h>

#include <cmath>
#include <random>
#include <string>

#include "pipelines/ephemeris/sun.h"
#include "tests/support/wobbling_pass.h"

namespace spindrift::testing::spin_batch_consider_test {

constexpr int kPasses = 200;

/// Draws misplacements from the priors of the biases.
class Misplacements {
 public:
  explicit Misplacements(std::uint64_t seed) : rng_{seed} {}

  double of(SensorBias bias) { return prior_of(bias).sigma * normal_(rng_); }

 private:
  std::mt19937_64 rng_;
  std::normal_distribution<double> normal_;
};

void misplace(SpinTruth& truth, Misplacements& drawn) {
  truth.sun_sensor.slit_separation_rad += drawn.of(SlitSeparationBias);
  const double dihedral_rad = drawn.of(DihedralBias);
  truth.north->azimuth_rad += dihedral_rad;
  truth.south->azimuth_rad += dihedral_rad;
  truth.north->mount_angle_rad += drawn.of(NorthMountAngleBias);
  truth.south->mount_angle_rad += drawn.of(SouthMountAngleBias);
  truth.north->chord_excess_rad = drawn.of(NorthChordBias);
  truth.south->chord_excess_rad = drawn.of(SouthChordBias);
  const double higher_km = drawn.of(Co2HeightBias);
  truth.horizon.equatorial_km += higher_km;
  truth.horizon.polar_km += higher_km;
  const double x_rad = drawn.of(ConingX);
  const double y_rad = drawn.of(ConingY);
  truth.motion.coning = {.tilt_rad = std::hypot(x_rad, y_rad),
                         .azimuth_rad = std::atan2(y_rad, x_rad)};
}

/// Shifts sun2 as a calibration for another sun angle theta does, by asin(cot theta tan I).
void misjudge_sun_angle(const SpinTruth& truth, double bias_rad, std::vector<PassEdge>& edges) {
  const double sun_angle_rad =
      std::acos(truth.motion.axis_icrf.dot(geometric_sun_icrf_km(truth.start).normalized()));
  const auto late_rad = [&](double angle_rad) {
    return std::asin(std::tan(truth.sun_sensor.slit_cant_rad) / std::tan(angle_rad));
  };
  const double later_s =
      (late_rad(sun_angle_rad + bias_rad) - late_rad(sun_angle_rad)) / truth.motion.rate_rad_s;
  for (PassEdge& edge : edges) {
    if (edge.pulse.channel == PulseChannel::Sun2) {
      edge.pulse.t = shifted(edge.pulse.t, later_s);
    }
  }
}

TEST(SpinBatchConsider, ItsSigmaIsTheErrorThatSensorsOutOfPlaceMake) {
  WobblingPasses passes{2011, 60.0};
  Misplacements drawn{2012};
  double squares = 0.0;
  double sigma_squares = 0.0;
  for (int pass = 0; pass < kPasses; ++pass) {
    SpinTruth truth = passes.drawn();
    misplace(truth, drawn);
    auto edges = passes.edges(truth);
    misjudge_sun_angle(truth, drawn.of(SunAngleBias), edges);
    const BatchSolution solution = passes.solution(edges);
    const double error_rad2 = axis_error(solution, truth).rad2;
    squares += error_rad2 / std::pow(solution.consider_sigma_rad, 2);
    sigma_squares += error_rad2 / solution.estimate.covariance_rad2.trace();
  }
  RecordProperty("squares a pass", std::to_string(squares / kPasses));
  RecordProperty("squares a pass by sigma", std::to_string(sigma_squares / kPasses));
  // The 95 % band if the error lies in one direction: chi-square, one degree of freedom a pass.
  EXPECT_NEAR(squares / kPasses, 1.0, 1.96 * std::sqrt(2.0 / kPasses));
}

}  // namespace spindrift::testing::spin_batch_consider_test
