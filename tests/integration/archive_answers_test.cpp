#include <sqlite3.h>

#include <string>
#include <vector>

#include "pipelines/frames/angle.h"
#include "services/archive/archive.h"
#include "tests/integration/archive_fixture.h"
#include "tests/support/matchers.h"

namespace spindrift::archive_answers_test {

using testing::attitude_at;
using testing::batch_of;
using testing::estimate_at;
using testing::start_of;
using testing::with_products;

/// Views of the archive on the products of a run: its answers and its verdict.
class ArchiveAnswers : public testing::ArchiveFixture {};

TEST_F(ArchiveAnswers, VerdictOfAPassIsTheAnswerInForce) {
  std::vector<ArchiveBatch> runs{start_of("0")};
  std::vector<Product> estimates;
  for (const SpinEstimator estimator :
       {SpinEstimator::Mean, SpinEstimator::Sequential, SpinEstimator::Batch}) {
    estimates.emplace_back(estimate_at(1, estimator, 20.0));
    estimates.emplace_back(estimate_at(2, estimator, 30.0));
    runs.push_back(with_products(start_of(std::to_string(estimates.size())), estimates));
  }
  store(runs);

  EXPECT_THAT(texts("SELECT format('%s %.3g %s: %s', ifnull(estimator, '-'), ifnull(dec_deg, 0), "
                    "why, against) FROM pass_verdict ORDER BY run_id"),
              ElementsAre("- 0 no estimate: no estimate",
                          "mean 30 OK: ", "sequential 30 OK: ", "batch 30 OK: "));
}

TEST_F(ArchiveAnswers, VerdictHasTheEllipseAndHowFarTheTelemetryReaches) {
  constexpr std::int64_t kNewYear2017_ns = 1'483'228'837'000'000'000;
  ArchiveBatch batch = start_of("run-1");
  batch.reach = {.first = tai_from_ns(kNewYear2017_ns),
                 .last = tai_from_ns(kNewYear2017_ns + 1'500'000'000),
                 .contact_share = 0.75};
  batch.products = {estimate_at(1, SpinEstimator::Mean, 20.0)};
  store(batch);
  EXPECT_EQ(text("SELECT format('%d %d %d %s %s %g', cov_east_east_deg2 > 0, cov_north_north_deg2 "
                 "> cov_east_east_deg2, cov_xx_deg2 IS NULL, start_utc, end_utc, contact_share) "
                 "FROM pass_verdict"),
            "1 1 1 2017-01-01T00:00:00.000Z 2017-01-01T00:00:01.500Z 0.75");
}

TEST_F(ArchiveAnswers, VerdictSaysWhichPartOfSigmaIsAlignment) {
  store_run({estimate_at(1, SpinEstimator::Mean, 20.0)});
  SQLite::Database database{path().string(), SQLite::OPEN_READWRITE};
  const auto with = [&](const std::string& sigma, const std::string& noise) {
    database.exec("UPDATE spin_estimate SET sigma_deg = " + sigma + ", noise_sigma_deg = " + noise);
    return text("SELECT format('%s: %s', why, against) FROM pass_verdict");
  };
  EXPECT_EQ(with("0.42", "0.09"), "OK; 0.41 of 0.42 deg is alignment: ");
  EXPECT_EQ(with("0.0005", "0.0003"), "OK; 0.0004 of 0.0005 deg is alignment: ");
  EXPECT_EQ(with("0.5", "0.49999"), "OK: ");
  EXPECT_EQ(with("0.5", "0.5"), "OK: ");
  EXPECT_EQ(text("SELECT consider_sigma_deg FROM pass_verdict"), "0.5");
}

/// Returns the number of virtual-machine steps of SQLite for the verdict of run-1.
int steps_to_verdict(const SQLite::Database& database) {
  sqlite3_stmt* query = nullptr;
  EXPECT_EQ(
      sqlite3_prepare_v2(database.getHandle(), "SELECT * FROM pass_verdict WHERE run_id = 'run-1'",
                         -1, &query, nullptr),
      SQLITE_OK);
  EXPECT_EQ(sqlite3_step(query), SQLITE_ROW);
  EXPECT_EQ(sqlite3_step(query), SQLITE_DONE);
  const int steps = sqlite3_stmt_status(query, SQLITE_STMTSTATUS_VM_STEP, 0);
  sqlite3_finalize(query);
  return steps;
}

TEST_F(ArchiveAnswers, VerdictOfADayIsFoundAsFastAsThatOfAMinute) {
  std::vector<int> steps;
  ArchiveBatch batch = start_of("run-1");
  int t = 0;
  for (const int last : {10, 1000}) {
    for (; t < last; ++t) {
      // The view also searches for answers that do not exist.
      batch.products.emplace_back(estimate_at(t, SpinEstimator::Mean, 20.0));
      batch.products.emplace_back(attitude_at(t, Quality::Ok));
    }
    store(batch);
    batch = batch_of("run-1");
    steps.push_back(steps_to_verdict(reader()));
  }
  EXPECT_LT(steps.back(), 2 * steps.front());
}

TEST_F(ArchiveAnswers, VerdictOfARunIsFoundAsFastAmongMany) {
  const auto archive = open();
  std::vector<int> steps;
  int run = 1;
  for (const int runs : {2, 40}) {
    for (; run <= runs; ++run) {
      commit(*archive, with_products(start_of("run-" + std::to_string(run)),
                                     {estimate_at(1, SpinEstimator::Mean, 20.0),
                                      estimate_at(1, SpinEstimator::Batch, 20.0),
                                      attitude_at(1, Quality::Ok)}));
    }
    steps.push_back(steps_to_verdict(reader()));
  }
  EXPECT_LT(steps.back(), 2 * steps.front());
}

TEST_F(ArchiveAnswers, VerdictOfAThreeAxisPassIsItsLastAttitude) {
  store_run(
      {attitude_at(7, Quality::Ok), attitude_at(8, Quality::Lost), attitude_at(9, Quality::Ok)});
  const std::string verdict =
      "SELECT format('%s %s %d %g %g', estimator, quality, ra_deg IS NULL, qw, sigma_deg) FROM "
      "pass_verdict";
  EXPECT_EQ(text(verdict), "mekf OK 1 0.5 6");

  store_more({RunFault{.t = tai_from_ns(10), .what = "no such sensor"}});
  EXPECT_EQ(text(verdict), "mekf DOUBTFUL 1 0.5 6");
}

TEST_F(ArchiveAnswers, VerdictOfARunThatFailedToComputeIsDoubtfulUnlessItIsLost) {
  const RunFault fault{.t = tai_from_ns(1'795'143'637'250'000'000), .what = "no such angle"};
  SpinEstimate lost = estimate_at(1, SpinEstimator::Mean, 20.0);
  lost.assessment.quality = Quality::Lost;
  store({with_products(start_of("1"), {fault}),
         with_products(start_of("2"), {fault, estimate_at(1, SpinEstimator::Mean, 30.0)}),
         with_products(start_of("3"), {fault, lost})});

  const std::string failed = "computing failed at 2026-11-20T03:00:00.250Z: no such angle";
  EXPECT_THAT(
      texts("SELECT format('%s %.3g %s', quality, ifnull(dec_deg, 0), why) FROM pass_verdict ORDER "
            "BY run_id"),
      ElementsAre("DOUBTFUL 0 " + failed + "; no estimate", "DOUBTFUL 30 " + failed + "; OK",
                  "LOST 20 " + failed + "; LOST"));
  EXPECT_THAT(texts("SELECT against FROM pass_verdict ORDER BY run_id"),
              ElementsAre(failed + "; no estimate", failed, failed + "; LOST"));
}

TEST_F(ArchiveAnswers, AnswerOfAPassIsTheLastEstimateOfEachEstimator) {
  store_run({estimate_at(10, SpinEstimator::Mean, 1.0), estimate_at(30, SpinEstimator::Mean, 3.0),
             estimate_at(20, SpinEstimator::Mean, 2.0),
             estimate_at(15, SpinEstimator::Batch, 4.0)});

  EXPECT_THAT(texts("SELECT format('%s %s %d %.6f', spacecraft_id, estimator, t_tai_ns, dec_deg) "
                    "FROM pass_answer ORDER BY estimator"),
              ElementsAre("SPINNER batch 15 4.000000", "SPINNER mean 30 3.000000"));
}

TEST_F(ArchiveAnswers, EstimatorsDisagreeBeyondThreeOfTheLargerSigma) {
  const double sigma_deg = 3e-4 / kRadPerDeg;
  SpinEstimate better = estimate_at(10, SpinEstimator::Batch, 1.0);
  better.covariance_rad2 *= 0.25;
  store_run({estimate_at(10, SpinEstimator::Sequential, 1.0 + 2.9 * sigma_deg), better,
             estimate_at(10, SpinEstimator::Mean, 1.0 - 3.1 * sigma_deg)});

  EXPECT_THAT(
      texts("SELECT format('%s %s %.4f %d', one, other, apart_sigmas, disagree) FROM "
            "spin_comparison ORDER BY one, other"),
      ElementsAre("mean batch 3.1000 1", "mean sequential 6.0000 1", "sequential batch 2.9000 0"));
}

TEST_F(ArchiveAnswers, VerdictIsNoBetterThanWhatTheEstimatorsContradictEachOtherIn) {
  const double sigma_deg = 3e-4 / kRadPerDeg;
  struct Run {
    const char* run_id;
    Quality sequential;
    double apart_sigmas;
    Quality batch;
    const char* verdict;
  };
  using enum Quality;
  for (const Run& run :
       {Run{"1", Ok, 4.9, Ok, "OK"}, Run{"2", Ok, 5.1, Ok, "DOUBTFUL"},
        Run{"3", Ambiguous, 1.0, Ok, "OK"}, Run{"4", Ambiguous, 9.0, Ok, "OK"},
        Run{"5", Doubtful, 9.0, Ok, "OK"}, Run{"6", Ok, 9.0, Converging, "OK"},
        Run{"7", Lost, 9.0, Lost, "LOST"}, Run{"8", Ambiguous, 9.0, Ambiguous, "AMBIGUOUS"}}) {
    SpinEstimate one = estimate_at(1, SpinEstimator::Sequential, run.apart_sigmas * sigma_deg);
    SpinEstimate other = estimate_at(1, SpinEstimator::Batch, 0.0);
    one.assessment.quality = run.sequential;
    other.assessment.quality = run.batch;
    store(with_products(start_of(run.run_id), {one, other}));
    EXPECT_EQ(text(fmt::format("SELECT quality FROM pass_verdict WHERE run_id = '{}'", run.run_id)),
              run.verdict)
        << run.run_id;
  }
  EXPECT_EQ(text("SELECT why FROM pass_verdict WHERE run_id = '2'"),
            "sequential and batch disagree by 0.088 deg, 5.1 sigma; OK");
  EXPECT_EQ(text("SELECT why FROM pass_verdict WHERE run_id = '3'"), "OK");
  EXPECT_EQ(text("SELECT against FROM pass_verdict WHERE run_id = '8'"), "AMBIGUOUS");
}

TEST_F(ArchiveAnswers, AnswerOfBeforeAManoeuvreIsNoneOnceAnotherCameAfterIt) {
  ArchiveBatch batch = start_of("run-1");
  batch.products = {estimate_at(5, SpinEstimator::Batch, 0.0)};
  batch.actions = {{.action_id = "1",
                    .spacecraft = batch.spacecraft_id,
                    .t = tai_from_ns(7),
                    .made_utc = "2026-11-20T03:00:00Z",
                    .by = "operator",
                    .action = "mark_manoeuvre",
                    .arguments = "{}",
                    .note = "",
                    .does = SpinAction{MarkManoeuvre{}}}};
  store(batch);
  const auto reported = [&] { return text("SELECT estimator FROM pass_verdict"); };
  EXPECT_EQ(reported(), "batch");

  store_more({estimate_at(8, SpinEstimator::Sequential, 0.0)});
  EXPECT_EQ(reported(), "sequential");

  store_more({estimate_at(9, SpinEstimator::Batch, 0.0)});
  EXPECT_EQ(reported(), "batch");
}

}  // namespace spindrift::archive_answers_test
