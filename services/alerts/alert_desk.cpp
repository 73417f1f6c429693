#include "services/alerts/alert_desk.h"

#include <fmt/format.h>

#include <chrono>
#include <cstdint>
#include <iterator>
#include <optional>
#include <string>
#include <string_view>
#include <type_traits>
#include <utility>
#include <variant>

#include "pipelines/core/shown.h"
#include "pipelines/three_axis/sample_kind.h"
#include "services/archive/archive.h"
#include "services/base/alert_words.h"
#include "services/base/wall_clock.h"

namespace spindrift {
namespace {

constexpr std::chrono::seconds kPatience{5};  ///< Time that a person waits for a word to be stored.

/// Returns the changes by a product; none for a type that the conditions do not use.
template <class Conditions>
ConditionChanges changes_by_product(Conditions& conditions, const Product& product) {
  return std::visit(
      [&](const auto& value) -> ConditionChanges {
        if constexpr (std::is_same_v<std::remove_cvref_t<decltype(value)>, RunFault>) {
          return conditions.note_fault(value.t);
        } else if constexpr (requires { conditions.evaluate(value); }) {
          return conditions.evaluate(value);
        } else if constexpr (requires { conditions.evaluate(*value); }) {
          return conditions.evaluate(*value);
        } else {
          return {};
        }
      },
      product);
}

/// Returns the time of what a product is about; empty for one that has no time of its own.
std::optional<TaiTime> time_of(const Product& product) {
  return std::visit(
      [](const auto& value) -> std::optional<TaiTime> {
        if constexpr (requires { TaiTime{value.t}; }) {
          return value.t;
        } else if constexpr (requires { value.pulse.t; }) {
          return value.pulse.t;
        } else if constexpr (requires { value.t_sun1; }) {
          return value.t_sun1;
        } else if constexpr (requires { value.said.t; }) {
          return value.said.t;
        } else if constexpr (requires { value->estimate.t; }) {
          return value->estimate.t;
        } else {
          return std::nullopt;
        }
      },
      product);
}

/// Returns the time of a result that comes in order; empty for any other product.
std::optional<TaiTime> time_in_order(const Product& product) {
  if (const auto* const attitude = std::get_if<AttitudeEstimate>(&product)) {
    return attitude->t;
  }
  const auto* const axis = std::get_if<SpinEstimate>(&product);
  // Solutions of `batch` are excluded, since they come at any time.
  return axis != nullptr && axis->estimator != SpinEstimator::Batch ? std::optional{axis->t}
                                                                    : std::nullopt;
}

ConditionChanges contradictions_by(ContradictionConditions& conditions, const Product& product) {
  if (const auto* const contradiction = std::get_if<SampleContradiction>(&product)) {
    return conditions.evaluate(*contradiction);
  }
  const auto t = time_in_order(product);
  return t ? conditions.evaluate(*t) : ConditionChanges{};
}

Occurrence occurrence_of(const ConditionChange& change, const std::string& run_id,
                         const std::string& config_sha256, const AlertLimits& limits,
                         const AlertBook& book) {
  std::string key = alert_key(change.code, change.about);
  const std::int64_t count = book.count_of(key) + (change.change == Change::Raised ? 1 : 0);
  return {.run_id = run_id,
          .key = std::move(key),
          .severity = change.severity,
          .t = change.t,
          .message = sentence_of(change, count),
          .evidence = evidence_json(change.evidence, config_sha256, count),
          .took_s = seconds_between(change.evidence.since, change.t),
          .hold_off_s = limits.hold_off_s.at(static_cast<std::size_t>(change.code))};
}

/// Returns the samples of sensors, without those left out. Gyro and sun vectors alone make no
/// attitude, and for minutes behind a separation nothing else comes.
std::vector<AwaitedSample> awaited(const ArrivedSamples& samples) {
  std::vector<AwaitedSample> all;
  in_order_of_arrival(samples, [&](const auto& sample) {
    if constexpr (requires { kind_of(sample.value); }) {
      const SampleKind kind = kind_of(sample.value);
      if (kind != SampleKind::OrbitState && !is_left_out(sample)) {
        all.push_back({.t = sample.value.t,
                       .is_usable = kind == SampleKind::Star || kind == SampleKind::Magnetometer});
      }
    }
  });
  return all;
}

void append(ConditionChanges changes, ConditionChanges& all) {
  std::move(changes.begin(), changes.end(), std::back_inserter(all));
}

/// Adds to `batch` which answer is in force if its products may have changed that.
void add_answer(const SpinConditions& conditions, ArchiveBatch& batch) {
  const bool may_change =
      std::any_of(batch.products.begin(), batch.products.end(), [](const Product& product) {
        return std::holds_alternative<RunFault>(product) ||
               std::holds_alternative<SpinEstimate>(product);
      });
  if (const auto& answer = conditions.in_force(); may_change && answer) {
    batch.products.emplace_back(*answer);
  }
}

std::optional<Alert> settle(AlertBook& book, Change change, const Occurrence& occurrence) {
  return change == Change::Raised    ? book.raise(occurrence)
         : change == Change::Cleared ? book.clear(occurrence)
                                     : book.renew(occurrence);
}

void append(std::vector<Alert> alerts, std::vector<Product>& products) {
  for (Alert& alert : alerts) {
    products.emplace_back(std::move(alert));
  }
}

}  // namespace

AlertDesk::AlertDesk(const std::vector<Mission>& missions, RunMode mode, const GroundModels& models)
    : mode_{mode} {
  for (const Mission& mission : missions) {
    const auto model = models.find(mission.spacecraft_id);
    Desk& desk = desks_[mission.spacecraft_id];
    desk.supervised = Supervised{.mission = mission,
                                 .model = model == models.end() ? nullptr : model->second,
                                 .conditions = conditions_of(mission),
                                 .contradictions = ContradictionConditions{mission.alerts},
                                 .comparison = {},
                                 .service = ServiceConditions{mission.alerts, mission.contact},
                                 .limits = LimitsInForce{mission.alert_values, mission.contact}};
    begin(desk);
  }
}

AlertDesk::Conditions AlertDesk::conditions_of(const Mission& mission) {
  if (const SpinConfig* const spin = mission.spin()) {
    return SpinConditions{*spin, *mission.orbit, mission.alerts, mission.target};
  }
  return AttitudeConditions{mission.alerts, mission.orbit, *mission.three_axis()};
}

/// Resets the conditions for a new run, which may end the open alerts.
void AlertDesk::begin(Desk& desk) {
  Supervised& supervised = *desk.supervised;
  supervised.conditions = conditions_of(supervised.mission);
  supervised.contradictions = ContradictionConditions{supervised.mission.alerts};
  if (supervised.model) {
    supervised.comparison.emplace(supervised.model, supervised.mission.alerts.departure_sigmas);
  }
  supervised.limits = LimitsInForce{supervised.mission.alert_values, supervised.mission.contact};
  supervised.in_force = nullptr;
  for (const Alert& alert : desk.book.open()) {
    const auto code = code_of(alert.key);
    const std::string about{about_of(alert.key)};
    if (code == AlertCode::LinkContradiction) {
      supervised.contradictions.take_up(about);
    } else if (code) {
      std::visit([&](auto& conditions) { conditions.take_up(*code, about); },
                 supervised.conditions);
    }
  }
}

void AlertDesk::apply(const OperatorAction& action, Supervised& supervised) {
  const TaiTime t = action.t.value();
  if (const auto* const limit = std::get_if<SetLimit>(&action.does)) {
    supervised.limits.set(t, *limit);
    supervised.in_force = nullptr;
  }
  const auto* const does = std::get_if<SpinAction>(&action.does);
  auto* const spin = std::get_if<SpinConditions>(&supervised.conditions);
  if (does == nullptr || spin == nullptr) {
    return;
  }
  if (const auto* const target = std::get_if<SetTarget>(does)) {
    spin->set_target(t, target->axis_icrf);
  } else if (std::holds_alternative<MarkManoeuvre>(*does)) {
    spin->note_manoeuvre(t);
  }
}

/// Puts the limits in force that hold at `t`, the time of what is judged next.
void AlertDesk::put_limits_in_force(TaiTime t, Supervised& supervised) {
  const AlertLimits& limits = supervised.limits.at(t);
  if (std::exchange(supervised.in_force, &limits) == &limits) {
    return;
  }
  std::visit([&](auto& conditions) { conditions.set_limits(limits); }, supervised.conditions);
  supervised.contradictions.set_limits(limits);
  if (supervised.comparison) {
    supervised.comparison->set_band(limits.departure_sigmas);
  }
}

/// Keeps the answers of the run that ends, whose last solution may still be computed.
void AlertDesk::end(Supervised& supervised) {
  auto* const spin = std::get_if<SpinConditions>(&supervised.conditions);
  supervised.ended = spin == nullptr ? std::nullopt : std::optional{std::move(*spin)};
  supervised.ended_run = supervised.run_id;
}

/// Samples that are left out must not advance the conditions: their times are wrong.
/// @param samples ArrivedSamples or PlacedValues.
template <class Samples>
ConditionChanges AlertDesk::changes_by(const Samples& samples, Supervised& supervised) {
  auto* const attitude = std::get_if<AttitudeConditions>(&supervised.conditions);
  ConditionChanges all;
  in_order_of_arrival(samples, [&](const auto& sample) {
    if (is_left_out(sample)) {
      return;
    }
    // A sample of the instant at which an operator sets limits has come before them.
    put_limits_in_force(sample.value.t - std::chrono::nanoseconds{1}, supervised);
    using Value = std::remove_cvref_t<decltype(sample.value)>;
    if constexpr (requires { kind_of(sample.value); }) {
      // A kind without a sensor is not used, so it is not missed either.
      constexpr std::string_view kSensor = Telemetry<Value>::kSensor;
      if (attitude != nullptr && supervised.mission.tables.contains(std::string{kSensor})) {
        append(attitude->evaluate(kind_of(sample.value), sample.value.t), all);
      }
    }
    if (supervised.comparison) {
      append(supervised.comparison->compare(sample.value).changes, all);
    }
  });
  return all;
}

void AlertDesk::take_up(const std::string& spacecraft, const std::string& run_id,
                        const Alert& alert) {
  const std::lock_guard lock{mutex_};
  Desk& desk = desks_[spacecraft];
  desk.run_of.insert_or_assign(alert.alert_id, run_id);
  desk.book.take_up(run_id, alert);
}

void AlertDesk::take_up_transition(const std::string& spacecraft, TaiTime t) {
  const std::lock_guard lock{mutex_};
  desks_[spacecraft].book.count_given(t);
}

void AlertDesk::take_up_run(const std::string& spacecraft, const std::string& run_id) {
  const std::lock_guard lock{mutex_};
  const auto desk = desks_.find(spacecraft);
  if (desk != desks_.end() && desk->second.supervised) {
    desk->second.supervised->stored_run = run_id;
  }
}

void AlertDesk::evaluate(ArchiveBatch& batch) {
  const std::lock_guard lock{mutex_};
  const auto found = desks_.find(batch.spacecraft_id);
  if (found == desks_.end() || !found->second.supervised) {
    return;
  }
  Desk& desk = found->second;
  Supervised& supervised = *desk.supervised;
  const bool begins = batch.continuation || (batch.start && batch.start->mode == mode_);
  if (begins && supervised.run_id != batch.run_id) {
    end(supervised);
    supervised.run_id = batch.run_id;
    begin(desk);
  }
  if (supervised.ended && supervised.ended_run == batch.run_id) {
    append(ended_by(batch, desk), batch.products);
  }
  if (supervised.run_id != batch.run_id) {
    return;
  }
  for (const OperatorAction& action : batch.actions) {
    apply(action, supervised);
  }
  std::vector<Alert> alerts = changed_by(batch, desk);
  std::move(alerts.begin(), alerts.end(), std::back_inserter(desk.waiting));
  if (count_of(batch.samples) == 0) {
    append(std::exchange(desk.waiting, {}), batch.products);
  }
}

void AlertDesk::tell(const ConditionChanges& changes, ArchiveBatch& batch) {
  const std::lock_guard lock{mutex_};
  const auto desk = desks_.find(batch.spacecraft_id);
  if (desk != desks_.end() && desk->second.supervised &&
      desk->second.supervised->run_id == batch.run_id) {
    append(settled(changes, batch.run_id, desk->second), batch.products);
  }
}

void AlertDesk::go_on(const std::string& spacecraft, const std::string& run_id,
                      const PlacedValues& samples) {
  const std::lock_guard lock{mutex_};
  const auto desk = desks_.find(spacecraft);
  if (desk == desks_.end() || !desk->second.supervised ||
      desk->second.supervised->run_id != run_id) {
    return;
  }
  std::vector<Alert> alerts =
      settled(changes_by(samples, *desk->second.supervised), run_id, desk->second);
  std::move(alerts.begin(), alerts.end(), std::back_inserter(desk->second.waiting));
}

void AlertDesk::take_back(const ArchiveBatch& batch) {
  const std::lock_guard lock{mutex_};
  for (const Product& product : batch.products) {
    if (const auto* const alert = std::get_if<Alert>(&product)) {
      desks_[batch.spacecraft_id].waiting.push_back(*alert);
    }
  }
}

void AlertDesk::note_stored(std::span<const ArchiveBatch> batches) {
  const std::lock_guard lock{mutex_};
  for (const ArchiveBatch& batch : batches) {
    const auto desk = desks_.find(batch.spacecraft_id);
    if ((batch.start || batch.continuation) && desk != desks_.end() && desk->second.supervised &&
        desk->second.supervised->run_id == batch.run_id) {
      desk->second.supervised->stored_run = batch.run_id;
    }
  }
}

std::vector<ArchiveBatch> AlertDesk::evaluate(const std::map<std::string, ServiceState>& states,
                                              TaiTime now) {
  const std::lock_guard lock{mutex_};
  std::vector<ArchiveBatch> batches;
  for (auto& [spacecraft, desk] : desks_) {
    if (!desk.supervised || desk.supervised->stored_run.empty()) {
      continue;
    }
    ArchiveBatch batch{.run_id = desk.supervised->stored_run, .spacecraft_id = spacecraft};
    append(std::exchange(desk.waiting, {}), batch.products);
    if (const auto state = states.find(spacecraft); state != states.end()) {
      append(changed_by(state->second, desk), batch.products);
    }
    append(desk.book.expire(now), batch.products);
    append(desk.book.catch_up(now), batch.products);
    if (!batch.products.empty()) {
      batches.push_back(std::move(batch));
    }
  }
  return batches;
}

/// These alerts cannot be recomputed, so they must not be lost when the clock is set back.
std::vector<Alert> AlertDesk::changed_by(const ServiceState& state, Desk& desk) {
  Supervised& supervised = *desk.supervised;
  const AlertLimits& limits = supervised.limits.at(state.pass_t);
  supervised.service.set_limits(limits);
  std::vector<Alert> alerts;
  for (const ConditionChange& change : supervised.service.evaluate(state)) {
    Occurrence occurrence =
        occurrence_of(change, supervised.stored_run, supervised.mission.sha256, limits, desk.book);
    occurrence.t = desk.book.after(occurrence.key, occurrence.t);
    if (auto alert = settle(desk.book, change.change, occurrence)) {
      desk.run_of.try_emplace(alert->alert_id, supervised.stored_run);
      alerts.push_back(*std::move(alert));
    }
  }
  return alerts;
}

std::vector<Alert> AlertDesk::changed_by(ArchiveBatch& batch, Desk& desk) {
  Supervised& supervised = *desk.supervised;
  ConditionChanges all = changes_by(batch.samples, supervised);
  if (auto* const attitude = std::get_if<AttitudeConditions>(&supervised.conditions);
      attitude != nullptr && count_of(batch.samples) > 0) {
    append(attitude->await_answer(awaited(batch.samples)), all);
  }
  for (const Product& product : batch.products) {
    if (const auto t = time_of(product)) {
      put_limits_in_force(*t, supervised);
    }
    append(std::visit([&](auto& conditions) { return changes_by_product(conditions, product); },
                      supervised.conditions),
           all);
    append(contradictions_by(supervised.contradictions, product), all);
  }
  if (auto* const spin = std::get_if<SpinConditions>(&supervised.conditions)) {
    add_answer(*spin, batch);
  }
  if (batch.finished_utc) {
    append(std::visit([](auto& conditions) { return conditions.settle(); }, supervised.conditions),
           all);
  }
  return settled(all, supervised.run_id, desk);
}

/// Lets the last answers of a run that another one has followed end its alerts that are still open.
/// Only the run that goes on raises alerts, since it alone can end them.
std::vector<Alert> AlertDesk::ended_by(ArchiveBatch& batch, Desk& desk) {
  SpinConditions& ended = *desk.supervised->ended;
  ConditionChanges changes;
  for (const Product& product : batch.products) {
    append(changes_by_product(ended, product), changes);
  }
  add_answer(ended, batch);
  if (batch.finished_utc) {
    append(ended.settle(), changes);
  }
  std::erase_if(changes, [&](const ConditionChange& change) {
    return change.change != Change::Cleared ||
           desk.book.run_of(alert_key(change.code, change.about)) != batch.run_id;
  });
  return settled(changes, batch.run_id, desk);
}

std::vector<Alert> AlertDesk::settled(const ConditionChanges& changes, const std::string& run_id,
                                      Desk& desk) {
  Supervised& supervised = *desk.supervised;
  std::vector<Alert> alerts;
  for (const ConditionChange& change : changes) {
    if (auto alert = settle(desk.book, change.change,
                            occurrence_of(change, run_id, supervised.mission.sha256,
                                          supervised.limits.at(change.t), desk.book))) {
      desk.run_of.try_emplace(alert->alert_id, run_id);
      alerts.push_back(*std::move(alert));
    }
  }
  if (!changes.empty()) {
    std::vector<Alert> late = desk.book.catch_up(changes.back().t);
    std::move(late.begin(), late.end(), std::back_inserter(alerts));
  }
  return alerts;
}

std::string AlertDesk::run_of(const std::string& spacecraft) const {
  const std::lock_guard lock{mutex_};
  const auto found = desks_.find(spacecraft);
  return found == desks_.end() || !found->second.supervised ? std::string{}
                                                            : found->second.supervised->stored_run;
}

std::optional<SpinTarget> AlertDesk::target_of(const std::string& spacecraft) const {
  const std::lock_guard lock{mutex_};
  const auto found = desks_.find(spacecraft);
  if (found == desks_.end() || !found->second.supervised) {
    return std::nullopt;
  }
  const auto* const spin = std::get_if<SpinConditions>(&found->second.supervised->conditions);
  return spin == nullptr ? std::nullopt : spin->target();
}

std::vector<OpenAlert> AlertDesk::open() const {
  const std::lock_guard lock{mutex_};
  std::vector<OpenAlert> all;
  for (const auto& [spacecraft, desk] : desks_) {
    for (Alert& alert : desk.book.open()) {
      all.push_back({.spacecraft = spacecraft, .alert = std::move(alert)});
    }
  }
  return all;
}

Expected<ArchiveBatch> AlertDesk::obey(const OperatorWord& word, TaiTime now) {
  const std::lock_guard lock{mutex_};
  const auto& [alert_id, by, note, minutes, said] = word;
  std::string open;
  for (auto& [spacecraft, desk] : desks_) {
    for (const Alert& alert : desk.book.open()) {
      if (alert.alert_id != alert_id) {
        open += fmt::format("{}{} ({})", open.empty() ? "" : ", ", alert.alert_id, alert.key);
        continue;
      }
      ArchiveBatch batch{.run_id = desk.run_of.at(alert_id), .spacecraft_id = spacecraft};
      const auto until = now + std::chrono::minutes{minutes};
      auto changed = minutes > 0 ? desk.book.shelve(alert_id, now, until, by, note)
                                 : desk.book.acknowledge(alert_id, now, by, note);
      return std::move(changed).map([&](Alert&& alert_now) {
        batch.products.emplace_back(std::move(alert_now));
        return std::move(batch);
      });
    }
  }
  return Unexpected{{ErrorCode::InvalidInput, fmt::format("no alert '{}' is open; open: {}",
                                                          alert_id, open.empty() ? "none" : open)}};
}

Expected<ArchiveBatch> take_word(const OperatorWord& word, AlertDesk& desk, Archive& archive) {
  if (word.by.empty()) {
    return Unexpected{{ErrorCode::InvalidInput, "by: must be a text, not empty: who says so"}};
  }
  for (const auto& [key, text] : {std::pair{"by", word.by}, std::pair{"note", word.note}}) {
    if (!is_plain(text)) {
      return Unexpected{
          {ErrorCode::InvalidInput, fmt::format("{}: '{}': {}", key, shown(text), kPlainText)}};
    }
  }
  const auto until = word.said + kPatience;
  return desk.obey(word, tai_now()).and_then([&](const ArchiveBatch& changed) {
    return archive.submit(changed, until)
        .and_then([&] { return archive.flush(until); })
        .map([&] { return changed; })
        .map_error([&](Error error) {
          error.message = fmt::format(
              "not stored within {} s: it is in force, and stored as soon as the archive stores "
              "again; do not say it twice: {}",
              kPatience.count(), error.message);
          return error;
        });
  });
}

}  // namespace spindrift
