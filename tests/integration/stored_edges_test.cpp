// What the archive gives to those who solve a stored run again.

#include "services/archive/stored_edges.h"

#include <gmock/gmock.h>
#include <gtest/gtest.h>

#include <cstdint>
#include <optional>
#include <utility>

#include "tests/integration/archive_fixture.h"

namespace spindrift::stored_edges_test {

using ::testing::HasSubstr;
using testing::start_of;

class ArchiveEdges : public testing::ArchiveFixture {
 protected:
  /// Of five edges of sun slit 2.
  void store_run(const std::string& run_id, std::optional<std::int64_t> revolution) const {
    ArchiveBatch batch = start_of(run_id);
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
  auto stored = read_edges(path(), "SPINNER", std::nullopt);
  ASSERT_TRUE(stored) << stored.error().message;
  EXPECT_EQ(stored->run_id, "run-1");
  EXPECT_EQ(std::move(stored->pass).edges().size(), 5U);
}

TEST_F(ArchiveEdges, ThatNoRevolutionHadAPlaceForMakeNoRun) {
  store_run("run-1", std::nullopt);
  const auto stored = read_edges(path(), "SPINNER", std::nullopt);
  ASSERT_FALSE(stored);
  EXPECT_THAT(stored.error().message, HasSubstr("no run of spacecraft 'SPINNER' with revolutions"));
}

}  // namespace spindrift::stored_edges_test
