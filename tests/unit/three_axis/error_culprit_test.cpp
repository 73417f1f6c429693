/// The sensor whose errors alone explain innovations that contradict the mission file.

#include "pipelines/three_axis/error_culprit.h"

#include <gtest/gtest.h>

#include <random>
#include <set>
#include <string>

#include "pipelines/frames/angle.h"
#include "tests/support/matchers.h"
#include "tests/support/misaligned_pass.h"

namespace spindrift::testing::error_culprit_test {

constexpr MisalignedScene kSunAndField{
    .star = false, .sun = true, .field = true, .most_rad_s = 1.5 * kRadPerDeg, .duration_s = 200};
constexpr int kPasses = 5;

/// Returns the names given in passes with this error and the others as stated.
std::set<std::string> named(const MisalignedScene& scene, int error, double value) {
  std::mt19937_64 rng{4747};
  std::set<std::string> names;
  for (int i = 0; i < kPasses; ++i) {
    AlignmentErrors errors = drawn(default_alignment(), rng);
    errors[error] += value;
    for (const JudgedAttitude& row : fly(scene, errors, default_alignment(), rng).rows) {
      if (const auto& found = row.estimate.contradiction) {
        names.insert(culprit_name_of(*found));
      }
    }
  }
  names.erase(std::string{kUnknownCulprit});
  return names;
}

TEST(ErrorCulprit, IsTheGyroWhereItsScaleIsWrong) {
  EXPECT_THAT(named(kSunAndField, GyroScaleError, 0.1), ElementsAre("gyro"));
  MisalignedScene with_stars = kSunAndField;
  with_stars.star = true;
  EXPECT_THAT(named(with_stars, GyroScaleError + 1, 0.02), ElementsAre("gyro"));
}

TEST(ErrorCulprit, IsTheStarTrackerWhereItsFixesAreLate) {
  MisalignedScene with_stars = kSunAndField;
  with_stars.star = true;
  EXPECT_THAT(named(with_stars, StarTrackerTimeError, 0.3), ElementsAre("star"));
}

TEST(ErrorCulprit, IsNoneWhereTheErrorsAreAsStated) {
  EXPECT_THAT(named(kSunAndField, GyroScaleError, 0.0), IsEmpty());
}

TEST(ErrorCulprit, IsNoneWithoutAnyInnovation) {
  const AlignmentEvidence nothing{FilterAlignment::Identity()};
  EXPECT_FALSE(contradiction_by_errors(nothing, Eigen::Vector3d::Zero(), TaiTime{}));
}

}  // namespace spindrift::testing::error_culprit_test
