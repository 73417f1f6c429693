// Series that the console derives because the archive does not hold them in that form.

#include "services/console/series.h"

#include <gtest/gtest.h>

#include <algorithm>
#include <string_view>

#include "tests/integration/archive_fixture.h"

namespace spindrift::series_test {
namespace {

constexpr std::int64_t kSecond_ns = 1'000'000'000;

class ArchiveView : public testing::ArchiveFixture {
 protected:
  /// Stores a run of these products and returns the series.
  std::vector<SeriesPoint> values(SpacecraftKind kind, std::string_view name,
                                  const std::vector<Product>& products) {
    ArchiveBatch run = testing::start_of("run");
    run.products = products;
    store(run);
    const auto& all = quantities_of(kind);
    const auto quantity =
        std::find_if(all.begin(), all.end(), [&](const Quantity& one) { return one.name == name; });
    EXPECT_NE(quantity, all.end()) << name;
    SQLite::Database database = reader();
    return values_of(database, "run", *quantity, {.from_tai_ns = 0, .to_tai_ns = 100 * kSecond_ns})
        .value();
  }
};

PulseUse edge(std::int64_t t_tai_ns, std::optional<std::int64_t> revolution,
              std::optional<Rejection> rejected_by = std::nullopt) {
  return {.pulse = {.t = tai_from_ns(t_tai_ns), .channel = PulseChannel::Sun2},
          .revolution = revolution,
          .rejected_by = rejected_by};
}

TEST_F(ArchiveView, HasThePhaseOfEveryEdgeBehindTheFirstOfItsTurn) {
  const auto found = values(
      SpacecraftKind::Spin, "phase_sun2",
      {RevolutionProduct{.revolution = 5, .t_sun1 = tai_from_ns(10 * kSecond_ns), .period_s = 2.0},
       edge(9 * kSecond_ns, std::nullopt, Rejection::Unassociated), edge(10'500'000'000, 5),
       edge(13 * kSecond_ns, std::nullopt, Rejection::Unassociated)});
  ASSERT_EQ(found.size(), 2U);  // The first edge has no predicted phase.
  EXPECT_DOUBLE_EQ(found[0].value, 90.0);
  EXPECT_EQ(found[0].accepted, true);
  EXPECT_DOUBLE_EQ(found[1].value, 180.0);
  EXPECT_EQ(found[1].accepted, false);
  EXPECT_EQ(found[1].rejected_by, "unassociated");
}

TEST_F(ArchiveView, SaysWhichAcceptedEdgesTheFilterLeftOut) {
  PulseUse left_out = edge(10'500'000'000, 5);
  left_out.said = Observation{.t = left_out.pulse.t,
                              .source = SampleSource::Sun2,
                              .residual = {.freedom = 1,
                                           .value = Eigen::Vector3d{6e-3, 0.0, 0.0},
                                           .sigma = Eigen::Vector3d{1e-3, 0.0, 0.0}},
                              .nis = 36.0,
                              .limit = 25.0,
                              .rejected_by = Rejection::Innovation};
  const auto found = values(
      SpacecraftKind::Spin, "phase_sun2",
      {RevolutionProduct{.revolution = 5, .t_sun1 = tai_from_ns(10 * kSecond_ns), .period_s = 2.0},
       left_out, edge(11 * kSecond_ns, 5)});
  ASSERT_EQ(found.size(), 2U);
  EXPECT_EQ(found[0].accepted, true);
  EXPECT_EQ(found[0].used, false);
  EXPECT_EQ(found[0].held, (HeldAgainst{.off = 6.0, .limit = 5.0, .unit = "sigma"}));
  EXPECT_EQ(found[1].used, std::nullopt);  // The edge was not tested.
}

TEST_F(ArchiveView, HasInnovationsAsNormalDeviates) {
  const auto attitude = [](std::int64_t t_tai_ns, const Innovations& innovations) {
    return AttitudeEstimate{.t = tai_from_ns(t_tai_ns),
                            .q_icrf_body = Eigen::Quaterniond::Identity(),
                            .rate_body_rad_s = std::nullopt,
                            .covariance_rad2 = Eigen::Matrix3d::Identity() * 1e-6,
                            .assessment = {},
                            .innovations = innovations};
  };
  // Chi-square quantiles: 0.5 with 3 degrees of freedom, 0.99865 (3 sigma) with 5.
  const auto found = values(
      SpacecraftKind::ThreeAxis, "innovation",
      {attitude(kSecond_ns, {.squared = 2.365974, .freedom = 3}), attitude(2 * kSecond_ns, {}),
       attitude(3 * kSecond_ns, {.squared = 19.8223, .freedom = 5}),
       RejectedSample{.t = tai_from_ns(4 * kSecond_ns),
                      .kind = SampleKind::Sun,
                      .rejected_by = Rejection::Innovation,
                      .failed = FailedTest{.value = 100.0, .limit = 28.7}}});
  ASSERT_EQ(found.size(), 3U);
  EXPECT_NEAR(found[0].value, 0.0, 0.02);
  EXPECT_NEAR(found[1].value, 3.0, 0.05);
  EXPECT_GT(found[2].value, 5.0);
  EXPECT_EQ(found[2].accepted, false);
  EXPECT_EQ(found[2].rejected_by, "innovation, sun");
}

}  // namespace
}  // namespace spindrift::series_test
