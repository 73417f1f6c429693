// A service of a three-axis spacecraft that is killed during a pass.

#include <fmt/format.h>
#include <gtest/gtest.h>

#include <algorithm>
#include <chrono>
#include <filesystem>
#include <fstream>
#include <map>
#include <string>
#include <string_view>
#include <utility>
#include <variant>
#include <vector>

#include "services/mission/mission.h"
#include "services/operator/parse_action.h"
#include "services/processor/processor.h"
#include "tests/integration/archive_fixture.h"
#include "tests/support/any_front_end.h"
#include "tests/support/archive_rows.h"
#include "tests/support/recorded_edges.h"
#include "tests/support/three_axis_files.h"

namespace spindrift::three_axis_restart_test {

using ::testing::ElementsAre;

/// The pass is more than twice as long as what a restart recomputes.
constexpr testing::ThreeAxisScene kLongPass{.duration_s = 1300.0,
                                            .gyro_s = 1.0,
                                            .star_s = 10.0,
                                            .sun_s = 5.0,
                                            .separation = true,
                                            .commanded_deg = 0.0};
constexpr std::size_t kSamplesABatch = 13;
constexpr std::size_t kSilence = 90;  ///< Index of the batch before which the stream falls silent.

/// Returns the samples of one source in order of time, except that every 31st arrives nine samples
/// later, either late or within the reorder window.
std::vector<AnySample> disordered_samples(const std::filesystem::path& pass) {
  std::vector<AnySample> all = samples_in(pass, "SAT");
  for (std::size_t i = 22; i + 9 < all.size(); i += 31) {
    const auto first = all.begin() + static_cast<std::ptrdiff_t>(i);
    std::rotate(first, first + 1, first + 9);
  }
  return all;
}

template <class Value>
void spoil(Value& value) {
  for_each_column(value, [](std::string_view /*name*/, auto& member) { member = -member; });
}
void spoil(CodedFrame& /*frame*/) {}
void spoil(StarFix& fix) { fix.q_icrf_sensor *= Eigen::Quaterniond{0.8, 0.6, 0.0, 0.0}; }

/// Returns the samples with those of a second source: for every fifth sample a different value, at
/// once or (one in three) long after the first was processed; for every seventh an equal copy.
std::vector<AnySample> contradicted(const std::vector<AnySample>& samples) {
  std::vector<AnySample> all;
  std::multimap<std::size_t, AnySample> later;
  for (std::size_t i = 0; i < samples.size(); ++i) {
    all.push_back(samples[i]);
    for (auto due = later.equal_range(i); due.first != due.second; ++due.first) {
      all.push_back(due.first->second);
    }
    AnySample again = samples[i];
    std::visit(
        [&]<class Value>(TelemetrySample<Value>& sample) {
          sample.origin = {.source = "second", .session = 3, .seq = i};
          if constexpr (HasSender<Value>) {
            if (i % 5 == 1) {
              spoil(sample.value);
            }
          }
        },
        again);
    if (i % 5 == 1 && i % 3 == 0) {
      later.emplace(i + 60, again);
    } else if (i % 5 == 1 || i % 7 == 0) {
      all.push_back(again);
    }
  }
  return all;
}

std::vector<SampleBatch> in_batches(const std::vector<AnySample>& samples) {
  std::vector<SampleBatch> batches;
  for (std::size_t i = 0; i < samples.size(); ++i) {
    if (i % kSamplesABatch == 0) {
      batches.emplace_back();
    }
    std::visit(
        [&]<class Value>(TelemetrySample<Value> sample) {
          sample.place = {static_cast<std::int64_t>(i)};
          batches.back().samples.of<Value>().push_back(std::move(sample));
        },
        samples[i]);
  }
  return batches;
}

using Batches = std::vector<ArchiveBatch>;

/// Holds what is submitted to the archive: samples and products.
struct Submitted {
  Batches samples;
  Batches products;
  std::size_t solved = 0;  ///< Number of solutions of the separation among the products.
};

class ThreeAxisRestart : public testing::ArchiveFixture {
 protected:
  void SetUp() override {
    pass_ = directory() / "pass";
    std::filesystem::create_directory(pass_);
    testing::write_three_axis_pass(pass_, kLongPass);
    samples_ = disordered_samples(pass_);
    sent_ = in_batches(samples_);
    first_ns_ = tai_ns(sent_.front().samples.of<GyroSample>().front().value.t);
    said_ = parse_action({{"spacecraft", "SAT"},
                          {"by", "shift"},
                          {"action", "exclude_segment"},
                          {"channel", "sun"},
                          {"from_tai_ns", first_ns_ + 40'000'000'000},
                          {"to_tai_ns", first_ns_ + 80'000'000'000}},
                         known_spacecraft({load_mission(pass_ / "mission.toml").value()}))
                .value();
  }

  Processor new_processor() const {
    return testing::live_processor({load_mission(pass_ / "mission.toml").value()});
  }

  static void work(Processor& processor, Routed routed, Submitted& out) {
    std::move(routed.samples.begin(), routed.samples.end(), std::back_inserter(out.samples));
    for (const PassInput& input : routed.work) {
      Batches made = processor.compute(input);
      std::move(made.begin(), made.end(), std::back_inserter(out.products));
      for (BackgroundTask& task : processor.take_background_tasks(input)) {
        task.batch.products = task.solve().value();
        out.products.push_back(std::move(task.batch));
        ++out.solved;
      }
    }
  }

  /// Receives the batches `from` to `to` of the pass.
  void receive(Processor& processor, std::size_t from, std::size_t to, Submitted& out) const {
    for (std::size_t i = from; i < to; ++i) {
      if (i == kSilence) {
        work(processor, processor.fall_silent({"SAT"}), out);
      }
      if (i == says_at_) {
        SampleBatch said;
        said.actions = {said_};
        work(processor, processor.route(std::move(said)), out);
      }
      work(processor, processor.route(sent_[i]), out);
    }
  }

  static void store(const std::filesystem::path& db, Batches samples, Batches products) {
    const auto archive = Archive::open(db, {}).value();
    testing::submit(*archive, std::move(samples));
    testing::submit(*archive, std::move(products));
    ASSERT_TRUE(archive->close());
  }

  static void finish(Processor& processor, Submitted& out) {
    Batches last = processor.finish();
    std::move(last.begin(), last.end(), std::back_inserter(out.products));
  }

  /// Resumes from `db` and receives the rest of the pass.
  void go_on(const std::filesystem::path& db, std::size_t from) const {
    Processor processor = new_processor();
    Submitted rest;
    work(processor, processor.go_on(db).value().routed, rest);
    receive(processor, from, sent_.size(), rest);
    finish(processor, rest);
    store(db, rest.samples, rest.products);
  }

  /// Stores the results of a service that is not interrupted.
  void receive_unstopped(const std::filesystem::path& db) const {
    Processor unstopped = new_processor();
    Submitted whole;
    whole.samples = unstopped.begin();
    receive(unstopped, 0, sent_.size(), whole);
    finish(unstopped, whole);
    store(db, whole.samples, whole.products);
  }

  /// @param behind Number of last products that are lost in the kill.
  void receive_killed(const std::filesystem::path& db, std::size_t killed,
                      std::size_t behind) const {
    Processor processor = new_processor();
    Submitted first;
    first.samples = processor.begin();
    receive(processor, 0, killed, first);
    first.products.resize(first.products.size() - std::min(first.products.size(), behind));
    store(db, first.samples, first.products);
    go_on(db, killed);
  }

  /// @param after Numbers of batches after which the service is killed, one case each.
  void expect_the_same_killed(const std::vector<std::size_t>& after,
                              const std::filesystem::path& whole_db) const {
    const std::vector<std::string> rows = all_rows(whole_db);
    for (const std::size_t killed : after) {
      for (const std::size_t behind : {0U, 60U}) {
        SCOPED_TRACE(fmt::format("after {} batches, {} of products behind", killed, behind));
        const auto db = directory() / fmt::format("killed-{}-{}.db", killed, behind);
        receive_killed(db, killed, behind);
        ASSERT_EQ(all_rows(db), rows);
      }
    }
  }

  std::filesystem::path pass_;
  std::vector<AnySample> samples_;
  std::vector<SampleBatch> sent_;
  OperatorAction said_;  ///< Excludes a segment of the samples that the reconstruction uses.
  /// Index of the batch before which the action is taken, long after the segment.
  std::optional<std::size_t> says_at_;
  std::int64_t first_ns_ = 0;
};

TEST_F(ThreeAxisRestart, KilledAtAnyPointGivesWhatNoRestartWouldHave) {
  says_at_ = 80;
  const auto whole_db = directory() / "whole.db";
  receive_unstopped(whole_db);
  ASSERT_GT(count_rows(whole_db, "attitude WHERE source = 'mekf'"), 1000);
  for (const char* const gate : {"lost", "usable", "reached"}) {
    ASSERT_GT(count_rows(whole_db, fmt::format("gate_transition WHERE gate = '{}'", gate)), 0)
        << gate;
  }
  ASSERT_THAT(
      rows_of(whole_db, "SELECT method, event FROM reconstruction_event WHERE event = 'T1'"),
      ElementsAre("batch|T1|", "sequential|T1|"));
  ASSERT_THAT(rows_of(whole_db, "SELECT DISTINCT rejected_by FROM rejected_sample ORDER BY 1"),
              ElementsAre("innovation|", "late|", "saturated|"));

  // The solution uses samples up to two minutes after the first star fix.
  EXPECT_EQ(
      number_of(whole_db, "SELECT sun_vectors FROM reconstruction WHERE method = 'batch'"),
      number_of(whole_db,
                fmt::format("SELECT count(*) FROM sun_sample WHERE t_tai_ns - {0} <= 120000000000 "
                            "AND t_tai_ns - {0} NOT BETWEEN 40000000000 AND 79999999999",
                            first_ns_)));

  expect_the_same_killed(
      {std::size_t{1}, std::size_t{50}, kSilence, kSilence + 1, sent_.size() - 5, sent_.size()},
      whole_db);
}

TEST_F(ThreeAxisRestart, ContradictionsAreDecidedAsWithoutOne) {
  sent_ = in_batches(contradicted(samples_));
  for (const std::string preferred : {"", "second"}) {
    SCOPED_TRACE(preferred);
    if (!preferred.empty()) {
      std::ofstream{pass_ / "mission.toml", std::ios::app} << "[sources]\nprefer = \"" << preferred
                                                           << "\"\n";
    }
    const auto whole_db = directory() / fmt::format("whole-{}.db", preferred);
    receive_unstopped(whole_db);
    const std::vector<std::string> rows = all_rows(whole_db);
    ASSERT_GT(count_rows(whole_db, "attitude WHERE source = 'mekf'"), 500);
    // Late samples are only recorded; of two conflicting samples in time, none counts, or only the
    // second.
    const std::int64_t contested = number_of(
        whole_db, "SELECT count(*) FROM contradiction WHERE source = 'second' AND seq % 3 > 0");
    ASSERT_GT(contested, 100);
    // If both were late, the first of them keeps its mark.
    ASSERT_EQ(
        count_rows(
            whole_db,
            "contradiction WHERE used = 1 AND source = 'front-end' AND t_tai_ns NOT IN (SELECT "
            "t_tai_ns FROM contradiction WHERE source = 'second' AND seq % 3 = 0) AND t_tai_ns NOT "
            "IN (SELECT t_tai_ns FROM rejected_sample WHERE rejected_by = 'late')"),
        0);
    const std::int64_t left_out = number_of(
        whole_db, "SELECT count(*) FROM rejected_sample WHERE rejected_by = 'contradicted'");
    ASSERT_EQ(left_out == 0, !preferred.empty());
    const auto db = directory() / fmt::format("killed-{}.db", preferred);
    receive_killed(db, preferred.empty() ? kSilence + 1 : std::size_t{40}, 20);
    ASSERT_EQ(all_rows(db), rows);
  }
}

/// Twenty consecutive stamps are half an hour ahead, and as many single ones are beyond the hour
/// that ends a pass.
TEST_F(ThreeAxisRestart, StrayStampsAreLeftOutHoweverItIsKilled) {
  std::vector<AnySample> samples = disordered_samples(pass_);
  std::size_t seen = 0;
  for (AnySample& sample : samples) {
    auto* const gyro = std::get_if<TelemetrySample<GyroSample>>(&sample);
    if (gyro == nullptr) {
      continue;
    }
    if (seen >= 300 && seen < 320) {
      gyro->value.t += std::chrono::minutes{30};
    } else if (seen >= 400 && seen < 800 && seen % 20 == 0) {
      gyro->value.t += std::chrono::hours{2};
    }
    ++seen;
  }
  sent_ = in_batches(samples);
  const auto whole_db = directory() / "whole.db";
  receive_unstopped(whole_db);
  ASSERT_EQ(count_rows(whole_db, "run"), 1);
  ASSERT_EQ(count_rows(whole_db, "rejected_sample WHERE rejected_by = 'out_of_time'"), 40);
  // The service is killed among both groups and after them.
  expect_the_same_killed({std::size_t{31}, std::size_t{60}, sent_.size() - 5}, whole_db);
}

TEST_F(ThreeAxisRestart, MakesOnlyTheLastTenMinutesAgain) {
  const auto db = directory() / "stopped.db";
  Processor processor = new_processor();
  Submitted first;
  first.samples = processor.begin();
  receive(processor, 0, sent_.size(), first);
  store(db, first.samples, first.products);
  ASSERT_GT(first.solved, 10U);
  const std::int64_t last =
      number_of(db, "SELECT max(t_tai_ns) FROM attitude WHERE source = 'mekf'");

  Processor restarted = new_processor();
  Submitted again;
  work(restarted, restarted.go_on(db).value().routed, again);
  EXPECT_EQ(again.solved, 0U);
  ASSERT_FALSE(again.products.empty());
  ASSERT_TRUE(again.products.front().continuation);
  EXPECT_EQ(tai_ns(again.products.front().continuation->t), last - 600'000'000'000);
}

}  // namespace spindrift::three_axis_restart_test
