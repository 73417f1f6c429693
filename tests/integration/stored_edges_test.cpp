#include "services/archive/stored_edges.h"

#include <cstdint>
#include <optional>
#include <string>
#include <utility>
#include <variant>

#include "tests/integration/archive_fixture.h"
#include "tests/support/matchers.h"

namespace spindrift::stored_edges_test {

class ArchiveEdges : public testing::ArchiveFixture {
 protected:
  /// Stores a run with five edges of sun slit 2.
  void store_run(const std::string& run_id, std::optional<std::int64_t> revolution) {
    ArchiveBatch batch = testing::start_of(run_id);
    for (std::int64_t t_tai_ns = 0; t_tai_ns < 50; t_tai_ns += 10) {
      batch.products.emplace_back(
          PulseUse{.pulse = {.t = tai_from_ns(t_tai_ns), .channel = PulseChannel::Sun2},
                   .revolution = revolution,
                   .rejected_by = {}});
    }
    store(batch);
  }
};

TEST_F(ArchiveEdges, OfARunWithoutSun1AreThere) {
  store_run("run-1", 3);
  StoredEdges stored = value_or_throw(read_edges(path(), "SPINNER", std::nullopt));
  EXPECT_EQ(stored.run_id, "run-1");
  EXPECT_EQ(std::move(stored.pass).edges().size(), 5U);
}

/// The second fix is the first with several roots, 12 deg apart; the pass was settled on the other
/// root.
TEST_F(ArchiveEdges, HaveThePriorThatOperatorsToldInThePlaceOfTheMissions) {
  store_run("run-1", 3);
  const auto told_by = [&](std::int64_t t_tai_ns, const SpinAction& does, const char* action,
                           const char* arguments) {
    ArchiveBatch batch = testing::batch_of("run-1");
    batch.actions.push_back({.action_id = std::to_string(t_tai_ns),
                             .spacecraft = "SPINNER",
                             .t = tai_from_ns(t_tai_ns),
                             .made_utc = "2026-11-26T00:00:00Z",
                             .by = "shift",
                             .action = action,
                             .arguments = arguments,
                             .note = "",
                             .does = does,
                             .arrival = {t_tai_ns}});
    store(batch);
    return read_edges(path(), "SPINNER", std::nullopt)->told_prior;
  };
  ArchiveBatch fixes = testing::batch_of("run-1");
  for (const std::int64_t turn : {1, 2}) {
    fixes.products.emplace_back(
        SpinFix{.revolution = turn,
                .t = tai_from_ns(10 * turn),
                .geometry_case = 5,
                .axis_icrf = Eigen::Vector3d::UnitX(),
                .covariance_rad2 = 1e-6 * Eigen::Matrix2d::Identity(),
                .alternates = {},
                .resolution = turn == 1 ? Resolution::Geometry : Resolution::Prior,
                .norm = 1.0,
                .accepted = true});
  }
  auto& several = std::get<SpinFix>(fixes.products.back());
  several.axis_icrf = axis_icrf_from(12.0, 0.0);
  several.alternates = {{.axis_icrf = Eigen::Vector3d::UnitX()}};
  several.settled_before = Resolution::Geometry;
  store(fixes);
  const SetPrior prior{{.axis_icrf = axis_icrf_from(30.0, 40.0), .sigma_rad = 0.1}};
  constexpr const char* kPrior = R"({"ra_deg":30,"dec_deg":40,"sigma_deg":5})";
  EXPECT_FALSE(told_by(21, prior, "set_prior", kPrior)) << "the run has not come so far";
  const auto chosen = told_by(5, ChooseRoot{Eigen::Vector3d::UnitX()}, "choose_root",
                              R"({"ra_deg":1,"dec_deg":0})");
  ASSERT_TRUE(chosen);
  EXPECT_LT((chosen->axis_icrf - Eigen::Vector3d::UnitX()).norm(), 1e-12);
  EXPECT_NEAR(chosen->sigma_rad, 4.0 * kRadPerDeg, 1e-9);
  const auto set = told_by(15, prior, "set_prior", kPrior);
  ASSERT_TRUE(set);
  EXPECT_NEAR(set->sigma_rad, 5.0 * kRadPerDeg, 1e-9);
}

TEST_F(ArchiveEdges, ThatNoRevolutionHadAPlaceForMakeNoRun) {
  store_run("run-1", std::nullopt);
  EXPECT_THAT(read_edges(path(), "SPINNER", std::nullopt),
              IsRefused(ErrorCode::InvalidConfiguration,
                        HasSubstr("no run of spacecraft 'SPINNER' with revolutions")));
}

}  // namespace spindrift::stored_edges_test
