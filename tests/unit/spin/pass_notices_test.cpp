#include "pipelines/spin/pass_notices.h"

#include <gmock/gmock.h>
#include <gtest/gtest.h>

#include <Eigen/Core>
#include <cmath>

#include "tests/support/spinning_body.h"

namespace spindrift {
namespace {

using ::testing::ElementsAre;
using ::testing::HasSubstr;
using ::testing::IsEmpty;
using enum PulseChannel;

const SpinConfig kConfig = testing::usual_config();
const Error kBefore{ErrorCode::NoCoverage, "before its first state"};
const Error kAfter{ErrorCode::NoCoverage, "after its last state"};

Association of_one_revolution() {
  return {.closed = {Revolution{.number = 0, .edges = {}, .period_candidate = {}, .period = {}}},
          .left_over = {}};
}

std::vector<std::string> at_the_end(PassNotices& notices) {
  notices.take();
  notices.pass_ended({}, SequentialEstimator{kConfig});
  return notices.take();
}

SpinEstimate estimate_of(const char* status) {
  return {.t = tai_from_ns(1'795'143'637'000'000'000),
          .estimator = SpinEstimator::Sequential,
          .axis_icrf = Eigen::Vector3d::UnitX(),
          .covariance_rad2 = Eigen::Matrix2d::Identity() * 1e-8,
          .spin_rate_rad_s = 6.28,
          .spin_rate_sigma_rad_s = 1e-6,
          .status = status};
}

TEST(PassNotices, EachThingIsSaidOnce) {
  PassNotices notices{kConfig};
  notices.edge_came_late();
  notices.edge_came_late();
  notices.edge_out_of_time();
  EXPECT_THAT(notices.take(), ElementsAre(HasSubstr("after their time"), HasSubstr("far ahead")));
  notices.edge_came_late();
  EXPECT_THAT(notices.take(), IsEmpty());
}

TEST(PassNotices, TheFirstOutsideTheOrbitIsNamedAndTheEndSaysHowMany) {
  PassNotices notices{kConfig};
  notices.outside_orbit(kBefore);
  notices.outside_orbit(kAfter);
  EXPECT_THAT(notices.take(), ElementsAre(HasSubstr("before its first state")));
  EXPECT_THAT(at_the_end(notices), ElementsAre(HasSubstr("2 revolutions outside it gave no axis, "
                                                         "the last: after its last state")));
}

TEST(PassNotices, TheEndNamesTheChannelsThatWereNeverHeard) {
  PassNotices notices{kConfig};
  for (const PulseChannel channel : {Sun1, NorthIn, NorthOut, SouthIn}) {
    notices.edge_came(channel);
  }
  notices.associated(of_one_revolution());
  EXPECT_THAT(at_the_end(notices), ElementsAre("no edge at all came from sun2, south_out"));
}

TEST(PassNotices, WithoutAnyRevolutionThePeriodIsWhatIsMissing) {
  PassNotices notices{kConfig};
  notices.associated({.closed = {}, .left_over = {PulseUse{}}});
  EXPECT_THAT(at_the_end(notices), ElementsAre(HasSubstr("no spin period was found")));
}

TEST(PassNotices, TheEndSaysWhyTheAxisIsAmbiguous) {
  PassNotices notices{kConfig};
  notices.has_fix(4);
  notices.estimated(estimate_of("AMBIGUOUS: two candidates"));
  EXPECT_THAT(at_the_end(notices), ElementsAre(HasSubstr("for want of good sun2 edges")));
}

TEST(PassNotices, FixesWithoutAnEstimateAreSaidToBeTooUncertain) {
  PassNotices notices{kConfig};
  notices.without_fix(0, {ErrorCode::Unobservable, "no chord"});
  notices.has_fix(1);
  EXPECT_THAT(notices.take(), ElementsAre("revolution 0 is the first that gives no fix: no chord"));
  EXPECT_THAT(at_the_end(notices), ElementsAre(HasSubstr("'sequential' never began")));
}

TEST(PassNotices, APriorThatIsFarFromTheAxisIsNamedOnceThoughNothingHadToBeChosen) {
  SpinConfig config = kConfig;
  config.prior = {.axis_icrf = Eigen::Vector3d::UnitX(), .sigma_rad = 0.017};
  SpinEstimate estimate = estimate_of("OK, 9 revolutions, 0 edges gated");
  PassNotices notices{config};
  notices.estimated(estimate);
  EXPECT_THAT(notices.take(), IsEmpty());
  estimate.axis_icrf = {std::cos(0.2), std::sin(0.2), 0.0};
  notices.estimated(estimate);
  notices.estimated(estimate);
  EXPECT_THAT(
      notices.take(),
      ElementsAre(HasSubstr("11.5 deg from the prior of the mission (spin.prior), 12 times")));
}

}  // namespace
}  // namespace spindrift
