#include "pipelines/frames/rotation_vector.h"
#include "pipelines/ground_model/flights/orientation_motion.h"
#include "tests/support/matchers.h"

namespace spindrift::gyro_propagation_test {

using Eigen::Vector3d;

/// Rotates about an axis that itself rotates; attitude and rate are known in closed form.
struct Coning {
  Vector3d outer_rad_s;
  Vector3d inner_rad_s;

  Eigen::Quaterniond q_icrf_body(double t_s) const {
    return quaternion_by(t_s * outer_rad_s) * quaternion_by(t_s * inner_rad_s);
  }
  Vector3d rate_rad_s(double t_s) const {
    return quaternion_by(-t_s * inner_rad_s) * outer_rad_s + inner_rad_s;
  }
};

constexpr double kEnd_s = 60.0;
const Coning kSteady{.outer_rad_s = {0.06, -0.08, 0.0}, .inner_rad_s = Vector3d::Zero()};
const Coning kConing{.outer_rad_s = {0.03, 0.0, 0.01}, .inner_rad_s = {0.0, 0.02, 0.05}};

Eigen::Quaterniond end_of(const Coning& motion, GyroPropagation by, int steps) {
  Eigen::Quaterniond q_icrf_body = Eigen::Quaterniond::Identity();
  const double step_s = kEnd_s / steps;
  for (int i = 0; i < steps; ++i) {
    q_icrf_body = propagated(by, q_icrf_body,
                             {.dt_s = step_s,
                              .from_rad_s = motion.rate_rad_s(i * step_s),
                              .to_rad_s = motion.rate_rad_s((i + 1) * step_s)});
  }
  return q_icrf_body;
}

double error_rad(const Coning& motion, GyroPropagation by, int steps) {
  return angle_between_rad(end_of(motion, by, steps), motion.q_icrf_body(kEnd_s));
}

TEST(GyroPropagation, LosesTheFifthPowerOfTheTurnAStepAboutAnAxisThatStays) {
  for (const int steps : {30, 60, 120}) {
    const double turn_rad = 0.1 * kEnd_s / steps;
    EXPECT_NEAR(error_rad(kSteady, GyroPropagation::RungeKutta, steps) /
                    (steps * std::pow(turn_rad, 5) / 1920.0),
                1.0, 0.01)
        << steps;
    EXPECT_LT(error_rad(kSteady, GyroPropagation::Composition, steps), 1e-14) << steps;
  }
}

TEST(GyroPropagation, ConvergesInSecondOrderWhereTheAxisGoesRound) {
  for (const GyroPropagation by : {GyroPropagation::Composition, GyroPropagation::RungeKutta}) {
    const double coarse_rad = error_rad(kConing, by, 120);
    const double fine_rad = error_rad(kConing, by, 240);
    EXPECT_NEAR(std::log2(coarse_rad / fine_rad), 2.0, 0.05);
    // The error of a step is h^3 / 12 of the second derivative of the rate, at most inner^2 outer.
    const double step_s = kEnd_s / 240;
    EXPECT_LT(fine_rad, step_s * step_s / 12.0 * kEnd_s * kConing.inner_rad_s.squaredNorm() *
                            kConing.outer_rad_s.norm());
  }
}

TEST(GyroPropagation, DiffersFromTheCompositionInFourthOrder) {
  const auto apart_rad = [](int steps) {
    return angle_between_rad(end_of(kConing, GyroPropagation::Composition, steps),
                             end_of(kConing, GyroPropagation::RungeKutta, steps));
  };
  EXPECT_NEAR(std::log2(apart_rad(60) / apart_rad(120)), 4.0, 0.1);
  EXPECT_LT(apart_rad(600), 1e-3 * error_rad(kConing, GyroPropagation::RungeKutta, 600));
}

}  // namespace spindrift::gyro_propagation_test
