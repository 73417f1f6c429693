#include "services/console/shown_spacecraft.h"

#include <algorithm>
#include <array>
#include <cmath>
#include <cstddef>
#include <iterator>
#include <memory>
#include <string_view>
#include <variant>

#include "pipelines/frames/celestial.h"
#include "pipelines/time/utc.h"
#include "services/base/degrees.h"
#include "services/base/notice_words.h"
#include "services/base/parsed_json.h"
#include "services/base/reasons_json.h"
#include "services/products/separation_json.h"
#include "services/products/to_json.h"

namespace spindrift {
namespace {

// A burst shows viewers only its newest edges.
constexpr std::size_t kMostEdgesAtOnce = 1000;
// More turns than the kept edges can span.
constexpr std::size_t kTurnsKept = 256;
constexpr std::size_t kActionsKept = 5;
constexpr std::size_t kFailedKept = 1000;

std::string_view name_of(LinkState link) {
  constexpr std::array<std::string_view, 3> kNames = {"waiting", "live", "stale"};
  return kNames.at(static_cast<std::size_t>(link));
}

nlohmann::json place_json(const Eigen::Vector3d& direction_icrf) {
  const PlaceDeg place = place_deg(direction_icrf);
  return {{"ra_deg", place.ra_deg}, {"dec_deg", place.dec_deg}};
}

/// Returns the archive's row with the reasons as JSON objects.
template <class Estimate>
nlohmann::json answer_json(const Estimate& estimate) {
  nlohmann::json row = json_of(estimate);
  row["reasons"] = nlohmann::json::parse(to_json_text(estimate.assessment.reasons));
  return row;
}

/// Returns the other axis that an estimate names; null when it names none.
nlohmann::json other_axis_json(const nlohmann::json& estimate_row) {
  for (const nlohmann::json& reason : estimate_row["reasons"]) {
    if (reason["code"] == name_of(ReasonCode::OtherAxis)) {
      return {{"ra_deg", reason["ra_deg"]},
              {"dec_deg", reason["dec_deg"]},
              {"sigma_deg", reason["sigma_deg"]}};
    }
  }
  return nullptr;
}

/// Returns the archive's row with the arguments as a JSON object.
nlohmann::json action_json(const OperatorAction& action) {
  nlohmann::json row{{"action_id", action.action_id},
                     {"made_utc", action.made_utc},
                     {"by", action.by},
                     {"action", action.action},
                     {"arguments", parsed_json(action.arguments)},
                     {"note", action.note}};
  if (action.t) {
    row["t_tai_ns"] = tai_ns(*action.t);
  }
  return row;
}

/// Adds the value only if it is known.
template <class Value>
void add(nlohmann::json& object, const char* name, const std::optional<Value>& value) {
  if (value) {
    object[name] = *value;
  }
}

nlohmann::json link_json(const SpacecraftHealth& health) {
  nlohmann::json link{{"state", name_of(health.link)}};
  add(link, "data_age_s", health.data_age_s);
  if (health.last_sample) {
    link["t_tai_ns"] = tai_ns(*health.last_sample);
    link["utc"] = format_utc(*health.last_sample);
  }
  return link;
}

nlohmann::json verdict_json(const PassVerdict& verdict) {
  nlohmann::json object{{"why", verdict.why}, {"against", verdict.against}};
  if (!verdict.estimator.empty()) {
    object["estimator"] = verdict.estimator;
  }
  if (verdict.quality) {
    object["quality"] = name_of(*verdict.quality);
  }
  if (verdict.t) {
    object["answer_tai_ns"] = tai_ns(*verdict.t);
    object["answer_utc"] = format_utc(*verdict.t);
  }
  if (verdict.separation) {
    object["separation"] = separation_json(*verdict.separation);
  }
  add(object, "sigma_deg", verdict.sigma_deg);
  add(object, "noise_sigma_deg", verdict.noise_sigma_deg);
  add(object, "ra_deg", verdict.ra_deg);
  add(object, "dec_deg", verdict.dec_deg);
  add(object, "spin_rate_rpm", verdict.spin_rate_rpm);
  add(object, "sigma_rpm", verdict.sigma_rpm);
  return object;
}

/// What an action says of the telemetry that is used.
struct SaysOfUse {
  bool excludes = false;
  std::optional<std::size_t> channel = {};  ///< From its time on; empty: of a segment.

  template <class Channel>
  explicit SaysOfUse(const ExcludeChannel<Channel>& does)
      : excludes{true}, channel{static_cast<std::size_t>(does.channel)} {}
  template <class Channel>
  explicit SaysOfUse(const IncludeChannel<Channel>& does)
      : channel{static_cast<std::size_t>(does.channel)} {}
  template <class Channel>
  explicit SaysOfUse(const ExcludeSegment<Channel>& /*does*/) : excludes{true} {}
  template <class Other>
  explicit SaysOfUse(const Other& /*does*/) {}
};

SaysOfUse use_by(const OperatorAction& action) {
  return std::visit(
      [](const auto& of_kind) {
        if constexpr (requires { of_kind.limits; }) {
          return SaysOfUse{of_kind};
        } else {
          return std::visit([](const auto& does) { return SaysOfUse{does}; }, of_kind);
        }
      },
      action.does);
}

/// Returns whether a notice tells the effect of the action: it names it, or is of what it chooses.
bool tells_effect_of(const OperatorAction& action, const RunNotice& notice) {
  const nlohmann::json said = parsed_json(notice.arguments);
  if (said.contains("action_id")) {
    return said["action_id"] == action.action_id;
  }
  if (said.contains("action")) {
    return said["action"] == action.action;
  }
  const bool of_root = notice.code == name_of(NoticeCode::RootFarFromAll) ||
                       notice.code == name_of(NoticeCode::RootChosen);
  const bool of_prior = notice.code == name_of(NoticeCode::PriorContradicted) ||
                        notice.code == name_of(NoticeCode::PriorFar);
  return ((of_root || of_prior) && action.action == "choose_root") ||
         (of_prior && action.action == "set_prior");
}

/// Keeps the last actions, and of those before them the exclusions in force.
void keep_last_and_exclusions(std::size_t most, std::deque<OperatorAction>& actions) {
  for (auto action = actions.begin();
       static_cast<std::size_t>(std::distance(action, actions.end())) > most;) {
    const SaysOfUse said = use_by(*action);
    const bool is_in_force =
        said.excludes &&
        (!said.channel ||
         std::none_of(std::next(action), actions.end(), [&](const OperatorAction& later) {
           return use_by(later).channel == said.channel;
         }));
    action = is_in_force ? std::next(action) : actions.erase(action);
  }
}

template <class Value>
void keep_last(std::size_t most, std::deque<Value>& values) {
  while (values.size() > most) {
    values.pop_front();
  }
}

}  // namespace

ShownSpacecraft::ShownSpacecraft(const Mission& mission)
    : mission_{mission},
      target_{mission.target},
      health_{.spacecraft = mission.spacecraft_id, .link = LinkState::Waiting},
      ledger_{kShownRules} {}

void ShownSpacecraft::switch_to(const std::string& run_id) {
  if (run_id != run_id_) {
    run_id_ = run_id;
    answers_ = nlohmann::json::object();
    verdict_.reset();
    periods_s_.clear();
    edges_.clear();
    failed_.clear();
    ledger_ = Ledger{kShownRules};
    actions_.clear();
    effects_.clear();
    priors_.clear();
    bound_deg_.reset();
  }
}

nlohmann::json ShownSpacecraft::show(const SpinEstimate& estimate) {
  nlohmann::json row = answer_json(estimate);
  if (estimate.estimator == SpinEstimator::Batch && bound_deg_ && bound_deg_->first == estimate.t) {
    row["bound_deg"] = bound_deg_->second;
  }
  answers_["estimates"][row["estimator"].get<std::string>()] = row;
  if (estimate.estimator == SpinEstimator::Sequential) {
    answers_["other_axis"] = other_axis_json(row);
  }
  return row;
}

nlohmann::json ShownSpacecraft::show(const SpinFix& fix) {
  nlohmann::json row = json_of(fix);
  for (const char* const name : {"geometry_case", "resolution"}) {
    answers_[name] = row[name];
  }
  return row;
}

nlohmann::json ShownSpacecraft::show(const AttitudeEstimate& attitude) {
  nlohmann::json row = answer_json(attitude);
  answers_["source"] = row["source"];
  answers_["q_icrf_body"] = {row["qx"], row["qy"], row["qz"], row["qw"]};
  answers_["rate_deg_s"] = nullptr;
  if (const auto& rate_rad_s = attitude.rate_body_rad_s) {
    const Eigen::Vector3d rate_deg_s = *rate_rad_s * kDegPerRad;
    answers_["rate_deg_s"] = {rate_deg_s.x(), rate_deg_s.y(), rate_deg_s.z()};
  }
  return row;
}

void ShownSpacecraft::show(const ReconstructionProduct& separation) {
  nlohmann::json events = nlohmann::json::array();
  for (const nlohmann::json& event : answers_.value("reconstruction", nlohmann::json::array())) {
    if (event["method"] != method_of(separation)) {
      events.push_back(event);
    }
  }
  for (const auto& row : ReconstructionEventTable::rows(separation)) {
    events.push_back(json_of_row<ReconstructionEventTable>(row));
  }
  answers_["reconstruction"] = std::move(events);
}

void ShownSpacecraft::take_details(const ArchiveBatch& stored) {
  if (stored.start || stored.continuation) {
    switch_to(stored.run_id);
  }
  if (stored.run_id != run_id_) {
    return;
  }
  for (const Product& product : stored.products) {
    if (const auto* const use = std::get_if<PulseUse>(&product)) {
      edges_.push_back(*use);
      if (use->said) {
        ledger_.add({&*use->said, 1});
      }
    } else if (const auto* const sample = std::get_if<SampleObservation>(&product)) {
      ledger_.add({&sample->said, 1});
    } else if (const auto* const measured = std::get_if<SpinMeasurement>(&product)) {
      remember(*measured);
    } else if (const auto* const notice = std::get_if<RunNotice>(&product)) {
      show_effect(*notice);
    } else if (const auto* const turn = std::get_if<RevolutionProduct>(&product)) {
      periods_s_.insert_or_assign(turn->t_sun1, turn->period_s);
    } else if (const auto* const batch = std::get_if<BatchProduct>(&product)) {
      bound_deg_ = {(*batch)->estimate.t, (*batch)->bound_rad * kDegPerRad};
    }
  }
  for (const OperatorAction& action : stored.actions) {
    show(action);
  }
  keep_last_and_exclusions(kActionsKept, actions_);
  keep_last(kMostEdgesAtOnce, edges_);
  while (periods_s_.size() > kTurnsKept) {
    periods_s_.erase(periods_s_.begin());
  }
}

void ShownSpacecraft::remember(const SpinMeasurement& measurement) {
  if (!measurement.said) {
    return;
  }
  ledger_.add({&*measurement.said, 1});
  if (measurement.rejected_by) {
    failed_.insert_or_assign({measurement.revolution, measurement.quantity}, measurement);
    if (failed_.size() > kFailedKept) {
      failed_.erase(failed_.begin());
    }
  }
}

/// Selects the failed test or the filter's limit by the same rule as the phase series.
nlohmann::json ShownSpacecraft::held_against(const PulseUse& edge) const {
  const auto failed = std::find_if(failed_.begin(), failed_.end(), [&edge](const auto& one) {
    return one.first.first == edge.revolution && edge.rejected_by &&
           *edge.rejected_by == rejection_of(one.first.second);
  });
  if (failed != failed_.end()) {
    const SpinMeasurement& measured = failed->second;
    const double unit = SpinMeasurementTable::to_unit(measured);
    return {{"off", SpinMeasurementTable::off_of(*measured.said) * unit},
            {"limit", SpinMeasurementTable::largest_of(*measured.said) * unit},
            {"off_unit", SpinMeasurementTable::is_time(measured) ? "s" : "deg"}};
  }
  if (edge.gap) {
    return {{"off", edge.gap->gap_s}, {"limit", edge.gap->least_s}, {"off_unit", "s"}};
  }
  if (edge.said && edge.said->residual.freedom > 0) {
    return {{"off", edge.said->whitened()},
            {"limit", std::sqrt(edge.said->limit)},
            {"off_unit", "sigma"}};
  }
  return nlohmann::json::object();
}

/// By name of the source.
nlohmann::json ShownSpacecraft::residuals() const {
  nlohmann::json all = nlohmann::json::object();
  for (const SourceSummary& one : ledger_.sources()) {
    nlohmann::json& said = all[std::string{name_of(one.source)}];
    said["used"] = one.used;
    add(said, "noise", one.noise);
  }
  return all;
}

void ShownSpacecraft::show(const OperatorAction& action) {
  actions_.push_back(action);
  if (const auto* const limit = std::get_if<SetLimit>(&action.does)) {
    limits_.set(action.t.value(), *limit);
  }
  const auto* const does = std::get_if<SpinAction>(&action.does);
  const auto* const said = does == nullptr ? nullptr : std::get_if<SetPrior>(does);
  if (said != nullptr) {
    priors_.insert_or_assign(action.t.value(), said->prior);
  }
}

/// Notes what the service says of the last action that has such an effect.
void ShownSpacecraft::show_effect(const RunNotice& notice) {
  const auto told = std::find_if(actions_.rbegin(), actions_.rend(), [&](const auto& action) {
    return tells_effect_of(action, notice);
  });
  if (told != actions_.rend()) {
    effects_[told->action_id] = notice.says;
  }
}

const AlertLimits& ShownSpacecraft::limits() {
  return limits_.at(health_.last_sample.value_or(TaiTime::min()));
}

/// Returns the mission's prior unless an operator has replaced it.
nlohmann::json ShownSpacecraft::prior() const {
  std::optional<SpinPrior> prior = mission_.spin()->prior;
  const auto later =
      health_.last_sample ? priors_.upper_bound(*health_.last_sample) : priors_.begin();
  if (later != priors_.begin()) {
    prior = std::prev(later)->second;
  }
  if (!prior) {
    return nullptr;
  }
  nlohmann::json shown = place_json(prior->axis_icrf);
  shown["sigma_deg"] = prior->sigma_rad * kDegPerRad;
  return shown;
}

std::optional<double> ShownSpacecraft::phase_deg(TaiTime t) const {
  const auto behind = periods_s_.upper_bound(t);
  if (behind == periods_s_.begin()) {
    return std::nullopt;
  }
  const auto& [sun1, period_s] = *std::prev(behind);
  const double turns = seconds_between(sun1, t) / period_s;
  return (turns - std::floor(turns)) * 360.0;
}

nlohmann::json ShownSpacecraft::state() {
  nlohmann::json state{{"kind", name_of(mission_.kind())}};
  if (mission_.spin() != nullptr) {
    state["prior"] = prior();
    state["target"] = target_ ? place_json(target_->axis_icrf) : nullptr;
  }
  state.update(link_json(health_));
  state.update(answers_);
  if (verdict_) {
    state.update(verdict_json(*verdict_));
  }
  state["residuals"] = residuals();
  state["actions"] = nlohmann::json::array();
  for (const OperatorAction& action : actions_) {
    state["actions"].push_back(action_json(action));
    if (const auto effect = effects_.find(action.action_id); effect != effects_.end()) {
      state["actions"].back()["effect"] = effect->second;
    }
  }
  add_sky(state);
  add(state, "to_target_deg", to_target_deg());
  return state;
}

Standing ShownSpacecraft::standing() const {
  return {.kind = mission_.kind(),
          .link = health_.link,
          .data_age_s = health_.data_age_s,
          .verdict = verdict_.value_or(PassVerdict{}),
          .to_target_deg = to_target_deg()};
}

void ShownSpacecraft::add_sky(nlohmann::json& state) {
  if (!health_.last_sample || !mission_.orbit) {
    return;
  }
  const auto spacecraft = mission_.orbit->at(*health_.last_sample);
  if (!spacecraft) {
    return;  // Beyond the end of the orbit only the axis can be shown.
  }
  const PlaceDeg sun = place_deg(sun_.direction_icrf(*health_.last_sample, *spacecraft));
  const PlaceDeg earth = place_deg(-spacecraft->position_icrf_km);
  state["sun_ra_deg"] = sun.ra_deg;
  state["sun_dec_deg"] = sun.dec_deg;
  state["earth_ra_deg"] = earth.ra_deg;
  state["earth_dec_deg"] = earth.dec_deg;
}

std::optional<double> ShownSpacecraft::to_target_deg() const {
  if (!target_ || !verdict_ || !verdict_->ra_deg || !verdict_->dec_deg) {
    return std::nullopt;
  }
  return degrees(
      angle_between_rad(axis_icrf_from(*verdict_->ra_deg, *verdict_->dec_deg), target_->axis_icrf));
}

nlohmann::json ShownSpacecraft::take_pulses() {
  nlohmann::json pulses = nlohmann::json::array();
  for (const PulseUse& edge : edges_) {
    nlohmann::json pulse = json_of(edge);
    const auto phase = phase_deg(edge.pulse.t);
    pulse["phase_deg"] = phase ? nlohmann::json(*phase) : nlohmann::json{};
    pulse.update(held_against(edge));
    pulses.push_back(std::move(pulse));
  }
  edges_.clear();
  return pulses;
}

}  // namespace spindrift
