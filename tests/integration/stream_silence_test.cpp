// Silences of a stream: among the samples, in the archive, and after a restart.

#include <gtest/gtest.h>

#include <chrono>
#include <filesystem>
#include <utility>
#include <vector>

#include "services/mission/mission.h"
#include "services/processor/processor.h"
#include "services/serving/link_watch.h"
#include "services/telemetry/telemetry_files.h"
#include "services/telemetry/telemetry_stream.h"
#include "tests/integration/archive_fixture.h"
#include "tests/support/archive_rows.h"
#include "tests/support/recorded_edges.h"
#include "tests/support/samples.h"
#include "tests/support/test_paths.h"

namespace spindrift::stream_silence_test {

using ::testing::ElementsAre;

using namespace std::chrono_literals;

const std::filesystem::path kPass = recorded_passes() / "nominal";
constexpr std::size_t kBefore = 120;
constexpr std::size_t kAll = 180;

Processor new_processor() {
  return testing::live_processor({load_mission(kPass / "mission.toml").value()});
}

testing::Samples edges(std::size_t count) { return testing::edges_of(kPass, count); }

struct StreamSilence : testing::ArchiveFixture {
  /// Receives edges, a silence, an edge from just before it, and more edges.
  void receive() const {
    const testing::Samples all = edges(kAll);
    const auto middle = all.begin() + kBefore;
    TelemetrySample<Pulse> late = *std::prev(middle);
    late.value.t -= 20ms;
    late.origin.seq = 1'000'000;
    const auto archive = open();
    Processor processor = new_processor();
    testing::submit(*archive, processor.begin());
    const auto take = [&](testing::Samples samples) {
      testing::work(processor,
                    processor.route(testing::batch_of_samples<Pulse>(std::move(samples))),
                    *archive);
    };
    take({all.begin(), middle});
    testing::work(processor, processor.fall_silent({"SPINNER"}), *archive);
    EXPECT_TRUE(processor.fall_silent({"SPINNER"}).samples.empty());
    take({late});
    take({middle, all.end()});
    EXPECT_TRUE(archive->close());
  }
};

TEST_F(StreamSilence, IsStoredAndRepeatedByARestart) {
  receive();
  EXPECT_EQ(count("stream_silence"), 1);
  EXPECT_EQ(count("pulse WHERE arrival < (SELECT arrival FROM stream_silence)"), kBefore);
  EXPECT_EQ(count("pulse_use WHERE rejected_by = 'late'"), 1);
  const auto rows = product_rows(path());

  Processor processor = new_processor();
  auto gone_on = processor.go_on(path()).value();
  const auto archive = open();
  testing::work(processor, std::move(gone_on.routed), *archive);
  EXPECT_TRUE(archive->close());
  EXPECT_EQ(product_rows(path()), rows);
}

/// Returns the times of the batch solutions that become due.
std::vector<TaiTime> solved(Processor& processor, const Routed& routed) {
  std::vector<TaiTime> times;
  for (const PassInput& input : routed.work) {
    processor.compute(input);
    for (const BackgroundTask& task : processor.take_background_tasks(input)) {
      const auto products = task.solve().value();
      for (const Product& product : products) {
        if (const auto* const estimate = std::get_if<SpinEstimate>(&product)) {
          times.push_back(estimate->t);
        }
      }
    }
  }
  return times;
}

TEST_F(StreamSilence, HasTheBatchSolutionOfAllThatCameAndNoneTwice) {
  for (const int edges_behind_a_minute : {24, 180}) {
    SCOPED_TRACE(edges_behind_a_minute);
    const testing::Samples all = edges(static_cast<std::size_t>(360 + edges_behind_a_minute));
    Processor processor = new_processor();
    processor.begin();
    const auto meanwhile =
        solved(processor, processor.route(testing::batch_of_samples<Pulse>(testing::Samples(all))));
    EXPECT_EQ(meanwhile.size(), 1U);
    const auto in_silence = solved(processor, processor.fall_silent({"SPINNER"}));
    ASSERT_EQ(in_silence.size(), 1U);
    EXPECT_GT(in_silence.front(), all.back().value.t - 2s);  // The last revolution is still open.
    EXPECT_TRUE(solved(processor, processor.fall_silent({"SPINNER"})).empty());
  }
}

TEST_F(StreamSilence, HasNoBatchSolutionBeforeTheFirstOfThePass) {
  Processor processor = new_processor();
  processor.begin();
  solved(processor, processor.route(testing::batch_of_samples<Pulse>(edges(180))));
  EXPECT_TRUE(solved(processor, processor.fall_silent({"SPINNER"})).empty());
}

TEST(SilenceWatch, TellsOnceWhoWasNotHeardForASecond) {
  SilenceWatch watch;
  const SilenceWatch::Instant start{};
  EXPECT_FALSE(watch.next());
  watch.hear("A", start);
  watch.hear("B", start + 300ms);
  EXPECT_EQ(watch.next(), start + 1s);
  EXPECT_TRUE(watch.take_silent(start + 999ms).empty());
  EXPECT_THAT(watch.take_silent(start + 1s), ElementsAre("A"));
  EXPECT_EQ(watch.next(), start + 1300ms);
  watch.hear("B", start + 1200ms);
  EXPECT_TRUE(watch.take_silent(start + 1300ms).empty());
}

TEST(SilenceWatch, CountsNoPauseThatBeginsTooEarly) {
  const SilenceWatch::Instant start{};
  SilenceWatch watch{start + 15s};
  watch.hear("A", start + 2s);
  EXPECT_EQ(watch.next(), start + 16s);
  EXPECT_TRUE(watch.take_silent(start + 12s).empty());
  watch.hear("A", start + 15500ms);
  EXPECT_THAT(watch.take_silent(start + 16500ms), ElementsAre("A"));
}

}  // namespace spindrift::stream_silence_test
