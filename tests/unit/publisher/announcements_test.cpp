#include "services/publisher/announcements.h"

#include "tests/support/matchers.h"

namespace spindrift::announcements_test {

Product fix(std::int64_t revolution, bool accepted, Resolution resolution) {
  return SpinFix{.revolution = revolution,
                 .t = {},
                 .geometry_case = 3,
                 .axis_icrf = Eigen::Vector3d::UnitZ(),
                 .covariance_rad2 = Eigen::Matrix2d::Identity(),
                 .alternates = {},
                 .resolution = resolution,
                 .norm = 1.0,
                 .accepted = accepted};
}

/// Returns an estimate that is identified by its number of fixes.
Product estimate(std::int64_t fixes) {
  return SpinEstimate{.t = {},
                      .estimator = SpinEstimator::Mean,
                      .axis_icrf = Eigen::Vector3d::UnitZ(),
                      .covariance_rad2 = Eigen::Matrix2d::Identity(),
                      .spin_rate_rad_s = 1.0,
                      .spin_rate_sigma_rad_s = 0.1,
                      .assessment = {Quality::Ok, {{ReasonCode::Fixes, {{"count", fixes}}}}}};
}

/// Returns spacecraft and the revolution of a fix or the number of fixes of an estimate.
std::vector<std::string> shown(const std::vector<Announcement>& announcements) {
  std::vector<std::string> texts;
  for (const Announcement& announcement : announcements) {
    const auto* fix = std::get_if<SpinFix>(&announcement.product);
    if (fix != nullptr) {
      texts.push_back(announcement.spacecraft + " " + std::to_string(fix->revolution));
      continue;
    }
    const Reason& rests_on =
        std::get<SpinEstimate>(announcement.product).assessment.reasons.front();
    texts.push_back(announcement.spacecraft + " fixes " +
                    std::to_string(std::get<std::int64_t>(rests_on.values.front().value)));
  }
  return texts;
}

TEST(Announcements, LeavesOutAFixThatIsNeitherAcceptedNorAmbiguous) {
  Announcements waiting;
  waiting.enqueue(
      "SPINNER", "run-1",
      std::vector{fix(1, true, Resolution::Geometry), fix(2, false, Resolution::Geometry),
                  fix(3, false, Resolution::Ambiguous), estimate(4)});
  EXPECT_EQ(shown(waiting.take_all()),
            (std::vector<std::string>{"SPINNER 1", "SPINNER 3", "SPINNER fixes 4"}));
}

TEST(Announcements, KeepsAllAsLongAsTheyAreFew) {
  Announcements waiting;
  for (std::size_t i = 0; i < Announcements::kMaxWaiting; ++i) {
    waiting.enqueue("SPINNER", "run-1", std::vector{estimate(static_cast<std::int64_t>(i))});
  }
  EXPECT_EQ(waiting.take_all().size(), Announcements::kMaxWaiting);
}

TEST(Announcements, KeepsTheLatestOfEachSpacecraftAndKindWhenTheyPileUp) {
  Announcements waiting;
  waiting.enqueue("QUIET", "run-1", std::vector{estimate(1)});
  for (std::size_t i = 0; i < Announcements::kMaxWaiting; ++i) {
    waiting.enqueue("SPINNER", "run-1",
                    std::vector{fix(static_cast<std::int64_t>(i), true, Resolution::Prior),
                                estimate(static_cast<std::int64_t>(i))});
  }
  const auto texts = shown(waiting.take_all());
  const std::string last = std::to_string(Announcements::kMaxWaiting - 1);
  EXPECT_LE(texts.size(), Announcements::kMaxWaiting);
  EXPECT_EQ(texts.front(), "QUIET fixes 1");
  EXPECT_EQ(texts.at(texts.size() - 2), "SPINNER " + last);
  EXPECT_EQ(texts.back(), "SPINNER fixes " + last);
}

TEST(Announcements, GivesWhatWaitsAndThenNothingOnceClosed) {
  Announcements waiting;
  waiting.enqueue("SPINNER", "run-1", std::vector{estimate(7)});
  waiting.close();
  EXPECT_EQ(shown(waiting.take_all()), std::vector<std::string>{"SPINNER fixes 7"});
  EXPECT_TRUE(waiting.take_all().empty());
}

}  // namespace spindrift::announcements_test
