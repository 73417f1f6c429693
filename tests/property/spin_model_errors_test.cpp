/// Passes of satellites that are not what their mission file says: the mean has an error that no
/// number of fixes reduces, and must not claim to be better than it is.

#include <gtest/gtest.h>

#include <cmath>
#include <functional>
#include <iostream>
#include <numbers>
#include <random>
#include <string>
#include <vector>

#include "pipelines/spin/spin_pass.h"
#include "tests/support/observed_spin.h"
#include "tests/support/product_text.h"
#include "tests/support/spinning_body.h"

namespace spindrift {
namespace {

constexpr double kDegree_rad = std::numbers::pi / 180.0;
constexpr double kRevolutions = 300.0;
constexpr int kBodies = 4;

/// What the mission file says differs from the body by so much.
struct Mistake {
  std::string name;
  std::function<void(SpinConfig& said)> make;
};

std::vector<Mistake> mistakes(double size_rad) {
  std::vector<Mistake> all;
  for (const double off_rad : {size_rad, -size_rad}) {
    const std::string by = " " + std::to_string(off_rad / kDegree_rad);
    all.push_back({"separation" + by, [off_rad](SpinConfig& said) {
                     said.sun_sensor.slit_separation_rad += off_rad;
                   }});
    all.push_back(
        {"cant" + by, [off_rad](SpinConfig& said) { said.sun_sensor.slit_cant_rad += off_rad; }});
    all.push_back({"north mounting angle" + by,
                   [off_rad](SpinConfig& said) { said.north->mount_angle_rad += off_rad; }});
    all.push_back({"south mounting angle" + by,
                   [off_rad](SpinConfig& said) { said.south->mount_angle_rad += off_rad; }});
    all.push_back({"north azimuth" + by,
                   [off_rad](SpinConfig& said) { said.north->azimuth_rad += off_rad; }});
    all.push_back({"south azimuth" + by,
                   [off_rad](SpinConfig& said) { said.south->azimuth_rad += off_rad; }});
  }
  return all;
}

struct Outcome {
  double sigmas;  ///< Error over what the mean states.
  double without_check;
  std::string status;
};

/// Every body with every mistake.
std::vector<Outcome> outcomes_of(double size_rad, double chord_excess_rad = 0.0) {
  const Orbit orbit = testing::transfer_orbit();
  const testing::Surroundings around =
      testing::seen_from(orbit, testing::spherical_horizon_km(40.0));
  std::mt19937_64 rng{77};
  std::vector<Outcome> outcomes;
  for (int i = 0; i < kBodies; ++i) {
    const testing::SpinningBody body = testing::random_body(around, 8.0 * kDegree_rad, rng);
    auto edges = testing::edges_between(body, around, 0.0,
                                        kRevolutions * 2.0 * std::numbers::pi / body.rate_rad_s);
    for (testing::Edge& edge : edges) {
      const double late_s = 0.5 * chord_excess_rad / body.rate_rad_s;
      edge.t_s += edge.channel == PulseChannel::NorthOut ? late_s : 0.0;
      edge.t_s -= edge.channel == PulseChannel::NorthIn ? late_s : 0.0;
    }
    const auto pulses =
        testing::pulses_from(edges, testing::kTransferStart, body.config.noise, rng);
    for (const Mistake& mistake : mistakes(size_rad)) {
      SpinConfig said = body.config;
      mistake.make(said);
      const SpinOutput output = testing::run(SpinPass{said, orbit}, pulses);
      const auto estimates = testing::all_of<SpinEstimate>(output);
      if (estimates.empty()) {
        continue;
      }
      const SpinEstimate mean = testing::last_estimate(output, SpinEstimator::Mean);
      const double error_rad = testing::error_rad(mean.axis_icrf, body.axis_icrf).norm();
      outcomes.push_back({.sigmas = error_rad / testing::sigma_rad(mean),
                          .without_check = error_rad,
                          .status = mean.status});
      std::cout << i << " " << mistake.name << ": " << error_rad / kDegree_rad << " / "
                << testing::sigma_rad(mean) / kDegree_rad << " " << mean.status << "\n";
    }
  }
  return outcomes;
}

TEST(SpinModelErrors, OneDegree) { outcomes_of(1.0 * kDegree_rad); }
TEST(SpinModelErrors, ThreeTenths) { outcomes_of(0.3 * kDegree_rad); }
TEST(SpinModelErrors, Chord) { outcomes_of(0.0, 0.3 * kDegree_rad); }

}  // namespace
}  // namespace spindrift
