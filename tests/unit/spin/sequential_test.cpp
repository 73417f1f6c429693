#include "pipelines/spin/sequential.h"

#include <gtest/gtest.h>
#include <cmath>
#include <numbers>
#include <chrono>
#include <random>

#include "pipelines/frames/celestial.h"
#include "tests/support/observed_spin.h"
#include "tests/support/recorded_pass.h"

namespace spindrift {
namespace {
constexpr double kDegree_rad = std::numbers::pi / 180.0;

TEST(Sequential, Probe) {
  for (const std::string name : {"nominal", "gms5", "dirty_probe"}) {
    for (const double off_deg : {0.0, 0.5, 3.0}) {
    auto pass = testing::recorded_pass(name);
    pass.config.horizon.model = name=="nominal"?HorizonModel::Sphere:HorizonModel::Ellipsoid;
    const auto revolutions = testing::observed(pass.config, pass.orbit, pass.pulses);
    std::mt19937_64 rng{1};
    SpinFix fix = testing::drawn_fix(pass.true_axis_icrf, off_deg * kDegree_rad, rng);
    fix.covariance_rad2 = std::pow(5.0 * kDegree_rad, 2) * Eigen::Matrix2d::Identity();
    SequentialEstimator e{pass.config};
    int i = 0;
    std::span<const SpinFix> f{&fix, 1};
    for (const auto& [revolution, sky] : revolutions) {
      const auto est = e.update(revolution, sky, f);
      f = {};
      if (i < 4 || i == 100 || i + 1 == static_cast<int>(revolutions.size())) {
        printf("%s off %.1f rev %d error %.4f sigma %.4f rate %g (%g) %s\n", name.c_str(), off_deg, i,
               angle_between_rad(est->axis_icrf, pass.true_axis_icrf) / kDegree_rad,
               std::sqrt(est->covariance_rad2.trace()) / kDegree_rad, est->spin_rate_rad_s - pass.true_rate_rad_s,
               est->spin_rate_sigma_rad_s, est->status.c_str());
      }
      ++i;
    }
    if (off_deg == 0.5) {
      const auto t0 = std::chrono::steady_clock::now();
      for (int k = 0; k < 20; ++k) {
        SequentialEstimator timed{pass.config};
        f = {&fix, 1};
        for (const auto& [revolution, sky] : revolutions) {
          timed.update(revolution, sky, f);
          f = {};
        }
      }
      printf("%.3f us a revolution\n", std::chrono::duration<double>(std::chrono::steady_clock::now() - t0).count() * 1e6 / 20 / static_cast<double>(revolutions.size()));
    }
    }
  }
}
}  // namespace
}  // namespace spindrift
