#include <gtest/gtest.h>

#include <Eigen/Geometry>
#include <algorithm>
#include <cmath>
#include <random>
#include <set>
#include <utility>
#include <vector>

#include "pipelines/frames/angle.h"
#include "pipelines/frames/celestial.h"
#include "pipelines/spin/fix/axis_candidates.h"
#include "tests/support/axis_scene.h"
#include "tests/support/normalised_square.h"

namespace spindrift::testing::axis_candidates_every_case_test {

using Scene = AxisScene;
using enum SpinQuantity;

/// Holds what is missing and the geometry case that remains.
struct Loss {
  std::set<PulseChannel> edges;
  std::set<SpinQuantity> quantities;
  int geometry_case;
};

const std::vector<Loss>& losses() {
  using enum PulseChannel;
  static const std::vector<Loss> all = {
      {{}, {}, 1},
      {{SouthIn}, {}, 2},
      {{NorthOut}, {}, 3},
      {{}, {NorthDihedral, SouthDihedral}, 1},
      {{SouthIn}, {NorthDihedral}, 2},
      {{NorthIn}, {SouthDihedral}, 3},
      {{Sun2}, {}, 4},
      {{Sun2, SouthIn}, {}, 5},
      {{Sun2, NorthIn}, {}, 6},
      {{Sun1}, {}, 7},
      {{Sun1, SouthOut}, {}, 5},
      {{Sun1, NorthOut}, {}, 6},
  };
  return all;
}

Revolution without(Revolution revolution, const std::set<PulseChannel>& edges) {
  for (const PulseChannel channel : edges) {
    revolution.edges.at(index_of(channel)).reset();
  }
  return revolution;
}

/// Returns a body with any axis; Sun and Earth are where its sensors see them.
Scene random_scene(HorizonModel model, std::mt19937_64& rng) {
  std::normal_distribution<double> normal;
  std::uniform_real_distribution<double> uniform{-1.0, 1.0};
  const auto direction = [&] { return random_direction(normal, rng); };
  Scene scene{.earth = model};
  scene.config.horizon.model = model;
  scene.axis_icrf = direction();
  const auto away = [&](double angle_deg) -> Eigen::Vector3d {
    return Eigen::AngleAxisd{angle_deg * kRadPerDeg,
                             scene.axis_icrf.cross(direction()).normalized()} *
           scene.axis_icrf;
  };
  scene.sun_icrf = away(90.0 + 35.0 * uniform(rng));
  scene.earth_icrf = away(90.0 + 10.0 * uniform(rng));
  // The noise is small enough for linearity but above the resolution of 1 ns.
  scene.config.noise = {.sun_s = 2e-6, .infrared_s = 2e-6};
  return scene;
}

class EveryCase : public ::testing::TestWithParam<HorizonModel> {};

TEST_P(EveryCase, HasTheTrueAxisAmongItsCandidates) {
  constexpr int kScenes = 200;
  for (const Loss& loss : losses()) {
    std::mt19937_64 rng{92};
    int found_true = 0;
    for (int trial = 0; trial < kScenes; ++trial) {
      SCOPED_TRACE(loss.geometry_case * 1000 + trial);
      const Scene scene = random_scene(GetParam(), rng);
      const RevolutionMeasurements measured =
          measured_without(scene.config, without(scene.seen(), loss.edges), loss.quantities);
      ASSERT_EQ(geometry_case_of(measured), loss.geometry_case);
      const auto found = axis_candidates(scene.config, measured, scene.sun_earth());
      if (!found) {
        ASSERT_FALSE(found.error().contradictory);
        continue;
      }
      ASSERT_LE(found->candidates.size(), 4U);
      ASSERT_EQ(found->geometry_case, loss.geometry_case);
      const auto nearest =
          std::min_element(found->candidates.begin(), found->candidates.end(),
                           [&](const AxisCandidate& a, const AxisCandidate& b) {
                             return scene.off_rad(a.axis_icrf) < scene.off_rad(b.axis_icrf);
                           });
      const double off_rad = scene.off_rad(nearest->axis_icrf);
      if (found->near_tangent) {
        // Only the redundant measurements of cases 2 and 3 tell such roots apart.
        ASSERT_TRUE(!found->told_apart || loss.quantities.empty());
        ASSERT_TRUE(!found->told_apart || loss.geometry_case < 4);
        // Near a double root the error grows as the square root of the 1 ns resolution.
        found_true += off_rad < 1e-3 ? 1 : 0;
        continue;
      }
      ASSERT_LT(off_rad, 1e-5);
      ASSERT_TRUE(nearest->consistent);
      ASSERT_TRUE(!found->told_apart || nearest == found->candidates.begin());
      ++found_true;
    }
    EXPECT_GT(found_true, kScenes / 2) << loss.geometry_case;
  }
}

TEST_P(EveryCase, WithTheSunNearTheAxisIsNotLeftWithTheFalseOneByNoise) {
  constexpr int kScenes = 300;
  for (const Loss& loss : losses()) {
    if (loss.geometry_case < 4 || loss.geometry_case > 6 ||
        !loss.edges.contains(PulseChannel::Sun2)) {
      continue;
    }
    SCOPED_TRACE(loss.geometry_case);
    std::mt19937_64 rng{93};
    int told_apart = 0;
    for (int trial = 0; trial < kScenes; ++trial) {
      Scene scene = random_scene(GetParam(), rng);
      const Eigen::Vector3d across = scene.axis_icrf.unitOrthogonal();
      const double sun_deg = std::uniform_real_distribution<double>{174.0, 179.9}(rng);
      scene.sun_icrf = Eigen::AngleAxisd{sun_deg * kRadPerDeg, across} * scene.axis_icrf;
      scene.config.noise = {.sun_s = 1e-4, .infrared_s = 5e-4};
      const Revolution seen = noisy(scene, without(scene.seen(), loss.edges), rng);
      const auto found = axis_candidates(
          scene.config, measured_without(scene.config, seen, loss.quantities), scene.sun_earth());
      if (found && found->told_apart) {
        ++told_apart;
        EXPECT_LT(scene.off_rad(found->candidates.front().axis_icrf),
                  6.0 * std::sqrt(found->candidates.front().covariance_rad2.trace()))
            << "Sun at " << sun_deg << " deg";
      }
    }
    RecordProperty("told_apart", told_apart);
  }
}

TEST_P(EveryCase, HasTheCovariancesOfCentralDifferences) {
  for (const Loss& loss : losses()) {
    std::mt19937_64 rng{93};
    int compared = 0;
    for (int trial = 0; trial < 60; ++trial) {
      SCOPED_TRACE(loss.geometry_case * 1000 + trial);
      const Scene scene = random_scene(GetParam(), rng);
      const Revolution revolution = without(scene.seen(), loss.edges);
      const auto solve = [&](const Revolution& seen) {
        return axis_candidates(scene.config, measured_without(scene.config, seen, loss.quantities),
                               scene.sun_earth());
      };
      const auto found = solve(revolution);
      if (!found || found->near_tangent) {
        continue;
      }
      constexpr double kStep_s = 2e-6;
      for (std::size_t i = 0; i < found->candidates.size(); ++i) {
        const AxisCandidate& candidate = found->candidates[i];
        // Finite differences fail where the geometry amplifies errors a hundredfold.
        if (candidate.covariance_rad2.trace() > std::pow(2e-4, 2)) {
          continue;
        }
        const Eigen::Matrix<double, 3, 2> basis = tangent_basis(candidate.axis_icrf);
        Eigen::Matrix2d expected = Eigen::Matrix2d::Zero();
        for (std::size_t channel = 0; channel < kPulseChannels; ++channel) {
          if (!revolution.edges.at(channel)) {
            continue;
          }
          Revolution later = revolution;
          Revolution earlier = revolution;
          later.edges.at(channel) = shifted(*revolution.edges.at(channel), kStep_s);
          earlier.edges.at(channel) = shifted(*revolution.edges.at(channel), -kStep_s);
          const Eigen::Vector2d moved = 0.5 * basis.transpose() *
                                        (solve(later)->candidates.at(i).axis_icrf -
                                         solve(earlier)->candidates.at(i).axis_icrf);
          expected += moved * moved.transpose();
        }
        // Rounding of edges to nanoseconds costs 1e-3 of the squared step.
        ASSERT_LT((candidate.covariance_rad2 - expected).norm(), 3e-3 * expected.norm());
        ++compared;
      }
    }
    EXPECT_GT(compared, 30) << loss.geometry_case;
  }
}

TEST(AxisCandidates, ConesAreNamed) {
  using enum PulseChannel;
  const Scene scene;
  const std::vector<std::pair<Loss, NoFixCode>> cones = {
      {{{Sun1, Sun2}, {}, 8}, NoFixCode::BothChordsAlone},
      {{{NorthIn, SouthIn}, {}, 9}, NoFixCode::SunAngleAlone},
      {{{Sun1, Sun2, NorthIn}, {}, 10}, NoFixCode::OneChordAlone},
      {{{Sun1, Sun2, SouthIn}, {}, 10}, NoFixCode::OneChordAlone},
      {{{Sun1, NorthIn, SouthIn}, {}, 0}, NoFixCode::NothingMeasured},
      {{{Sun1, Sun2, NorthIn, SouthIn}, {}, 0}, NoFixCode::NothingMeasured}};
  for (const auto& [loss, code] : cones) {
    const RevolutionMeasurements measured =
        measure(scene.config, without(scene.seen(), loss.edges));
    EXPECT_EQ(geometry_case_of(measured), loss.geometry_case);
    const auto found = axis_candidates(scene.config, measured, scene.sun_earth());
    ASSERT_FALSE(found);
    EXPECT_FALSE(found.error().contradictory);
    EXPECT_EQ(found.error().why.code, code);
  }
}

/// Returns the sum over noisy copies of the revolution of the squared error, normalised by the
/// covariance of the undisturbed revolution.
double squared_errors(const Scene& scene, const std::set<SpinQuantity>& left_out, int draws,
                      std::mt19937_64& rng) {
  const Revolution exact = scene.seen();
  const SpinFix stated = lone_fix(scene.config, exact, left_out, scene.sun_earth()).value();
  const Eigen::Matrix<double, 3, 2> basis = tangent_basis(stated.axis_icrf);
  double sum = 0.0;
  for (int draw = 0; draw < draws; ++draw) {
    const auto fix = lone_fix(scene.config, noisy(scene, exact, rng), left_out, scene.sun_earth());
    const Eigen::Vector2d error_rad = basis.transpose() * fix.value().axis_icrf;
    sum += normalised_square(error_rad, stated.covariance_rad2);
  }
  return sum;
}

TEST_P(EveryCase, HasTheScatterThatTheNoiseMakes) {
  constexpr int kDraws = 3000;
  std::mt19937_64 rng{91};
  // At most 1e-4 rad of spin phase, so that the geometry is linear within the noise.
  Scene scene{.earth = GetParam()};
  scene.config.horizon.model = GetParam();
  scene.config.noise = {.sun_s = 2e-5, .infrared_s = 1e-4};
  // Chi-square with 6000 degrees of freedom has a standard deviation of sqrt(12000); 99.9 %.
  constexpr double kSpread = 3.29 * 109.5;
  for (const std::set<SpinQuantity>& left_out :
       {std::set<SpinQuantity>{}, std::set{SouthChord}, std::set{NorthChord},
        std::set{NorthDihedral}, std::set{SouthChord, NorthDihedral}}) {
    SCOPED_TRACE(left_out.size());
    EXPECT_NEAR(squared_errors(scene, left_out, kDraws, rng), 2.0 * kDraws, kSpread);
  }
}

TEST(AxisCandidatesOnTheEllipsoid, TheScatterKnowsThatAnotherAxisSeesAnotherLimb) {
  // In this geometry that effect is 4.3 % of the squared error.
  std::mt19937_64 rng{93};
  Scene scene;
  for (int trial = 0; trial <= 6; ++trial) {
    scene = random_scene(HorizonModel::Ellipsoid, rng);
  }
  constexpr int kDraws = 20'000;
  // The 99.9 % band of chi-square with 40,000 degrees of freedom is 2.3 % wide.
  EXPECT_NEAR(squared_errors(scene, {NorthChord, NorthDihedral}, kDraws, rng), 2.0 * kDraws,
              3.29 * std::sqrt(4.0 * kDraws));
}

INSTANTIATE_TEST_SUITE_P(AxisCandidates, EveryCase,
                         ::testing::Values(HorizonModel::Sphere, HorizonModel::Ellipsoid),
                         [](const auto& model) {
                           return model.param == HorizonModel::Sphere ? "Sphere" : "Ellipsoid";
                         });

TEST(AxisCandidates, CovarianceGrowsWithTheSquareOfTheNoise) {
  Scene scene;
  scene.config.noise = {.sun_s = 1e-5, .infrared_s = 5e-5};
  const Eigen::Matrix2d once = scene.fix().value().covariance_rad2;
  scene.config.noise = {.sun_s = 2e-5, .infrared_s = 1e-4};
  const Eigen::Matrix2d twice = scene.fix().value().covariance_rad2;
  // Rounding to nanoseconds is 5e-5 of the smaller noise.
  EXPECT_LT((twice - 4.0 * once).norm(), 4e-4 * twice.norm());
}

}  // namespace spindrift::testing::axis_candidates_every_case_test
