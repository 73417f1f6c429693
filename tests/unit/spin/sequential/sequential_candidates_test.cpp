/// When fixes name several axes, `sequential` follows them all and reports AMBIGUOUS until one is
/// settled.

#include <cmath>
#include <numbers>
#include <vector>

#include "pipelines/frames/angle.h"
#include "pipelines/frames/celestial.h"
#include "pipelines/spin/sequential/sequential.h"
#include "services/base/assessment_words.h"
#include "tests/support/assessed.h"
#include "tests/support/matchers.h"
#include "tests/support/sequential_scene.h"

namespace spindrift::testing::sequential_candidates_test {

SpinFix ambiguous(SpinFix fix, const Eigen::Vector3d& first, const Eigen::Vector3d& second) {
  fix.axis_icrf = first;
  fix.alternates = {{.axis_icrf = second, .covariance_rad2 = fix.covariance_rad2}};
  fix.resolution = Resolution::Ambiguous;
  fix.accepted = false;
  return fix;
}

TEST_F(SequentialOnAScene, AFixThatComesNearABranchOfAlternatesDoesNotStartThere) {
  // Poor fixes settled by a prior name a false axis beside the true one until it is known well;
  // then a settled fix lies nearer to the false one.
  constexpr double kPoor_rad = 8.0 * kRadPerDeg;
  constexpr std::size_t kByPrior = 14;
  const auto seen = scene.seen(0.0, 240.0);
  const Eigen::Vector3d elsewhere = scene.turned_about_earth(40.0);
  const auto all = estimates(scene.body.config, seen, [&](std::size_t i) {
    SpinFix fix = drawn_fix(scene.body.axis_icrf, kPoor_rad, scene.rng);
    if (i < kByPrior) {
      // The candidate's own sigma is larger, so that it does not start a filter before.
      fix.covariance_rad2 *= 4.0;
      fix.alternates = {{.axis_icrf = drawn_fix(elsewhere, kPoor_rad, scene.rng).axis_icrf,
                         .covariance_rad2 = kPoor_rad * kPoor_rad * Eigen::Matrix2d::Identity()}};
      fix.resolution = Resolution::Prior;
    } else if (i == kByPrior) {
      fix.axis_icrf = scene.turned_about_earth(22.0);
    }
    return std::vector{fix};
  });
  ASSERT_FALSE(all.empty());
  EXPECT_LT(error_deg(all.front(), scene.body.axis_icrf), 10.0);
  EXPECT_TRUE(is_unopposed(all.back().assessment.quality));
  EXPECT_FALSE(restarted(all.back().assessment));
  EXPECT_LT(squared_error(all.back(), scene.body.axis_icrf), kOneInTenThousand);
}

TEST_F(SequentialOnAScene, NearTangentFixesStartItWhereThereAreNoOthersAndSettleNothing) {
  constexpr std::size_t kFirstGood = 40;
  const auto seen = scene.seen(0.0, 60.0);
  const Eigen::Vector3d sun_icrf = scene.around.sun_icrf(0.0);
  const auto all = estimates(scene.body.config, seen, [&](std::size_t i) {
    if (i >= kFirstGood) {
      return std::vector{scene.fix()};
    }
    SpinFix fix = ambiguous(scene.fix(), scene.turned_about(sun_icrf, 25.0), scene.body.axis_icrf);
    fix.near_tangent = true;
    return std::vector{fix};
  });
  ASSERT_GT(all.size(), 20U);
  ASSERT_LT(all.size(), seen.size() - 10);
  const std::size_t good = all.size() - (seen.size() - kFirstGood);
  for (std::size_t i = 0; i < all.size(); ++i) {
    const Quality quality = all[i].assessment.quality;
    EXPECT_TRUE(i < good ? quality == Quality::Ambiguous : is_unopposed(quality)) << i;
  }
  EXPECT_LT(squared_error(all.back(), scene.body.axis_icrf), kOneInTenThousand);
}

TEST_F(SequentialOnAScene, NeverFollowsAFalseAxisSilently) {
  // The first fixes are false and none follows. Unless the filter finds the true axis by itself,
  // its status must not be OK. If it does, the doubt from the false start has faded, with at most
  // one exception.
  const auto seen = scene.seen(0.0, 60.0);
  const Eigen::Matrix<double, 3, 2> basis = tangent_basis(scene.body.axis_icrf);
  int lost = 0;
  int right_and_doubted = 0;
  for (const double off_deg : {2.0, 5.0, 12.0, 30.0, 90.0}) {
    for (int direction = 0; direction < 8; ++direction) {
      const Eigen::Vector2d towards{std::cos(direction * std::numbers::pi / 4.0),
                                    std::sin(direction * std::numbers::pi / 4.0)};
      SpinFix wrong = scene.fix();
      wrong.axis_icrf = std::cos(off_deg * kRadPerDeg) * scene.body.axis_icrf +
                        std::sin(off_deg * kRadPerDeg) * basis * towards;
      const SpinEstimate last = estimates(scene.body.config, seen, at_first(wrong)).back();
      const bool right = squared_error(last, scene.body.axis_icrf) < kOneInTenThousand &&
                         error_deg(last, scene.body.axis_icrf) < 1.0;
      EXPECT_TRUE(right || !is_unopposed(last.assessment.quality))
          << off_deg << " deg, direction " << direction << ": " << sentence_of(last.assessment)
          << ", off by " << error_deg(last, scene.body.axis_icrf) << " deg";
      lost += right ? 0 : 1;
      right_and_doubted += right && !is_unopposed(last.assessment.quality) ? 1 : 0;
    }
  }
  EXPECT_LE(right_and_doubted, 1);
  EXPECT_GT(lost, 16);  // All that are at least 30 deg off.
}

TEST_F(SequentialOnAScene, SaysAmbiguousUntilAFixSettlesIt) {
  // Without the Sun, the axes form a cone about the Earth; two of them are named, the true one
  // second.
  const auto seen = without_sun(scene.seen(0.0, 30.0));
  const std::size_t settled_at = 20;
  const SpinFix start =
      ambiguous(scene.fix(), scene.turned_about_earth(10.0), scene.body.axis_icrf);
  const auto all = estimates(scene.body.config, seen, [&](std::size_t i) {
    return i == 0            ? std::vector{start}
           : i == settled_at ? std::vector{scene.fix()}
                             : std::vector<SpinFix>{};
  });
  ASSERT_EQ(all.size(), seen.size());
  for (std::size_t i = 0; i < all.size(); ++i) {
    const Quality quality = all[i].assessment.quality;
    EXPECT_TRUE(i < settled_at ? quality == Quality::Ambiguous : is_unopposed(quality)) << i;
  }
  EXPECT_LT(squared_error(all.back(), scene.body.axis_icrf), kOneInTenThousand);
}

TEST_F(SequentialOnAScene, NamesTheAlternativeThatItDoesNotPublish) {
  const auto seen = without_sun(scene.seen(0.0, 15.0));
  const SpinFix start =
      ambiguous(scene.fix(), scene.body.axis_icrf, scene.turned_about_earth(10.0));
  const auto all = estimates(scene.body.config, {seen.front()}, at_first(start));
  const RaDec other = ra_dec_of(start.alternates.front().axis_icrf);
  const Assessment& last = all.back().assessment;
  EXPECT_EQ(last.quality, Quality::Ambiguous);
  EXPECT_NEAR(number_of(last.reasons, ReasonCode::OtherAxis, "ra_deg"), other.ra_rad / kRadPerDeg,
              0.005);
  EXPECT_NEAR(number_of(last.reasons, ReasonCode::OtherAxis, "dec_deg"), other.dec_rad / kRadPerDeg,
              0.005);
}

TEST(Sequential, EdgesBeyondDoubtSettleIt) {
  for (const bool true_first : {true, false}) {
    Scene scene;
    const auto seen = scene.seen(0.0, 40.0);
    const Eigen::Vector3d other = scene.turned_about(scene.around.sun_icrf(0.0), 6.0);
    const SpinFix start = true_first ? ambiguous(scene.fix(), scene.body.axis_icrf, other)
                                     : ambiguous(scene.fix(), other, scene.body.axis_icrf);
    const auto all =
        estimates(scene.body.config, seen, [&](std::size_t) { return std::vector{start}; });
    EXPECT_EQ(all.front().assessment.quality, Quality::Ambiguous);
    EXPECT_TRUE(is_unopposed(all.back().assessment.quality));
    EXPECT_LT(squared_error(all.back(), scene.body.axis_icrf), kOneInTenThousand);
  }
}

TEST(Sequential, TheLikeliestCandidateOfOneFixIsNotTheAxisForThat) {
  // Stray edges may create a candidate; being less unlikely than the other proves nothing, whether
  // the true axis is among them or not.
  for (const bool with_the_true : {true, false}) {
    Scene scene;
    const auto seen = scene.seen(0.0, with_the_true ? 40.0 : 60.0);
    const SpinFix start = with_the_true
                              ? ambiguous(scene.fix(), scene.body.axis_icrf,
                                          scene.turned_about(scene.around.sun_icrf(0.0), 6.0))
                              : ambiguous(scene.fix(), scene.turned_about_earth(25.0),
                                          scene.turned_about_earth(-15.0));
    const auto all = estimates(scene.body.config, seen, at_first(start));
    ASSERT_EQ(all.size(), seen.size());
    for (const SpinEstimate& estimate : all) {
      const Quality quality = estimate.assessment.quality;
      EXPECT_TRUE(with_the_true ? quality == Quality::Ambiguous : !is_unopposed(quality));
    }
  }
}

TEST_F(SequentialOnAScene, WhereNearlyAllFixesAreNearTangentNoneNamesAllCandidates) {
  // Noise makes one fix in ten not near tangent, but it lacks the true axis like the others.
  const auto seen = scene.seen(0.0, 100.0);
  const Eigen::Vector3d sun_icrf = scene.around.sun_icrf(0.0);
  const auto all = estimates(scene.body.config, seen, [&](std::size_t i) {
    SpinFix fix =
        ambiguous(scene.fix(), scene.turned_about(sun_icrf, 25.0), scene.turned_about_earth(-15.0));
    fix.near_tangent = i % 10 != 9;
    return std::vector{fix};
  });
  ASSERT_FALSE(all.empty());
  for (const SpinEstimate& estimate : all) {
    EXPECT_TRUE(has(estimate.assessment, ReasonCode::FixesNearTangent) ||
                estimate.assessment.quality == Quality::Lost);
  }
}

TEST_F(SequentialOnAScene, ACandidateThatOnlyLaterFixesNameIsFollowed) {
  // The first AMBIGUOUS fix lacks the true axis; all others name it second.
  const auto seen = scene.seen(0.0, 60.0);
  const Eigen::Vector3d sun_icrf = scene.around.sun_icrf(0.0);
  const auto all = estimates(scene.body.config, seen, [&](std::size_t i) {
    return std::vector{
        i == 0 ? ambiguous(scene.fix(), scene.turned_about(sun_icrf, 25.0),
                           scene.turned_about_earth(-15.0))
               : ambiguous(scene.fix(), scene.turned_about(sun_icrf, 25.0), scene.body.axis_icrf)};
  });
  for (const SpinEstimate& estimate : all) {
    if (is_unopposed(estimate.assessment.quality)) {
      EXPECT_LT(squared_error(estimate, scene.body.axis_icrf), kOneInTenThousand);
    }
  }
  EXPECT_TRUE(is_unopposed(all.back().assessment.quality));
}

TEST_F(SequentialOnAScene, WhatIsSettledIsOpenAgainWhereFixesNameOtherAxes) {
  // Without the Sun no edge contradicts the false axis, and no later fix is settled.
  const auto seen = without_sun(scene.seen(0.0, 60.0));
  const SpinFix wrong = scene.false_fix(12.0);
  const auto all = estimates(scene.body.config, seen, [&](std::size_t i) {
    return std::vector{
        i == 0 ? wrong
               : ambiguous(scene.fix(), scene.turned_about_earth(-30.0), scene.body.axis_icrf)};
  });
  EXPECT_TRUE(is_unopposed(all[20].assessment.quality));
  EXPECT_EQ(all.back().assessment.quality, Quality::Ambiguous);
}

}  // namespace spindrift::testing::sequential_candidates_test
