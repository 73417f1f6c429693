#include "services/alerts/alert_desk.h"

#include <algorithm>
#include <map>
#include <memory>
#include <string>
#include <vector>

#include "services/simulation/ground_model.h"
#include "services/simulation/pass_files.h"
#include "services/simulation/simulated_pass.h"
#include "tests/support/matchers.h"
#include "tests/support/scenario_text.h"
#include "tests/support/test_paths.h"
#include "tests/support/text_of.h"

namespace spindrift::alert_desk_test {

TaiTime at(double t_s) { return shifted(tai_from_ns(1'795'143'637'000'000'000), t_s); }

ArchiveBatch batch_of_run(const std::string& spacecraft = "SPINNER") {
  return {.run_id = "run", .spacecraft_id = spacecraft};
}

ArchiveBatch beginning(const std::string& spacecraft = "SPINNER") {
  ArchiveBatch batch = batch_of_run(spacecraft);
  batch.start.emplace().mode = RunMode::Live;
  return batch;
}

Mission spinner() { return load_mission(recorded_passes() / "nominal" / "mission.toml").value(); }

Mission three_axis() {
  Mission mission = load_mission(test_data() / "mission" / "separation.toml").value();
  mission.spacecraft_id = "LEOSAT";
  return mission;
}

std::vector<std::string> changes_in(const ArchiveBatch& batch) {
  std::vector<std::string> changes;
  for (const Product& product : batch.products) {
    const auto& alert = std::get<Alert>(product);
    changes.push_back(alert.key + " " + std::string{name_of(alert.state)});
  }
  return changes;
}

/// Holds the alert desk of a running service.
struct Served {
  AlertDesk desk;

  explicit Served(const Mission& mission = spinner()) : desk{{mission}, RunMode::Live} {
    ArchiveBatch start = beginning(mission.spacecraft_id);
    desk.evaluate(start);
    desk.note_stored({&start, 1});
  }
  std::vector<ArchiveBatch> silent(double t_s, double silent_s) {
    return desk.evaluate({{"SPINNER", {.t = at(t_s), .pass_t = at(t_s), .silent_s = silent_s}}},
                         at(t_s));
  }
};

using Changes = std::vector<std::string>;

TEST(AlertDesk, GivesWhatTheServiceRaisesAndClears) {
  Served served;
  EXPECT_TRUE(served.silent(1.0, 0.1).empty());
  const auto raised = served.silent(2.0, 6.0);
  ASSERT_EQ(raised.size(), 1U);
  EXPECT_EQ(raised[0].run_id, "run");
  EXPECT_EQ(changes_in(raised[0]), Changes{"link.silent active"});
  EXPECT_TRUE(served.silent(3.0, 7.0).empty());
  ASSERT_EQ(served.desk.open().size(), 1U);
  EXPECT_EQ(changes_in(served.silent(4.0, 0.1).at(0)), Changes{"link.silent cleared"});
}

TEST(AlertDesk, GivesNothingOfARunThatIsNotStored) {
  AlertDesk desk{{spinner()}, RunMode::Live};
  ArchiveBatch start = beginning();
  desk.evaluate(start);
  const std::map<std::string, ServiceState> silent{
      {"SPINNER", {.t = at(1.0), .pass_t = at(1.0), .silent_s = 6.0}}};
  EXPECT_TRUE(desk.evaluate(silent, at(1.0)).empty());
  desk.note_stored({&start, 1});
  EXPECT_EQ(desk.evaluate(silent, at(1.0)).size(), 1U);
}

TEST(AlertDesk, GivesAgainWhatWasTakenBackAndOnce) {
  Served served;
  const auto raised = served.silent(2.0, 6.0);
  served.desk.take_back(raised.at(0));
  ArchiveBatch next = batch_of_run();
  served.desk.evaluate(next);
  EXPECT_EQ(changes_in(next), Changes{"link.silent active"});
  EXPECT_TRUE(served.silent(3.0, 7.0).empty());
  served.desk.take_back(next);
  EXPECT_EQ(changes_in(served.silent(4.0, 0.1).at(0)),
            (Changes{"link.silent active", "link.silent cleared"}));
}

TEST(AlertDesk, EndsAShelvingWithoutTelemetry) {
  Served served;
  const auto raised = served.silent(2.0, 6.0);
  const std::string id = std::get<Alert>(raised.at(0).products.at(0)).alert_id;
  ASSERT_TRUE(
      served.desk.obey({.alert_id = id, .by = "shift", .note = "later", .minutes = 1}, at(3.0)));
  EXPECT_TRUE(served.desk.evaluate({}, at(62.0)).empty());
  EXPECT_EQ(changes_in(served.desk.evaluate({}, at(63.0)).at(0)), Changes{"link.silent active"});
}

OperatorAction limit(const std::string& key, std::map<std::string, double> limits, double t_s) {
  return {.action_id = "act",
          .spacecraft = "SPINNER",
          .t = at(t_s),
          .made_utc = {},
          .by = "shift",
          .action = "set_limit",
          .arguments = {},
          .note = {},
          .does = SetLimit{.key = key, .limits = std::move(limits)}};
}

TEST(AlertDesk, TakesLimitsOfTheServiceFromTheirTimeOn) {
  Served served;
  ArchiveBatch said = batch_of_run();
  said.actions.push_back(limit("link.silent", {{"seconds", 60.0}}, 10.0));
  served.desk.evaluate(said);
  ASSERT_EQ(served.silent(2.0, 6.0).size(), 1U);
  EXPECT_EQ(changes_in(served.silent(10.0, 14.0).at(0)), Changes{"link.silent cleared"});
  EXPECT_TRUE(served.silent(40.0, 44.0).empty());
  EXPECT_EQ(changes_in(served.silent(60.0, 64.0).at(0)), Changes{"link.silent active"});
}

TEST(AlertDesk, TakesLimitsOfResultsFromTheirTimeOnInEveryRunThatIsToldOfThem) {
  AlertDesk desk{{spinner()}, RunMode::Live};
  for (const char* const run : {"run-1", "run-2"}) {
    ArchiveBatch batch = beginning();
    batch.run_id = run;
    batch.actions.push_back(limit("spin.sigma", {{"deg", 0.2}, {"after_s", 0.0}}, 10.0));
    const auto with_sigma = [&](double t_s) {
      return SpinEstimate{.t = at(t_s),
                          .estimator = SpinEstimator::Sequential,
                          .axis_icrf = Eigen::Vector3d::UnitZ(),
                          .covariance_rad2 = Eigen::Matrix2d::Identity() * 2e-5,
                          .spin_rate_rad_s = 6.0,
                          .spin_rate_sigma_rad_s = 0.1,
                          .assessment = {Quality::Ok}};
    };
    batch.products = {with_sigma(1.0), with_sigma(9.0)};
    desk.evaluate(batch);
    EXPECT_THAT(desk.open(), IsEmpty());
    ArchiveBatch later = batch_of_run();
    later.run_id = run;
    later.products = {with_sigma(10.0)};
    desk.evaluate(later);
    ASSERT_EQ(desk.open().size(), 1U);
    EXPECT_THAT(desk.open().front().alert.message, HasSubstr("limit 0.2"));
    ArchiveBatch good = batch_of_run();
    good.run_id = run;
    SpinEstimate sure = with_sigma(20.0);
    sure.covariance_rad2 *= 1e-3;
    good.products = {sure};
    desk.evaluate(good);
    EXPECT_THAT(desk.open(), IsEmpty());
  }
}

TEST(AlertDesk, TakesLimitsByTheTimeOfWhatIsJudgedWhateverCameBeforeIt) {
  for (const double t_s : {9.0, 10.0}) {
    Served served;
    ArchiveBatch said = batch_of_run();
    said.actions.push_back(limit("link.contradiction", {{"samples", 2.0}}, 10.0));
    served.desk.evaluate(said);
    ArchiveBatch batch = batch_of_run();
    batch.products = {
        SpinEstimate{.t = at(20.0),
                     .estimator = SpinEstimator::Batch,
                     .axis_icrf = Eigen::Vector3d::UnitZ(),
                     .covariance_rad2 = Eigen::Matrix2d::Identity() * 1e-8,
                     .spin_rate_rad_s = 6.0,
                     .spin_rate_sigma_rad_s = 0.1,
                     .assessment = {Quality::Ok}},
        SampleContradiction{.t = at(t_s),
                            .by = {{.sender = Sender::Preferred, .name = "a"}, {.name = "b"}}}};
    served.desk.evaluate(batch);
    const auto open = served.desk.open();
    EXPECT_EQ(
        std::any_of(open.begin(), open.end(),
                    [](const OpenAlert& one) { return one.alert.key == "link.contradiction:b"; }),
        t_s < 10.0)
        << t_s;
  }
}

SpinEstimate axis_at(double t_s, Quality quality,
                     SpinEstimator estimator = SpinEstimator::Sequential, double off_rad = 0.0) {
  return {
      .t = at(t_s),
      .estimator = estimator,
      .axis_icrf = Eigen::AngleAxisd{off_rad, Eigen::Vector3d::UnitX()} * Eigen::Vector3d::UnitZ(),
      .covariance_rad2 = Eigen::Matrix2d::Identity() * 5e-9,
      .spin_rate_rad_s = 6.0,
      .spin_rate_sigma_rad_s = 0.1,
      .assessment = {quality}};
}

/// Returns the quality of the answer in force that a batch of estimates is given.
std::string quality_behind(AlertDesk& desk, const std::vector<SpinEstimate>& estimates) {
  ArchiveBatch batch = batch_of_run();
  batch.products.assign(estimates.begin(), estimates.end());
  desk.evaluate(batch);
  const auto answer = std::ranges::find_if(batch.products, [](const Product& product) {
    return std::holds_alternative<SpinAnswer>(product);
  });
  return std::string{name_of(std::get<SpinAnswer>(*answer).quality)};
}

TEST(AlertDesk, HasOneLimitOfDisagreementForAlertAndVerdict) {
  Served served;
  ArchiveBatch said = batch_of_run();
  said.actions = {limit("spin.disagree", {{"sigmas", 20.0}}, 0.0),
                  limit("spin.disagree", {{"sigmas", 5.0}}, 30.0)};
  served.desk.evaluate(said);
  const auto apart = [&](double t_s) {
    constexpr double kTenSigmas_rad = 1e-3;
    return std::vector{axis_at(t_s, Quality::Ok),
                       axis_at(t_s, Quality::Ok, SpinEstimator::Mean, kTenSigmas_rad)};
  };
  for (const double t_s : {1.0, 15.0, 29.0}) {
    EXPECT_EQ(quality_behind(served.desk, apart(t_s)), "OK") << t_s;
  }
  EXPECT_THAT(served.desk.open(), IsEmpty());
  EXPECT_EQ(quality_behind(served.desk, apart(30.0)), "DOUBTFUL");
  EXPECT_EQ(quality_behind(served.desk, {axis_at(25.0, Quality::Ok, SpinEstimator::Batch)}),
            "DOUBTFUL")
      << "a late solution of before brings no limit of before back";
  EXPECT_EQ(quality_behind(served.desk, apart(45.0)), "DOUBTFUL");
  ASSERT_EQ(served.desk.open().size(), 1U);
  EXPECT_EQ(served.desk.open().front().alert.key, "spin.disagree");
}

TEST(AlertDesk, DoubtsAtOnceWhereComputingFails) {
  for (const auto& [mission, key] :
       {std::pair{spinner(), "spin.doubtful"}, {three_axis(), "attitude.doubtful"}}) {
    Served served{mission};
    ArchiveBatch batch = batch_of_run(mission.spacecraft_id);
    batch.products = {RunFault{.t = at(5.0), .what = "no memory"}};
    served.desk.evaluate(batch);
    ASSERT_EQ(served.desk.open().size(), 1U);
    EXPECT_EQ(served.desk.open().front().alert.key, key);
    ArchiveBatch last = batch_of_run(mission.spacecraft_id);
    last.finished_utc = "2026-11-20T04:00:00.000Z";
    served.desk.evaluate(last);
    EXPECT_EQ(served.desk.open().size(), 1U);
  }
}

/// Gives the last answer of a run when the next one has begun with `of_next`.
/// @return The keys of the alerts that are open then.
Changes open_behind_late_end(const std::vector<Product>& of_next) {
  Served served;
  EXPECT_EQ(quality_behind(served.desk, {axis_at(1.0, Quality::Doubtful)}), "DOUBTFUL");
  EXPECT_EQ(quality_behind(served.desk, {axis_at(40.0, Quality::Doubtful)}), "DOUBTFUL");
  EXPECT_EQ(served.desk.open().size(), 1U);
  ArchiveBatch next = beginning();
  next.run_id = "next";
  next.products = of_next;
  served.desk.evaluate(next);
  ArchiveBatch last = batch_of_run();
  last.products = {axis_at(41.0, Quality::Ok)};
  last.finished_utc = "2026-11-20T04:00:00.000Z";
  served.desk.evaluate(last);
  Changes keys;
  for (const OpenAlert& open : served.desk.open()) {
    keys.push_back(open.alert.key);
  }
  return keys;
}

TEST(AlertDesk, EndsWithTheLastAnswerOfARunWhatIsOpenOfItAlsoBehindTheStartOfTheNext) {
  EXPECT_THAT(open_behind_late_end({}), IsEmpty());
  EXPECT_EQ(
      open_behind_late_end({axis_at(100.0, Quality::Doubtful), axis_at(140.0, Quality::Doubtful)}),
      Changes{"spin.doubtful"})
      << "the next run has found it too";
}

TEST(AlertDesk, RaisesNothingOfQualityBeforeAosAndBehindLos) {
  Mission mission = spinner();
  mission.contact = Contact{.from = at(0.0), .to = at(100.0)};
  Served served{mission};
  EXPECT_THAT(served.silent(-600.0, 3600.0), IsEmpty());
  ArchiveBatch pass = batch_of_run();
  for (const double t_s : {50.0, 99.0}) {
    pass.products.emplace_back(SpinEstimate{.t = at(t_s),
                                            .estimator = SpinEstimator::Sequential,
                                            .axis_icrf = Eigen::Vector3d::UnitZ(),
                                            .covariance_rad2 = Eigen::Matrix2d::Identity(),
                                            .spin_rate_rad_s = 6.0,
                                            .spin_rate_sigma_rad_s = 0.1,
                                            .assessment = {Quality::Ambiguous}});
  }
  served.desk.evaluate(pass);
  EXPECT_THAT(served.silent(3600.0, 3501.0), IsEmpty());
  EXPECT_THAT(served.desk.open(), IsEmpty());
}

TEST(AlertDesk, OpensTheAlertAgainWithinItsHoldOffAsOperatorsSetIt) {
  Served served;
  ArchiveBatch said = batch_of_run();
  said.actions.push_back(limit("link.silent", {{"hold_off_s", 5.0}}, 50.0));
  served.desk.evaluate(said);
  const auto id_of = [](const std::vector<ArchiveBatch>& batches) {
    return std::get<Alert>(batches.at(0).products.at(0)).alert_id;
  };
  const std::string first = id_of(served.silent(2.0, 6.0));
  ASSERT_FALSE(served.silent(3.0, 0.0).empty());
  EXPECT_EQ(id_of(served.silent(10.0, 6.0)), first);
  ASSERT_FALSE(served.silent(11.0, 0.0).empty());
  EXPECT_NE(id_of(served.silent(60.0, 6.0)), first);
}

TEST(AlertDesk, GoesOnWithOpenAlertsOfBefore) {
  Served before;
  const auto raised = before.silent(2.0, 6.0);
  Served restarted;
  restarted.desk.take_up("SPINNER", "run", std::get<Alert>(raised.at(0).products.at(0)));
  EXPECT_TRUE(restarted.silent(-3600.0, 6.0).empty());
  EXPECT_EQ(changes_in(restarted.silent(-3599.0, 0.1).at(0)), Changes{"link.silent cleared"});
}

std::vector<std::string> open_keys(const AlertDesk& desk) {
  std::vector<std::string> keys;
  for (const OpenAlert& open : desk.open()) {
    keys.push_back(open.alert.key);
  }
  return keys;
}

/// Gives products to a next run, in this service and in one that was restarted between the runs.
/// @return The keys of the alerts that are open then.
std::vector<std::string> open_behind_next_run(const Mission& mission, AlertDesk& before,
                                              const std::vector<Product>& products) {
  AlertDesk restarted{{mission}, RunMode::Live};
  for (const OpenAlert& open : before.open()) {
    restarted.take_up(open.spacecraft, "run", open.alert);
  }
  for (AlertDesk* const desk : {&before, &restarted}) {
    ArchiveBatch next = beginning(mission.spacecraft_id);
    next.run_id = "next";
    next.products = products;
    desk->evaluate(next);
  }
  EXPECT_EQ(open_keys(restarted), open_keys(before));
  return open_keys(before);
}

SensorContradiction contradiction_of(SampleSource culprit) {
  return {
      .culprit = culprit, .with = {}, .off = {"angle_deg", 2.0}, .sigmas = 20.0, .since = at(0.0)};
}

TEST(AlertDesk, EndsContradictionsOfTheRunBeforeWhenTheNextHasNone) {
  Served served;
  ArchiveBatch pass = batch_of_run();
  pass.products = {
      SensorsCompared{.t = at(0.0), .contradiction = contradiction_of(SampleSource::Sun2)},
      SampleContradiction{.t = at(0.0), .kind = "pulse", .by = {{Sender::First, false, "A"}}}};
  served.desk.evaluate(pass);
  const Changes both{"link.contradiction:A", "sensor.contradicts:sun2"};
  ASSERT_EQ(open_keys(served.desk), both);
  SpinEstimate answer{.t = at(130.0), .estimator = SpinEstimator::Sequential};
  answer.axis_icrf = Eigen::Vector3d::UnitZ();
  answer.covariance_rad2 = 1e-8 * Eigen::Matrix2d::Identity();
  EXPECT_THAT(open_behind_next_run(spinner(), served.desk,
                                   {SensorsCompared{.t = at(100.0), .contradiction = {}},
                                    SensorsCompared{.t = at(130.0), .contradiction = {}}, answer}),
              IsEmpty());
}

TEST(AlertDesk, EndsWhatSensorsOfTheRunBeforeDidWhenTheyDoNotInTheNext) {
  const Mission mission = three_axis();
  Served served{mission};
  const auto answer = [](double t_s) {
    return AttitudeEstimate{.t = at(t_s),
                            .q_icrf_body = Eigen::Quaterniond::Identity(),
                            .rate_body_rad_s = std::nullopt,
                            .covariance_rad2 = 1e-8 * Eigen::Matrix3d::Identity(),
                            .assessment = {}};
  };
  ArchiveBatch pass = batch_of_run(mission.spacecraft_id);
  for (double t_s = 0.0; t_s < 10.0; t_s += 1.0) {
    pass.products.emplace_back(
        RejectedSample{.t = at(t_s), .kind = SampleKind::Star, .rejected_by = Rejection::Frozen});
  }
  AttitudeEstimate contradicted = answer(10.0);
  contradicted.contradiction = contradiction_of(SampleSource::Sun);
  pass.products.emplace_back(contradicted);
  served.desk.evaluate(pass);
  ASSERT_EQ(open_keys(served.desk), (Changes{"sensor.contradicts:sun", "sensor.stuck:star"}));
  EXPECT_THAT(open_behind_next_run(mission, served.desk, {answer(100.0), answer(130.0)}),
              IsEmpty());
}

/// Returns gyro samples once a second and star fixes up to 10 s, of a three-axis spacecraft.
ArchiveBatch samples_until(int end_s) {
  ArchiveBatch batch = batch_of_run("LEOSAT");
  std::int64_t arrival = 0;
  for (int t_s = 0; t_s < end_s; ++t_s) {
    batch.samples.of<GyroSample>().push_back(
        {.spacecraft = "LEOSAT", .origin = {}, .value = {.t = at(t_s)}, .arrival = {arrival++}});
    if (t_s < 10) {
      batch.samples.of<StarFix>().push_back(
          {.spacecraft = "LEOSAT", .origin = {}, .value = {.t = at(t_s)}, .arrival = {arrival++}});
    }
  }
  return batch;
}

/// Returns the changes with the batch of products behind 20 s of samples.
std::vector<std::string> changes_behind_samples(const Mission& mission) {
  Served served{mission};
  ArchiveBatch samples = samples_until(20);
  served.desk.evaluate(samples);
  EXPECT_TRUE(samples.products.empty());
  ArchiveBatch products = batch_of_run("LEOSAT");
  served.desk.evaluate(products);
  return changes_in(products);
}

TEST(AlertDesk, KeepsWhatSamplesRaiseForABatchWithoutSamplesIfTheMissionHasTheSensor) {
  Mission mission = three_axis();
  EXPECT_EQ(changes_behind_samples(mission), Changes{"channel.silent:star active"});
  ASSERT_EQ(mission.tables.erase("three_axis.star_tracker"), 1U);
  EXPECT_THAT(changes_behind_samples(mission), IsEmpty());
}

TEST(AlertDesk, RaisesWhatWasNotStoredBeforeARestartAgainUnderTheSameId) {
  Served before{three_axis()};
  ArchiveBatch samples = samples_until(20);
  before.desk.evaluate(samples);
  Served restarted{three_axis()};
  PlacedValues again;
  samples.samples.for_each([&]<class Value>(const ArrivedSamplesOfKind<Value>& of_kind) {
    for (const auto& sample : of_kind) {
      again.of<Value>().push_back({.place = {sample.arrival.number}, .value = sample.value});
    }
  });
  restarted.desk.go_on("LEOSAT", "run", again);
  ASSERT_EQ(restarted.desk.open().size(), 1U);
  EXPECT_EQ(restarted.desk.open()[0].alert.alert_id, before.desk.open().at(0).alert.alert_id);
}

/// Holds a pass that spins slightly faster than its ground model.
class FasterThanItsModel : public ::testing::Test {
 protected:
  FasterThanItsModel() {
    const std::string text = text_of(scenarios() / "gto-nominal.toml");
    models_.emplace("SPINNER", std::make_shared<const GroundModel>(
                                   ground_model_of(testing::loaded(text)).value()));
    const Scenario flight =
        testing::loaded(testing::replaced(text, "rate_rpm = 60.0", "rate_rpm = 60.1"));
    const SimulatedPass pass = simulated_pass(flight, Progress::Hidden).value();
    write_pass(folder_.path() / "pass", flight, pass).value();
    pulses_ = pass.telemetry.of<Pulse>();
  }

  AlertDesk desk() const {
    return {
        {load_mission(folder_.path() / "pass" / "mission.toml").value()}, RunMode::Live, models_};
  }
  /// Sends the samples at positions `from` to `to` of the arrival order in batches.
  void send(AlertDesk& desk, std::size_t from, std::size_t to) const {
    constexpr std::size_t kBatch = 100;
    for (; from < to; from += kBatch) {
      ArchiveBatch batch = batch_of_run();
      for (std::size_t i = from; i < std::min(to, from + kBatch); ++i) {
        batch.samples.of<Pulse>().push_back({.spacecraft = "SPINNER",
                                             .origin = {},
                                             .value = pulses_[i].value,
                                             .arrival = {pulses_[i].place.number}});
      }
      desk.evaluate(batch);
    }
  }
  /// Returns ID and evidence of the open alerts by key.
  static std::map<std::string, std::string> open_in(const AlertDesk& desk) {
    std::map<std::string, std::string> open;
    for (const OpenAlert& one : desk.open()) {
      open.emplace(one.alert.key, one.alert.alert_id + one.alert.evidence);
    }
    return open;
  }

  TemporaryFolder folder_;
  GroundModels models_;
  PlacedOfKind<Pulse> pulses_;
};

/// The limit is said when the first half of the pass has come.
TEST_F(FasterThanItsModel, IsHeldAgainstTheLimitThatAnOperatorSetsAlsoAfterARestart) {
  constexpr double kNever = 1e6;
  const std::size_t half = pulses_.size() / 2;
  const TaiTime said_at = pulses_[half - 1].value.t;
  const auto said = [&](ArchiveBatch batch) {
    batch.actions.push_back(limit("model.departure", {{"sigmas", kNever}}, 0.0));
    batch.actions.back().t = said_at;
    return batch;
  };
  AlertDesk whole = desk();
  ArchiveBatch start = beginning();
  whole.evaluate(start);
  send(whole, 0, half);
  EXPECT_EQ(open_in(whole).size(), 1U);
  ArchiveBatch action = said(batch_of_run());
  whole.evaluate(action);
  send(whole, half, pulses_.size());
  EXPECT_THAT(open_in(whole), IsEmpty());

  AlertDesk restarted = desk();
  ArchiveBatch goes_on = said(batch_of_run());
  goes_on.continuation.emplace();
  restarted.evaluate(goes_on);
  PlacedValues before;
  before.of<Pulse>().assign(pulses_.begin(), pulses_.begin() + static_cast<std::ptrdiff_t>(half));
  restarted.go_on("SPINNER", "run", before);
  EXPECT_EQ(open_in(restarted).size(), 1U);
  send(restarted, half, pulses_.size());
  EXPECT_THAT(open_in(restarted), IsEmpty());
}

TEST_F(FasterThanItsModel, IsToldAsADepartureAndTheSameAfterARestart) {
  AlertDesk whole = desk();
  ArchiveBatch start = beginning();
  whole.evaluate(start);
  send(whole, 0, pulses_.size());
  ASSERT_EQ(open_in(whole).size(), 1U);
  EXPECT_EQ(open_in(whole).begin()->first, "model.departure:period");

  // The service is killed before and after the alert is raised.
  for (const std::size_t killed : {std::size_t{30}, std::size_t{1000}}) {
    AlertDesk restarted = desk();
    ArchiveBatch goes_on = batch_of_run();
    goes_on.continuation.emplace();
    restarted.evaluate(goes_on);
    PlacedValues before;
    before.of<Pulse>().assign(pulses_.begin(),
                              pulses_.begin() + static_cast<std::ptrdiff_t>(killed));
    restarted.go_on("SPINNER", "run", before);
    send(restarted, killed, pulses_.size());
    EXPECT_EQ(open_in(restarted), open_in(whole)) << killed;
  }
}

}  // namespace spindrift::alert_desk_test
