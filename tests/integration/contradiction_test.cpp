// How the archive handles and returns samples that are received again with another value.

#include <fmt/format.h>

#include <cstdint>
#include <set>
#include <string>
#include <vector>

#include "services/archive/stored_pass.h"
#include "services/archive/stored_separation.h"
#include "tests/integration/archive_fixture.h"
#include "tests/support/archive_rows.h"
#include "tests/support/matchers.h"

namespace spindrift::contradiction_test {

using testing::batch_of;
using testing::kRunStart;
using testing::start_of;

ArrivedSample<GyroSample> gyro(std::int64_t t, double wx, const std::string& source,
                               std::int64_t arrival) {
  return {.spacecraft = "SPINNER",
          .origin = {.source = source, .session = 7, .seq = static_cast<std::uint64_t>(arrival)},
          .value = {.t = tai_from_ns(t), .rate_body_rad_s = {wx, 0.0, -0.1}},
          .arrival = {arrival}};
}

constexpr const char* kContradictions =
    "SELECT run_id, kind, t_tai_ns, source, session, seq, format('%.10g', json_extract(value, "
    "'$.wx_rad_s')), used FROM contradiction ORDER BY 1, 3, 4, 7";

class ContradictionTest : public testing::ArchiveFixture {
 protected:
  void take(const std::string& run_id, std::vector<ArrivedSample<GyroSample>> samples,
            std::vector<Product> products = {}) {
    ArchiveBatch batch = batch_of(run_id);
    if (begun_.insert(run_id).second) {
      batch = start_of(run_id);
      batch.start->first_arrival = samples.front().arrival;
    }
    batch.reach = {.first = tai_from_ns(0), .last = tai_from_ns(0)};
    batch.preferred_source = preferred_;
    batch.samples.of<GyroSample>() = std::move(samples);
    store(batch);
    batch = batch_of(run_id);
    batch.products = std::move(products);
    store(batch);
  }

  /// Returns rate and sender number of each sample as a restarted service reads them.
  std::vector<std::string> read_back() {
    SenderNames senders{preferred_};
    std::vector<std::string> rows;
    const auto passes = find_stored_passes(path(), "SPINNER", kRunStart, senders).value();
    for (const Arrived<GyroSample>& arrived : passes.back().values.of<GyroSample>()) {
      rows.push_back(
          fmt::format("{} {} {} {}", arrived.arrival.number, tai_ns(arrived.value.t),
                      arrived.value.rate_body_rad_s.x(),
                      (*senders.names())[static_cast<std::size_t>(arrived.value.sender)]));
    }
    return rows;
  }
  std::vector<std::string> reconstructed_from(const std::string& preferred) {
    std::vector<std::string> rows;
    const auto samples =
        find_separation_samples(path(), "SPINNER", preferred, tai_from_ns(0)).value();
    for (const GyroSample& sample : samples.gyro) {
      rows.push_back(fmt::format("{} {}", tai_ns(sample.t), sample.rate_body_rad_s.x()));
    }
    return rows;
  }

  std::string preferred_;
  std::set<std::string> begun_;
};

TEST_F(ContradictionTest, EveryValueOfTheInstantHasARow) {
  take("r", {gyro(1, 0.5, "A", 1), gyro(2, 0.5, "A", 2), gyro(2, 0.6, "B", 3), gyro(2, 0.7, "A", 4),
             gyro(3, 0.5, "B", 5)});
  EXPECT_THAT(
      rows_of(path(), kContradictions),
      ElementsAre("r|gyro|2|A|7|2|0.5|1|", "r|gyro|2|A|7|4|0.7|0|", "r|gyro|2|B|7|3|0.6|0|"));
  EXPECT_EQ(count("gyro_sample"), 3);
  EXPECT_THAT(read_back(),
              ElementsAre("1 1 0.5 A", "2 2 0.5 A", "3 2 0.6 B", "4 2 0.7 A", "5 3 0.5 B"));
}

TEST_F(ContradictionTest, SentAgainOrWithOtherDigitsItIsOneSample) {
  take("r", {gyro(1, 0.1, "A", 1), gyro(1, 0.1, "B", 2), gyro(1, static_cast<double>(0.1F), "B", 3),
             gyro(1, 0.1000004, "C", 4)});
  EXPECT_THAT(rows_of(path(), kContradictions), IsEmpty());
  EXPECT_THAT(read_back(), ElementsAre("1 1 0.1 A"));
  take("r", {gyro(1, 0.2, "B", 5), gyro(1, 0.2, "B", 6), gyro(1, 0.1, "C", 7)});
  EXPECT_THAT(
      rows_of(path(), kContradictions),
      ElementsAre("r|gyro|1|A|7|1|0.1|1|", "r|gyro|1|B|7|5|0.2|0|", "r|gyro|1|C|7|7|0.1|0|"));
}

TEST_F(ContradictionTest, ThePassSaysWhichOfThemCounts) {
  const SampleContradiction neither{
      .t = tai_from_ns(1),
      .kind = "gyro",
      .by = {{Sender::First, false, "A"}, {Sender::First, false, "B"}}};
  take("r", {gyro(1, 0.1, "A", 1), gyro(1, 0.2, "B", 2)}, {neither});
  EXPECT_THAT(rows_of(path(), kContradictions),
              ElementsAre("r|gyro|1|A|7|1|0.1|0|", "r|gyro|1|B|7|2|0.2|0|"));
  SampleContradiction one = neither;
  one.by.back().used = true;
  take("r", {gyro(1, 0.2, "B", 3)}, {one});
  EXPECT_THAT(rows_of(path(), kContradictions),
              ElementsAre("r|gyro|1|A|7|1|0.1|0|", "r|gyro|1|B|7|2|0.2|1|"));
  SampleContradiction late = neither;
  late.late = true;
  take("r", {gyro(1, 0.3, "C", 4)}, {late});
  EXPECT_THAT(
      rows_of(path(), kContradictions),
      ElementsAre("r|gyro|1|A|7|1|0.1|0|", "r|gyro|1|B|7|2|0.2|1|", "r|gyro|1|C|7|4|0.3|0|"));
}

TEST_F(ContradictionTest, ThePreferredSourceStandsForWhatOthersGiveToo) {
  preferred_ = "B";
  take("r", {gyro(1, 0.1, "A", 1), gyro(1, 0.1, "B", 2), gyro(1, 0.2, "C", 3)});
  EXPECT_THAT(rows_of(path(), kContradictions),
              ElementsAre("r|gyro|1|B|7|2|0.1|1|", "r|gyro|1|C|7|3|0.2|0|"));
  EXPECT_THAT(read_back(), ElementsAre("1 1 0.1 B", "3 1 0.2 C"));
}

TEST_F(ContradictionTest, WhatAnEarlierRunTookHasNotComeInThisOne) {
  take("r", {gyro(1, 0.1, "A", 1)});
  take("s", {gyro(1, 0.2, "B", 11)});
  EXPECT_THAT(rows_of(path(), kContradictions),
              ElementsAre("s|gyro|1|A|7|1|0.1|0|", "s|gyro|1|B|7|11|0.2|1|"));
  EXPECT_THAT(read_back(), ElementsAre("11 1 0.2 B"));
  take("s", {gyro(1, 0.1, "A", 12)});
  EXPECT_THAT(read_back(), ElementsAre("11 1 0.2 B", "12 1 0.1 A"));
}

TEST_F(ContradictionTest, AReconstructionUsesNoneUnlessOneIsPreferred) {
  take("r",
       {gyro(1, 0.1, "A", 1), gyro(2, 0.1, "A", 2), gyro(2, 0.2, "B", 3), gyro(3, 0.2, "B", 4)});
  EXPECT_THAT(reconstructed_from(""), ElementsAre("1 0.1", "3 0.2"));
  EXPECT_THAT(reconstructed_from("A"), ElementsAre("1 0.1", "2 0.1", "3 0.2"));
  EXPECT_THAT(reconstructed_from("B"), ElementsAre("1 0.1", "2 0.2", "3 0.2"));
  // A later run receives the sample from one source only.
  take("s", {gyro(2, 0.1, "A", 12)});
  EXPECT_THAT(reconstructed_from(""), ElementsAre("1 0.1", "2 0.1", "3 0.2"));
}

}  // namespace spindrift::contradiction_test
