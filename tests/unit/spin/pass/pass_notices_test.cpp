#include "pipelines/spin/pass/pass_notices.h"

#include <Eigen/Core>
#include <cmath>
#include <utility>

#include "services/base/notice_words.h"
#include "tests/support/matchers.h"
#include "tests/support/observed_spin.h"

namespace spindrift::testing::pass_notices_test {

using enum PulseChannel;

const TaiTime kStart = tai_from_ns(1'795'143'637'000'000'000);
const SpinConfig kConfig = usual_config();

Association of_one_revolution() {
  return {.closed = {Revolution{.number = 0, .edges = {}, .period_candidate = {}, .period = {}}},
          .left_over = {}};
}

std::vector<std::string> taken(PassNotices& notices) {
  std::vector<std::string> sentences;
  for (const Notice& notice : notices.take_pending()) {
    sentences.push_back(sentence_of(notice));
  }
  return sentences;
}

std::vector<std::string> at_the_end(PassNotices& notices) {
  notices.take_pending();
  notices.pass_ended({}, SequentialEstimator{kConfig});
  return taken(notices);
}

void hear_all(PassNotices& notices) {
  for (const PulseChannel channel : {Sun1, Sun2, NorthIn, NorthOut, SouthIn, SouthOut}) {
    notices.edge_came(channel);
  }
}

class PassNoticesTest : public ::testing::Test {
 protected:
  PassNotices notices_{kConfig};
};

SpinEstimate estimate_of(Assessment assessment) {
  return {.t = kStart,
          .estimator = SpinEstimator::Sequential,
          .axis_icrf = Eigen::Vector3d::UnitX(),
          .covariance_rad2 = Eigen::Matrix2d::Identity() * 1e-8,
          .spin_rate_rad_s = 6.28,
          .spin_rate_sigma_rad_s = 1e-6,
          .assessment = std::move(assessment)};
}

SpinFix fix_of(int geometry_case, Resolution resolution, bool near_tangent = false) {
  SpinFix fix = made_fix(Eigen::Vector3d::UnitX(), Eigen::Matrix2d::Identity() * 1e-6);
  fix.geometry_case = geometry_case;
  fix.resolution = resolution;
  fix.accepted = resolution != Resolution::Ambiguous;
  fix.near_tangent = near_tangent;
  return fix;
}

/// Returns the final notice on an ambiguous axis for a mission with or without a prior.
std::string said_of_ambiguous(const Assessment& assessment, const std::optional<SpinPrior>& prior,
                              std::optional<PriorVerdict> verdict, bool contradicted = false) {
  SpinConfig config = kConfig;
  config.prior = prior;
  PassNotices notices{config};
  notices.mean_began();
  notices.has_fix(fix_of(4, Resolution::Ambiguous), verdict);
  notices.estimated(estimate_of(assessment));
  if (contradicted) {
    notices.prior_contradicted(kStart);
  }
  const auto said = at_the_end(notices);
  return said.size() == 1 ? said.front() : "not one notice";
}

/// Returns `edges` edges, of which `left_out` are rejected for this reason.
std::vector<SpinProduct> used(std::int64_t edges, std::int64_t left_out, Rejection rejection) {
  std::vector<SpinProduct> products;
  for (std::int64_t i = 0; i < edges; ++i) {
    products.emplace_back(
        PulseUse{.pulse = {.t = tai_from_ns(i), .channel = Sun1},
                 .revolution = {},
                 .rejected_by = i < left_out ? std::optional{rejection} : std::nullopt});
  }
  return products;
}

TEST(PassNotices, SayThatMostEdgesDoNotFit) {
  const auto said = [](const std::vector<SpinProduct>& products) {
    PassNotices notices{kConfig};
    notices.associated(of_one_revolution());
    hear_all(notices);
    notices.used(products);
    return at_the_end(notices);
  };
  EXPECT_THAT(said(used(200, 101, Rejection::Phase)),
              ElementsAre(StartsWith("50 % of all edges do not fit and are left out, most as "
                                     "'phase'")));
  EXPECT_THAT(said(used(200, 100, Rejection::Phase)), IsEmpty());
  EXPECT_THAT(said(used(90, 90, Rejection::Phase)), IsEmpty());
  EXPECT_THAT(said(used(200, 200, Rejection::NoOrbit)), IsEmpty());
}

TEST_F(PassNoticesTest, CopiesAreSaidAsTheyBeginAndInTheEndHowManyAndHowFarApart) {
  hear_all(notices_);
  Association association = of_one_revolution();
  const Pulse copy{.t = kStart, .channel = Sun2};
  association.copies = {{.pulse = copy, .apart_s = 0.004}};
  notices_.associated(association);
  EXPECT_THAT(taken(notices_),
              ElementsAre(AllOf(HasSubstr("2026-11-20T03:00:00"),
                                HasSubstr("the edges of sun2 come several times"))));
  association.copies = {{.pulse = {.t = copy.t, .channel = Sun1}, .apart_s = 0.006},
                        {.pulse = copy, .apart_s = 0.005}};
  notices_.associated(association);
  EXPECT_THAT(taken(notices_), IsEmpty());
  EXPECT_THAT(at_the_end(notices_),
              ElementsAre(HasSubstr("3 edges of sun1, sun2 are copies, on average 0.005 s")));
}

TEST_F(PassNoticesTest, EachThingIsSaidOnce) {
  notices_.edge_came_late();
  notices_.edge_came_late();
  notices_.edge_out_of_time();
  EXPECT_THAT(taken(notices_),
              ElementsAre(HasSubstr("after their time"), HasSubstr("far from the times")));
  notices_.edge_came_late();
  EXPECT_THAT(taken(notices_), IsEmpty());
}

TEST_F(PassNoticesTest, TheFirstOutsideTheOrbitIsNamedAndTheEndSaysHowMany) {
  notices_.outside_orbit(kStart, ErrorCode::NoCoverage);
  notices_.outside_orbit(shifted(kStart, 5.0), ErrorCode::NoCoverage);
  EXPECT_THAT(taken(notices_),
              ElementsAre(HasSubstr("2026-11-20T03:00:00.000Z: the orbit of the "
                                    "mission file does not cover the revolution")));
  EXPECT_THAT(at_the_end(notices_), ElementsAre(HasSubstr("2 revolutions outside it gave no axis, "
                                                          "the last at 2026-11-20T03:00:05.000Z")));
}

TEST_F(PassNoticesTest, AnOrbitWithinTheEarthIsNotOneThatEnds) {
  notices_.outside_orbit(kStart, ErrorCode::Unobservable);
  EXPECT_THAT(taken(notices_), ElementsAre(HasSubstr("below the infrared horizon")));
}

TEST_F(PassNoticesTest, TheEndNamesTheChannelsThatWereNeverHeard) {
  for (const PulseChannel channel : {Sun1, NorthIn, NorthOut, SouthIn}) {
    notices_.edge_came(channel);
  }
  notices_.associated(of_one_revolution());
  EXPECT_THAT(at_the_end(notices_), ElementsAre("no edge at all came from sun2, south_out"));
}

TEST(PassNotices, TheEndNamesTheChannelsOfNoSensor) {
  SpinConfig config = kConfig;
  config.north.reset();
  PassNotices notices{config};
  hear_all(notices);
  notices.associated(of_one_revolution());
  EXPECT_THAT(at_the_end(notices),
              ElementsAre(StartsWith("the mission describes no sensor for north_in, north_out:")));
}

TEST_F(PassNoticesTest, WithoutAnyRevolutionThePeriodIsWhatIsMissing) {
  notices_.associated({.closed = {}, .left_over = {PulseUse{}}});
  EXPECT_THAT(at_the_end(notices_), ElementsAre(HasSubstr("of rates from 4 to 240 rpm")));
}

TEST(PassNotices, TheEndSaysWhyTheAxisIsAmbiguous) {
  EXPECT_THAT(said_of_ambiguous({Quality::Ambiguous}, {}, {}),
              StartsWith("the axis is ambiguous to the end, for want of good sun2 edges: a prior "
                         "in the mission file, or an operator, would choose"));
}

TEST(PassNotices, WhereTheMissionHasAPriorTheEndSaysWhyItDoesNotSettleTheAxis) {
  const SpinPrior prior{.axis_icrf = Eigen::Vector3d::UnitX(), .sigma_rad = 0.5};
  const auto said = [&](std::optional<PriorVerdict> verdict, bool contradicted = false) {
    return said_of_ambiguous({Quality::Ambiguous}, prior, verdict, contradicted);
  };
  EXPECT_THAT(said(PriorVerdict::FarFromAll),
              EndsWith("no candidate is within three sigmas of it"));
  EXPECT_THAT(said(PriorVerdict::NearSeveral),
              EndsWith("within its sigma of 28.6479 deg, several candidates are equally near to "
                       "it"));
  EXPECT_THAT(said(PriorVerdict::Chooses), HasSubstr("the edges do not bear out the candidate"));
  EXPECT_THAT(said({}, true), EndsWith("the edges contradict the prior of the mission"));
}

TEST(PassNotices, WhereAllFixesAreNearTangentNoPriorIsSaidToSettleTheAxis) {
  const Assessment near_tangent{Quality::Ambiguous, {Reason{ReasonCode::FixesNearTangent, {}}}};
  EXPECT_THAT(said_of_ambiguous(near_tangent, {}, {}), EndsWith("no prior would settle it"));
  const SpinPrior prior{.axis_icrf = Eigen::Vector3d::UnitX(), .sigma_rad = 0.009};
  EXPECT_THAT(said_of_ambiguous(near_tangent, prior, PriorVerdict::Chooses),
              EndsWith("the prior of the mission does not settle it"));
}

TEST_F(PassNoticesTest, TheEndSaysWhyNoFixIsInTheMean) {
  notices_.has_fix(fix_of(7, Resolution::Prior, true), {});
  notices_.has_fix(fix_of(7, Resolution::Ambiguous, true), {});
  notices_.has_fix(fix_of(4, Resolution::Ambiguous), {});
  SpinFix contradictory = fix_of(1, Resolution::Geometry);
  contradictory.accepted = false;
  notices_.has_fix(contradictory, {});
  notices_.estimated(estimate_of({Quality::Doubtful}));
  EXPECT_THAT(
      at_the_end(notices_),
      ElementsAre("the estimator 'mean' never began: of 4 fixes, 2 are near-tangent "
                  "(their candidates come together within the noise), 1 are ambiguous, 1 are not "
                  "accepted"));
}

TEST_F(PassNoticesTest, AMeanThatBeganIsNotMissed) {
  notices_.has_fix(fix_of(7, Resolution::Ambiguous, true), {});
  notices_.mean_began();
  EXPECT_THAT(at_the_end(notices_), Not(Contains(HasSubstr("'mean'"))));
}

TEST_F(PassNoticesTest, ADispersionThatSettlesIsToldWithItsRatio) {
  StationaryBranch branch{.axis = {.axis_icrf = Eigen::Vector3d::UnitY(), .count = 42.0},
                          .scatter_ratio = 25.34,
                          .log_likelihood_ratio = {}};
  notices_.settled_by_dispersion(kStart, branch);
  branch.scatter_ratio = 1.8;
  branch.log_likelihood_ratio = 34.4;
  notices_.settled_by_dispersion(kStart, branch);
  EXPECT_THAT(
      taken(notices_),
      ElementsAre("2026-11-20T03:00:00.000Z: the dispersion settles on the axis near ra 90.00 dec "
                  "0.00 deg: over 42 fixes its candidates stay where they are and the others "
                  "drift, ratio of the scatters 25.3 (F-test)",
                  EndsWith("ratio of the scatters 1.8 (likelihood ratio e^34)")));
}

TEST_F(PassNoticesTest, FixesWithoutAnEstimateAreSaidToBeTooUncertain) {
  notices_.without_fix(0, {NoFixCode::NothingMeasured});
  notices_.has_fix(fix_of(1, Resolution::Geometry), {});
  notices_.mean_began();
  EXPECT_THAT(
      taken(notices_),
      ElementsAre("revolution 0 is the first that gives no fix: no measurement that an axis could "
                  "be found from"));
  EXPECT_THAT(at_the_end(notices_), ElementsAre(HasSubstr("'sequential' never began")));
}

TEST_F(PassNoticesTest, TheRevolutionThatTheEndCutsShortIsNotTheFirstWithoutAFix) {
  notices_.has_fix(fix_of(1, Resolution::Geometry), {});
  notices_.mean_began();
  notices_.estimated(estimate_of({Quality::Ambiguous}));
  notices_.cut_short(9);
  notices_.without_fix(9, {NoFixCode::NothingMeasured});
  EXPECT_THAT(taken(notices_), IsEmpty());
}

TEST_F(PassNoticesTest, AnOnlyRevolutionThatIsCutShortIsWhyThereIsNoAxis) {
  notices_.cut_short(0);
  notices_.without_fix(0, {NoFixCode::NothingMeasured});
  EXPECT_THAT(at_the_end(notices_), ElementsAre("no axis: 1 revolutions gave no fix, the last: no "
                                                "measurement that an axis could be found from"));
}

TEST(PassNotices, APriorThatIsFarFromTheAxisIsNamedOnceThoughNothingHadToBeChosen) {
  SpinConfig config = kConfig;
  config.prior = {.axis_icrf = Eigen::Vector3d::UnitX(), .sigma_rad = 0.017};
  SpinEstimate estimate = estimate_of({Quality::Ok});
  PassNotices notices{config};
  notices.estimated(estimate);
  EXPECT_THAT(taken(notices), IsEmpty());
  estimate.axis_icrf = {std::cos(0.2), std::sin(0.2), 0.0};
  notices.estimated(estimate);
  notices.estimated(estimate);
  EXPECT_THAT(taken(notices),
              ElementsAre(HasSubstr("11.5 deg from the prior of the mission, 12 times")));
  notices.prior_set(*config.prior);
  notices.estimated(estimate);
  EXPECT_THAT(taken(notices), ElementsAre(HasSubstr("from the prior of the operator, 12 times")));
}

}  // namespace spindrift::testing::pass_notices_test
