#include "pipelines/spin/sequential/hypotheses.h"

#include <Eigen/Core>
#include <cstddef>
#include <utility>
#include <vector>

#include "tests/support/matchers.h"
#include "tests/support/sequential_scene.h"

namespace spindrift::testing::hypotheses_test {

StartingPoint at(const Eigen::Vector3d& axis_icrf) {
  return {.axis_icrf = axis_icrf,
          .covariance_rad2 = kFixSigma_rad * kFixSigma_rad * Eigen::Matrix2d::Identity()};
}

/// Holds the true axis and a false one that the edges have ruled out.
struct Race {
  explicit Race(bool with_sun) {
    seen = scene.seen(0.0, 120.0);
    if (!with_sun) {
      seen = without_sun(std::move(seen));
    }
    add(scene.body.axis_icrf);
    add(scene.turned_about(scene.around.sun_icrf(0.0), 6.0));
    while (hypotheses.count() > 1) {
      run(1);
    }
  }

  void add(const Eigen::Vector3d& axis_icrf) {
    ASSERT_TRUE(hypotheses.try_start(at(axis_icrf), scene.body.config, seen[next].revolution,
                                     seen[next].sky));
  }
  void run(std::size_t revolutions) {
    for (const std::size_t end = next + revolutions; next < end; ++next) {
      hypotheses.work_in(scene.body.config, seen.at(next).revolution, seen.at(next).sky,
                         kStatedNoise);
    }
  }
  void name_the_true_axis() {
    hypotheses.count_fix({.points = {at(scene.body.axis_icrf)}, .fixes = 5});
  }
  /// Returns an axis on the cone about the Earth, which only sun edges rule out at once.
  Eigen::Vector3d on_cone() const {
    return scene.turned_about(seen.at(next).sky.spacecraft.position_icrf_km, 10.0);
  }

  Scene scene;
  std::vector<ObservedRevolution> seen;
  Hypotheses hypotheses;
  std::size_t next = 0;
};

TEST(Hypotheses, TheEdgesSettleWhatFixesHaveNamed) {
  Race race{true};
  EXPECT_FALSE(race.hypotheses.settled());
  race.name_the_true_axis();
  EXPECT_TRUE(race.hypotheses.settled());
}

TEST(Hypotheses, OneThatComesLateIsJudgedBeforeAnythingIsSettled) {
  Race race{true};
  race.add(race.on_cone());
  race.name_the_true_axis();
  EXPECT_TRUE(race.hypotheses.closed());
  EXPECT_FALSE(race.hypotheses.settled());
  race.run(20);
  EXPECT_TRUE(race.hypotheses.settled());
}

TEST(Hypotheses, OneThatComesLateIsNotBeatenForHavingKnownLittleAtFirst) {
  // The late candidate's first edges are e^3 times less likely because it is poorly known, and
  // later edges contribute little.
  Race race{false};
  race.add(race.on_cone());
  race.name_the_true_axis();
  race.run(10);
  const auto& all = race.hypotheses.all();
  ASSERT_EQ(all.size(), 2U);
  EXPECT_GT(all.front().log_likelihood - all.back().log_likelihood, 3.0);
  race.run(60);
  EXPECT_EQ(race.hypotheses.count(), 2U);
  EXPECT_FALSE(race.hypotheses.settled());
}

TEST(Hypotheses, OneThatIsAddedToWhatIsSettledOpensItAgain) {
  Race race{true};
  race.name_the_true_axis();
  race.add(race.on_cone());
  EXPECT_FALSE(race.hypotheses.closed());
  EXPECT_FALSE(race.hypotheses.settled());
}

}  // namespace spindrift::testing::hypotheses_test
