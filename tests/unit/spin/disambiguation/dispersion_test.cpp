#include "pipelines/spin/disambiguation/dispersion.h"

#include <Eigen/Geometry>
#include <array>
#include <cmath>
#include <functional>
#include <utility>
#include <vector>

#include "pipelines/frames/angle.h"
#include "pipelines/frames/celestial.h"
#include "pipelines/statistics/distributions.h"
#include "tests/support/matchers.h"
#include "tests/support/noisy_axes.h"

namespace spindrift::dispersion_test {

using testing::candidate;
using testing::drifting;
using testing::expect_noise_alone_settles_nothing;
using testing::kSigma_rad;
using testing::kTrue_icrf;
using testing::NoisyAxes;

/// Returns the candidates of a revolution.
using Candidates = std::function<std::vector<AxisCandidate>(NoisyAxes& axes, int revolution)>;

/// Adds revolutions until a branch is found stationary, which has to be the true one.
/// @return The branch and the number of revolutions.
std::pair<StationaryBranch, int> found_of(std::uint64_t seed, int most, const Candidates& of) {
  NoisyAxes axes{seed};
  Dispersion dispersion{100};
  std::optional<StationaryBranch> found;
  int revolution = 0;
  for (; revolution < most && !found; ++revolution) {
    found = dispersion.add(of(axes, revolution));
  }
  EXPECT_LT(angle_between_rad(found.value().axis.axis_icrf, kTrue_icrf), 0.2 * kRadPerDeg);
  return {*found, revolution};
}

TEST(Dispersion, TheBranchThatStaysIsFound) {
  const auto [found, revolutions] = found_of(61, 200, [](NoisyAxes& axes, int revolution) {
    const AxisCandidate other = axes.seen(drifting(0.1 * kRadPerDeg * revolution));
    return std::vector{other, axes.seen(kTrue_icrf)};
  });
  EXPECT_EQ(found.axis.count, revolutions);
}

TEST(Dispersion, TheOrderOfTheCandidatesDoesNotMatter) {
  found_of(62, 200, [](NoisyAxes& axes, int revolution) {
    const AxisCandidate other = axes.seen(drifting(0.1 * kRadPerDeg * revolution));
    const AxisCandidate true_one = axes.seen(kTrue_icrf);
    return revolution % 3 == 0 ? std::vector{true_one, other} : std::vector{other, true_one};
  });
}

TEST(Dispersion, ADriftTooSlowForTheWindowShowsInALongPass) {
  // The drift of 0.3 deg in a hundred revolutions is a tenth of what their scatter could hide; in
  // all it is 9 deg.
  const auto [found, revolutions] = found_of(63, 3000, [](NoisyAxes& axes, int revolution) {
    const AxisCandidate true_one = axes.seen(kTrue_icrf);
    return std::vector{true_one, axes.seen(drifting(0.003 * kRadPerDeg * revolution))};
  });
  EXPECT_GT(found.axis.count, 100.0);
}

TEST(Dispersion, OutliersAndDropOutsAreSurvived) {
  found_of(65, 300, [](NoisyAxes& axes, int revolution) {
    const double moved_rad = 0.08 * kRadPerDeg * revolution;
    std::vector candidates{axes.seen(drifting(moved_rad)), axes.seen(kTrue_icrf)};
    if (revolution % 7 == 3) {
      candidates.pop_back();
    }
    if (revolution % 11 == 5) {  // A displaced edge moves both branches.
      candidates = {axes.seen(drifting(moved_rad + 0.2)), axes.seen(drifting(-0.4))};
    }
    return candidates;
  });
}

TEST(Dispersion, AfterASilenceTheTrueBranchIsWhereItWas) {
  found_of(66, 60, [](NoisyAxes& axes, int revolution) {
    const AxisCandidate true_one = axes.seen(kTrue_icrf);
    return std::vector{true_one, axes.seen(drifting(revolution < 20 ? 0.0 : 15.0 * kRadPerDeg))};
  });
}

constexpr double kStep_rad = 0.1 * kRadPerDeg;

/// Returns the variance ratio of a noise-free branch that moves kStep_rad per revolution on a great
/// circle and states kSigma_rad. The squares about its middle are kStep_rad^2 n (n^2 - 1) / 12,
/// over 2 (n - 1) degrees of freedom.
double ratio_of_drift(double revolutions) {
  constexpr double kFloor_rad = 0.02 * kRadPerDeg;
  return kStep_rad * kStep_rad * revolutions * (revolutions + 1.0) /
         (24.0 * (kSigma_rad * kSigma_rad + kFloor_rad * kFloor_rad));
}

/// Settles noise-free branches: X is constant, the others drift, one twice as fast as the other.
StationaryBranch settled_without_noise(bool unlike) {
  const auto at = [](const Eigen::Vector3d& axis_icrf) { return candidate(axis_icrf, kSigma_rad); };
  Dispersion dispersion{100};
  if (unlike) {
    dispersion.note_unlike();
  }
  std::optional<StationaryBranch> found;
  for (int revolution = 0; revolution < 99 && !found; ++revolution) {
    const double slow_rad = kStep_rad * revolution;
    const double fast_rad = 2.0 * slow_rad;
    const std::array candidates{at({-std::cos(fast_rad), 0.0, std::sin(fast_rad)}),
                                at(Eigen::Vector3d::UnitX()),
                                at({0.0, std::sin(slow_rad), std::cos(slow_rad)})};
    found = dispersion.add(candidates);
  }
  return found.value();
}

TEST(Dispersion, TheRatioIsThatOfTheScattersOfTheNearestOtherBranch) {
  const StationaryBranch found = settled_without_noise(true);
  EXPECT_NEAR(angle_between_rad(found.axis.axis_icrf, Eigen::Vector3d::UnitX()), 0.0, 1e-9);
  EXPECT_NEAR(found.scatter_ratio / ratio_of_drift(found.axis.count), 1.0, 1e-3);
  EXPECT_FALSE(found.log_likelihood_ratio);
  // The F-test decided, and not a revolution late.
  const double freedom = 2.0 * (found.axis.count - 1.0);
  EXPECT_LT(variance_ratio_tail(freedom, freedom, found.scatter_ratio), 1e-8);
  EXPECT_GT(
      variance_ratio_tail(freedom - 2.0, freedom - 2.0, ratio_of_drift(found.axis.count - 1.0)),
      1e-8);
}

TEST(Dispersion, WhereTheFTestDoesNotSettleItTheLikelihoodRatioIsStatedToo) {
  const StationaryBranch found = settled_without_noise(false);
  EXPECT_NEAR(found.scatter_ratio / ratio_of_drift(found.axis.count), 1.0, 1e-3);
  ASSERT_TRUE(found.log_likelihood_ratio);
  // The log-likelihood ratio is half the squares, which are zero for the constant branch.
  EXPECT_NEAR(*found.log_likelihood_ratio, found.scatter_ratio * (found.axis.count - 1.0), 1e-9);
  EXPECT_GT(*found.log_likelihood_ratio, 30.0);
}

TEST(Dispersion, NoiseAloneSettlesNothing) { expect_noise_alone_settles_nothing(20); }

TEST(Dispersion, WhereAllBranchesDriftNoneIsSteady) {
  NoisyAxes axes{64};
  Dispersion dispersion{100};
  for (int revolution = 0; revolution < 400; ++revolution) {
    const Eigen::Vector3d slow =
        Eigen::AngleAxisd{0.1 * kRadPerDeg * revolution, Eigen::Vector3d::UnitX()} * kTrue_icrf;
    const std::array candidates{axes.seen(slow),
                                axes.seen(drifting(0.15 * kRadPerDeg * revolution))};
    ASSERT_FALSE(dispersion.add(candidates)) << revolution;
  }
}

TEST(Dispersion, ABranchThatPassesThroughTheTrueOneIsNotTakenForIt) {
  const auto passing = [&](double off_rad) -> Eigen::Vector3d {
    return Eigen::AngleAxisd{off_rad, Eigen::Vector3d::UnitY()} * kTrue_icrf;
  };
  int settled = 0;
  for (std::uint64_t seed = 0; seed < 300; ++seed) {
    NoisyAxes axes{2000 + seed};
    Dispersion dispersion{100};
    const int beginning = -10 - static_cast<int>(seed % 50);
    for (int revolution = beginning; revolution < 40; ++revolution) {
      const std::array candidates{axes.seen(kTrue_icrf),
                                  axes.seen(passing(0.2 * kRadPerDeg * revolution))};
      if (const auto found = dispersion.add(candidates)) {
        ++settled;
        ASSERT_LT(angle_between_rad(found->axis.axis_icrf, kTrue_icrf), 0.5 * kRadPerDeg) << seed;
        break;
      }
    }
  }
  EXPECT_GT(settled, 100);
}

TEST(Dispersion, AnErrorOfTheModelIsNoDrift) {
  // Both branches move as a constant mounting error of 0.15 deg moves them while its leverage
  // grows.
  NoisyAxes axes{68};
  Dispersion dispersion{100};
  for (int revolution = 0; revolution < 1000; ++revolution) {
    const double leverage = 3.0 + 3e-3 * revolution;
    const auto moved = [&](const Eigen::Vector3d& axis, double share) {
      const Eigen::Matrix<double, 3, 2> basis = tangent_basis(axis);
      AxisCandidate candidate =
          axes.seen((axis + basis.col(0) * (0.15 * kRadPerDeg * leverage * share)).normalized());
      candidate.model_shift_icrf.col(0) = basis.col(0) * leverage * share;
      return candidate;
    };
    const std::array candidates{moved(kTrue_icrf, 1.0), moved(drifting(0.0), 0.2)};
    ASSERT_FALSE(dispersion.add(candidates)) << revolution;
  }
}

}  // namespace spindrift::dispersion_test
