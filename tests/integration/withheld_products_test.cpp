// Spacecraft whose configuration leads to values that are not finite.

#include <gtest/gtest.h>

#include <cstdint>
#include <limits>
#include <string>
#include <utility>
#include <vector>

#include "pipelines/frames/angle.h"
#include "services/processor/withheld.h"
#include "tests/integration/archive_fixture.h"
#include "tests/support/recorded_edges.h"
#include "tests/support/samples.h"
#include "tests/support/test_paths.h"

namespace spindrift::withheld_products_test {

const std::filesystem::path kPass = recorded_passes() / "nominal";
constexpr std::int64_t kEdges = 240;

SpinConfig nominal() { return *load_mission(kPass / "mission.toml").value().spin(); }

/// Returns configurations with values that a mission file cannot contain.
std::vector<SpinConfig> configs_of_no_instrument() {
  std::vector<SpinConfig> configs(4, nominal());
  configs[0].north->mount_angle_rad = 1e-308 * kRadPerDeg;
  configs[1].sun_sensor.slit_cant_rad = 9e-299 * kRadPerDeg;
  configs[2].sun_sensor.slit_cant_rad = 89.99999999999999 * kRadPerDeg;
  configs[3].sun_sensor.slit_cant_rad = std::numeric_limits<double>::quiet_NaN();
  return configs;
}

struct WithheldProducts : testing::ArchiveFixture {
  /// Returns a processor for two spacecraft, one with the configuration `odd`.
  static Processor processor_of(const SpinConfig& odd) {
    std::vector<Mission> missions(2, load_mission(kPass / "mission.toml").value());
    missions[0].spacecraft_id = "ODD";
    missions[0].config = odd;
    missions[1].spacecraft_id = "SOUND";
    return testing::live_processor(missions);
  }

  /// Stores the edges of both spacecraft with their products, and then again from the stored edges.
  void serve_twice(const SpinConfig& odd) const {
    const auto archive = open();
    const auto store = [&](std::vector<ArchiveBatch> batches) {
      testing::submit(*archive, std::move(batches));
    };
    Processor processor = processor_of(odd);
    store(processor.begin());
    for (const std::string spacecraft : {"ODD", "SOUND"}) {
      store(processor.process(
          testing::batch_of_samples<Pulse>(testing::edges_of(kPass, kEdges, spacecraft))));
    }
    store(processor.finish());
    const auto stored = archive->flush();
    ASSERT_TRUE(stored) << stored.error().message;

    Processor restarted = processor_of(odd);
    testing::work(restarted, restarted.go_on(path()).value().routed, *archive);
    store(restarted.finish());
    const auto stored_again = archive->flush();
    EXPECT_TRUE(stored_again) << stored_again.error().message;
  }

  std::int64_t count_of(const std::string& spacecraft, const std::string& rows) const {
    return count("run JOIN " + rows + " WHERE run.spacecraft_id = '" + spacecraft + "'");
  }
};

TEST_F(WithheldProducts, StopNeitherTheirRunNorArchiveNorAnotherSpacecraft) {
  for (const SpinConfig& config : configs_of_no_instrument()) {
    std::filesystem::remove(path());
    serve_twice(config);
    for (const std::string spacecraft : {"ODD", "SOUND"}) {
      EXPECT_EQ(count_of(spacecraft, "pulse USING (spacecraft_id)"), kEdges);
      EXPECT_EQ(count_of(spacecraft, "pulse_use USING (run_id)"), kEdges);
    }
    EXPECT_EQ(count("run WHERE finished_utc IS NOT NULL"), 2);
    EXPECT_GT(count_of("SOUND", "spin_fix USING (run_id)"), 30);
  }
}

TEST(Withheld, LeavesOutWhatIsNotFiniteAndSaysWhyOnce) {
  const RevolutionProduct sound{.revolution = 1, .t_sun1 = {}, .period_s = 1.0};
  const RevolutionProduct endless{
      .revolution = 2, .t_sun1 = {}, .period_s = std::numeric_limits<double>::infinity()};
  Withheld withheld;
  SpinOutput output{.products = {endless, sound, endless}, .notices = {}};
  LastAnswers<SpinProduct> answers;
  withheld.take_from(output, answers);
  ASSERT_EQ(output.products.size(), 1U);
  const Notice why{.code = NoticeCode::NotFinite,
                   .values = {{"table", "revolution"}, {"column", "period_s"}}};
  EXPECT_EQ(output.notices, std::vector<Notice>{why});

  SpinOutput later{.products = {endless}, .notices = {}};
  withheld.take_from(later, answers);
  EXPECT_TRUE(later.products.empty());
  EXPECT_TRUE(later.notices.empty());
}

}  // namespace spindrift::withheld_products_test
