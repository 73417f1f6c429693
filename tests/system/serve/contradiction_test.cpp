// `spindrift serve` when two front-ends give different values of the same samples.

#include <fmt/format.h>

#include <chrono>
#include <csignal>
#include <vector>

#include "services/publisher/telemetry_publisher.h"
#include "services/telemetry/by_kind.h"
#include "services/telemetry/telemetry_files.h"
#include "services/telemetry/telemetry_stream.h"
#include "tests/support/archive_rows.h"
#include "tests/support/bus_fixture.h"
#include "tests/support/eventually.h"
#include "tests/support/matchers.h"
#include "tests/support/on_bus.h"
#include "tests/support/ran.h"
#include "tests/support/service.h"
#include "tests/support/test_paths.h"

namespace spindrift::serve_contradiction_test {

const std::filesystem::path kPass = test_data() / "faults" / "two-senders";

template <class Value>
std::vector<Value> values_of(const std::filesystem::path& file) {
  const std::vector<std::filesystem::path> paths{file};
  auto stream = TelemetryStream::open(scan_telemetry(paths).value(), "T").value();
  std::vector<Value> values;
  for (auto batch = stream.next().value(); !is_empty(batch); batch = stream.next().value()) {
    for (const TelemetrySample<Value>& sample : batch.samples.of<Value>()) {
      values.push_back(sample.value);
    }
  }
  return values;
}

/// Both front-ends send a star fix each second and take turns in being first; the service is killed
/// between the two.
TEST(ServeContradiction, NeitherIsUsedBeforeAndBehindAKill) {
  const TemporaryFolder folder;
  const auto db = folder.path() / "served.db";
  auto bus = bus_of_its_own();
  bus.partition = "replay";
  const Words serve = on(bus, {"serve", "--mission", kPass / "mission.toml", "--db", db, "--json"});
  auto participant = bus::Participant::create(bus).value();
  auto gyros = TelemetryPublisher<GyroSample>::create(participant, "front-end A").value();
  auto one = TelemetryPublisher<StarFix>::create(participant, "front-end A").value();
  auto other = TelemetryPublisher<StarFix>::create(participant, "front-end B").value();
  const auto gyro = values_of<GyroSample>(kPass / "gyro.csv");
  const auto star = values_of<StarFix>(kPass / "star.csv");
  const auto second = values_of<StarFix>(kPass / "second" / "star.csv");
  ASSERT_EQ(star.size(), second.size());

  std::size_t next_gyro = 0;
  const auto send = [&](std::size_t from, std::size_t to) {
    ASSERT_TRUE(one.wait_for_subscriber(std::chrono::seconds{30}));
    ASSERT_TRUE(other.wait_for_subscriber(std::chrono::seconds{30}));
    ASSERT_TRUE(gyros.wait_for_subscriber(std::chrono::seconds{30}));
    for (std::size_t i = from; i < to; ++i) {
      for (const bool first : {true, false}) {
        auto& publisher = first == (i % 2 == 0) ? one : other;
        ASSERT_TRUE(
            publisher.publish("T", first == (i % 2 == 0) ? star[i] : second[i], std::stop_token{}));
      }
      for (; next_gyro < gyro.size() && gyro[next_gyro].t <= star[i].t; ++next_gyro) {
        ASSERT_TRUE(gyros.publish("T", gyro[next_gyro], std::stop_token{}));
      }
    }
    ASSERT_TRUE(gyros.wait_for_acknowledgments(std::chrono::seconds{30}));
    ASSERT_TRUE(one.wait_for_acknowledgments(std::chrono::seconds{30}));
    ASSERT_TRUE(other.wait_for_acknowledgments(std::chrono::seconds{30}));
  };
  {
    Serving killed{serve};
    send(0, star.size() / 2);
    ASSERT_TRUE(eventually([&] {
      return count_rows(db, "contradiction") >= static_cast<std::int64_t>(star.size() / 2);
    }));
    killed.signal(SIGKILL);
    killed.exit_status();
  }
  serve_whole(serve, [&] { send(star.size() / 2, star.size()); });

  EXPECT_EQ(count_rows(db, "attitude"), 0);
  EXPECT_THAT(
      rows_of(db, "SELECT source, used, count(*) FROM contradiction GROUP BY 1, 2 ORDER BY 1"),
      ElementsAre(fmt::format("front-end A|0|{}|", star.size()),
                  fmt::format("front-end B|0|{}|", star.size())));
  EXPECT_THAT(
      rows_of(db,
              "SELECT key, count(*) FROM alert WHERE key LIKE 'link.contradiction:%' GROUP BY 1 "
              "ORDER BY 1"),
      ElementsAre("link.contradiction:front-end A|1|", "link.contradiction:front-end B|1|"));
  EXPECT_EQ(count_rows(db, "rejected_sample WHERE rejected_by = 'contradicted'"),
            static_cast<std::int64_t>(star.size()));
}

}  // namespace spindrift::serve_contradiction_test
