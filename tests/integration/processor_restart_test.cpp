// A service that is killed while one pass ends and the next begins.

#include <fmt/format.h>
#include <gtest/gtest.h>

#include <algorithm>
#include <chrono>
#include <limits>
#include <set>
#include <string>
#include <utility>
#include <vector>

#include "services/simulation/pass_files.h"
#include "tests/integration/archive_fixture.h"
#include "tests/support/archive_rows.h"
#include "tests/support/recorded_edges.h"
#include "tests/support/samples.h"
#include "tests/support/test_paths.h"

namespace spindrift::processor_restart_test {

using testing::Samples;
using Batches = std::vector<ArchiveBatch>;

constexpr std::size_t kEdgesOfAPass = 180;
// The second pass is confirmed by its edge at 20 s, which is in the middle of a batch.
constexpr std::size_t kEdgesABatch = 13;
constexpr std::chrono::hours kSilence{2};

const std::filesystem::path kPass = recorded_passes() / "nominal";

/// Returns thirty revolutions and, after the silence, the same again without orbit coverage.
Samples two_passes() {
  Samples all = testing::edges_of(kPass, kEdgesOfAPass);
  for (std::size_t i = 0; i < kEdgesOfAPass; ++i) {
    TelemetrySample<Pulse> later = all[i];
    later.value.t += kSilence;
    later.origin.seq += 100'000;
    all.push_back(std::move(later));
  }
  return all;
}

Processor new_processor(const std::filesystem::path& pass = kPass) {
  return testing::live_processor({load_mission(pass / "mission.toml").value()});
}

/// Writes a pass of twenty minutes, twice what a restart recomputes.
void write_long_pass(const std::filesystem::path& folder) {
  Scenario scenario = load_scenario(scenarios() / "gto-nominal.toml").value();
  scenario.duration_s = 1200.0;
  ASSERT_TRUE(write_pass(folder, scenario, simulated_pass(scenario).value()));
}

/// Holds what is submitted to the archive, in order. Samples may overtake products there.
struct Submitted {
  Batches samples;
  Batches products;
  /// For each batch of products, the number of sample batches that must be stored before it.
  std::vector<std::size_t> samples_before;
  std::size_t solved = 0;  ///< Number of batch solutions.
  std::size_t left = 0;    ///< Number of due batch solutions that were not computed.

  void add_products(Batches batches) {
    for (ArchiveBatch& batch : batches) {
      samples_before.push_back(samples.size());
      products.push_back(std::move(batch));
    }
  }
};

constexpr std::size_t kAll = std::numeric_limits<std::size_t>::max();

/// @param solved Number of batch solutions to compute before time is up.
void work(Processor& processor, Routed routed, Submitted& out, std::size_t solved) {
  for (ArchiveBatch& batch : routed.samples) {
    out.samples.push_back(std::move(batch));
  }
  for (const PassInput& input : routed.work) {
    out.add_products(processor.compute(input));
    for (BackgroundTask& task : processor.take_background_tasks(input)) {
      if (out.solved == solved) {
        ++out.left;
        continue;
      }
      ++out.solved;
      task.batch.products = task.solve().value_or(std::vector<Product>{});
      out.add_products({std::move(task.batch)});
    }
  }
}

void receive(Processor& processor, const Samples& pulses, Submitted& out,
             std::size_t solved = kAll) {
  for (std::size_t i = 0; i < pulses.size(); i += kEdgesABatch) {
    work(processor,
         processor.route(
             testing::batch_of_samples<Pulse>(testing::part_of(pulses, i, i + kEdgesABatch))),
         out, solved);
  }
}

class ProcessorRestart : public testing::ArchiveFixture {
 protected:
  std::filesystem::path db(const std::string& name) const { return directory() / (name + ".db"); }

  static void store(const std::filesystem::path& db, Batches batches) {
    const auto archive = Archive::open(db, {}).value();
    testing::submit(*archive, std::move(batches));
    ASSERT_TRUE(archive->close());
  }

  static void store(const std::filesystem::path& db, const Submitted& all) {
    store(db, first(all, all.samples.size(), all.products.size()));
  }

  /// Resumes from `db` and receives the samples of `sent` that it does not contain.
  static Submitted go_on(const std::filesystem::path& db, const Samples& sent,
                         const std::filesystem::path& pass = kPass, std::size_t solved = kAll) {
    const auto rows = rows_of(db, "SELECT t_tai_ns, channel FROM pulse");
    const std::set<std::string> stored{rows.begin(), rows.end()};
    Samples missing;
    std::copy_if(sent.begin(), sent.end(), std::back_inserter(missing),
                 [&](const TelemetrySample<Pulse>& sample) {
                   return !stored.contains(fmt::format("{}|{}|", tai_ns(sample.value.t),
                                                       name_of(sample.value.channel)));
                 });
    Processor processor = new_processor(pass);
    Submitted out;
    work(processor, processor.go_on(db).value().routed, out, solved);
    receive(processor, missing, out, solved);
    out.add_products(processor.finish());
    return out;
  }

  /// Returns all rows and, for the main tables, the number of rows and the times of each run.
  static std::vector<std::string> rows(const std::filesystem::path& db) {
    std::vector<std::string> all = all_rows(db);
    for (const std::string& table :
         std::vector<std::string>{"revolution", "spin_fix", "pulse_use", "spin_estimate"}) {
      for (std::string& row :
           rows_of(db, fmt::format("SELECT '{0}', count(*), min(t_tai_ns), max(t_tai_ns) FROM {0} "
                                   "JOIN run USING (run_id) GROUP BY run_id ORDER BY 3",
                                   table))) {
        all.push_back(std::move(row));
      }
    }
    for (std::string& row : rows_of(
             db, "SELECT first_tai_ns, finished_utc IS NOT NULL FROM run ORDER BY first_arrival")) {
      all.push_back(std::move(row));
    }
    return all;
  }

  static Batches first(const Submitted& all, std::size_t samples, std::size_t products) {
    Batches batches{all.samples.begin(),
                    all.samples.begin() + static_cast<std::ptrdiff_t>(samples)};
    batches.insert(batches.end(), all.products.begin(),
                   all.products.begin() + static_cast<std::ptrdiff_t>(products));
    return batches;
  }

  static std::size_t most_products(const Submitted& all, std::size_t samples) {
    return static_cast<std::size_t>(
        std::count_if(all.samples_before.begin(), all.samples_before.end(),
                      [samples](std::size_t before) { return before <= samples; }));
  }
};

TEST_F(ProcessorRestart, KilledAtAnyPointBetweenTwoPassesGivesWhatNoRestartWouldHave) {
  const Samples sent = two_passes();
  Processor processor = new_processor();
  Submitted all;
  all.samples = processor.begin();
  receive(processor, sent, all);
  Submitted unstopped = all;
  unstopped.add_products(processor.finish());
  store(db("whole"), unstopped);
  const std::vector<std::string> whole = rows(db("whole"));
  ASSERT_EQ(count_rows(db("whole"), "run"), 2);
  ASSERT_EQ(count_rows(db("whole"), "revolution"), 2 * 30);

  const auto begun = std::find_if(all.samples.begin() + 1, all.samples.end(),
                                  [](const ArchiveBatch& batch) { return batch.start; });
  ASSERT_NE(begun, all.samples.end());
  const auto before = static_cast<std::size_t>(begun - all.samples.begin());
  for (std::size_t samples = before - 2; samples < before + 4; ++samples) {
    const std::size_t most = most_products(all, samples);
    for (std::size_t products = most < 4 ? 0 : most - 4; products <= most; ++products) {
      SCOPED_TRACE(fmt::format("{} batches of samples and {} of products", samples, products));
      const auto killed = db(fmt::format("killed-{}-{}", samples, products));
      store(killed, first(all, samples, products));
      const Submitted again = go_on(killed, sent);
      // The service is killed again with all samples and half of the products stored.
      store(killed, first(again, again.samples.size(), again.products.size() / 2));
      store(killed, go_on(killed, sent));
      ASSERT_EQ(rows(killed), whole);
    }
  }
}

/// Number of batch solutions computed before the service ends, and whether its end is orderly.
struct Ended {
  std::size_t solved;
  bool orderly;
};

TEST_F(ProcessorRestart, MakesEveryBatchSolutionThatIsNotStored) {
  const std::filesystem::path pass = directory() / "pass";
  write_long_pass(pass);
  const Samples sent = testing::edges_of(pass, kAll);
  const auto receive_all = [&](const Ended& ended) {
    Processor processor = new_processor(pass);
    Submitted all;
    all.samples = processor.begin();
    receive(processor, sent, all, ended.solved);
    if (ended.orderly) {
      all.add_products(processor.finish());
    }
    return all;
  };
  const Submitted whole = receive_all({.solved = kAll, .orderly = true});
  store(db("whole"), whole);
  ASSERT_EQ(whole.solved, 19U);
  ASSERT_EQ(count_rows(db("whole"), "spin_batch"), 20);

  for (const Ended& ended :
       {Ended{.solved = 0, .orderly = false}, Ended{.solved = 7, .orderly = false},
        Ended{.solved = 7, .orderly = true}}) {
    SCOPED_TRACE(fmt::format("{} solved, {}", ended.solved, ended.orderly ? "stopped" : "killed"));
    const auto restarted = db(fmt::format("{}-{}", ended.solved, ended.orderly));
    const Submitted before = receive_all(ended);
    ASSERT_EQ(before.left, whole.solved - ended.solved);
    store(restarted, before);
    const Submitted again = go_on(restarted, sent, pass, 2);
    // The service is killed again before the end.
    store(restarted, first(again, again.samples.size(), again.products.size() - 1));
    const Submitted rest = go_on(restarted, sent, pass);
    EXPECT_EQ(rest.solved, whole.solved - ended.solved - 2);
    store(restarted, rest);
    EXPECT_EQ(rows(restarted), rows(db("whole")));
  }
}

TEST_F(ProcessorRestart, ANewRunComesAfterAllThatIsStoredWhateverTheClockSays) {
  const Samples sent = two_passes();
  constexpr std::int64_t kFarAhead = 4'000'000'000'000'000'000;  // Time of a wrong clock, in 2096.
  ArchiveBatch earlier = testing::start_of("earlier");
  earlier.start->first_arrival = {kFarAhead};
  std::int64_t arrival = kFarAhead + static_cast<std::int64_t>(sent.size());
  for (const TelemetrySample<Pulse>& sample : sent) {
    earlier.samples.of<Pulse>().push_back({.spacecraft = sample.spacecraft,
                                           .origin = sample.origin,
                                           .value = sample.value,
                                           .arrival = {--arrival}});
  }
  store(db("clock"), {earlier});

  Processor processor = new_processor();
  ASSERT_TRUE(processor.arrive_after(db("clock")));
  Submitted all;
  all.samples = processor.begin();
  receive(processor, sent, all);
  store(db("clock"), all.samples);
  EXPECT_EQ(rows_of(db("clock"), "SELECT t_tai_ns, channel FROM pulse ORDER BY arrival"),
            rows_of(db("clock"), "SELECT t_tai_ns, channel FROM pulse ORDER BY t_tai_ns"));
  EXPECT_EQ(number_of(db("clock"), "SELECT min(first_arrival) FROM run"), kFarAhead);
  EXPECT_EQ(
      count_rows(db("clock"),
                 "pulse WHERE arrival >= (SELECT min(first_arrival) FROM run WHERE mode = 'live')"),
      static_cast<std::int64_t>(sent.size()));
}

}  // namespace spindrift::processor_restart_test
