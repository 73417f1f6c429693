#include "services/operator/parse_action.h"

#include <fmt/format.h>
#include <fmt/ranges.h>

#include <algorithm>
#include <array>
#include <cstdint>
#include <optional>
#include <span>
#include <string>
#include <string_view>
#include <type_traits>
#include <utility>
#include <vector>

#include "pipelines/core/shown.h"
#include "pipelines/frames/angle.h"
#include "pipelines/frames/celestial.h"
#include "services/base/json_line.h"
#include "services/base/unique_id.h"
#include "services/base/wall_clock.h"
#include "services/mission/key_check.h"
#include "services/mission/mission_schema.h"
#include "services/telemetry/telemetry_time.h"

namespace spindrift {
namespace {

/// Reads and checks the keys of a JSON object from outside. Collects the problems; an invalid value
/// is replaced by a meaningless one.
class SaidValues {
 public:
  /// @param object Must outlive this.
  explicit SaidValues(const nlohmann::json& object) : object_{object} {}

  /// Returns a text of at most 200 characters without control characters.
  std::string text(const char* key);
  std::string text_or_empty(const char* key);
  /// @param names Allowed values. @return Index among them.
  std::size_t name(const char* key, std::span<const std::string_view> names);
  double number(const char* key, double at_least, double at_most);
  TaiTime time(const char* key);
  std::optional<TaiTime> time_if(const char* key);
  bool has(const char* key);

  void wrong(std::string problem) { problems_.push_back(std::move(problem)); }
  /// Returns the problems, including keys that were never asked for; empty when there are none.
  std::string problems() const;

 private:
  const nlohmann::json* find(const char* key);

  const nlohmann::json& object_;
  std::vector<std::string> asked_;
  std::vector<std::string> problems_;
};

std::string said(const nlohmann::json& value) {
  std::string text = json_line(value);
  text.pop_back();
  return shown(text);
}

bool SaidValues::has(const char* key) {
  if (std::find(asked_.begin(), asked_.end(), key) == asked_.end()) {
    asked_.emplace_back(key);
  }
  return object_.contains(key);
}

const nlohmann::json* SaidValues::find(const char* key) {
  if (!has(key)) {
    wrong(fmt::format("{} is missing", key));
    return nullptr;
  }
  return &object_.at(key);
}

std::string SaidValues::text_or_empty(const char* key) {
  return has(key) && object_.at(key) != nlohmann::json("") ? text(key) : "";
}

std::string SaidValues::text(const char* key) {
  const nlohmann::json* const value = find(key);
  if (value == nullptr) {
    return {};
  }
  if (!value->is_string() || value->get_ref<const std::string&>().empty()) {
    wrong(fmt::format("{}: {}: must be text, not empty", key, said(*value)));
    return {};
  }
  auto text = value->get<std::string>();
  if (!is_plain(text)) {
    wrong(fmt::format("{}: {}: {}", key, said(*value), kPlainText));
  }
  return text;
}

std::size_t SaidValues::name(const char* key, std::span<const std::string_view> names) {
  const nlohmann::json* const value = find(key);
  if (value == nullptr) {
    return 0;
  }
  const auto found = value->is_string() ? std::find(names.begin(), names.end(),
                                                    value->get_ref<const std::string&>())
                                        : names.end();
  if (found == names.end()) {
    wrong(fmt::format("{}: {}: must be one of {}", key, said(*value), fmt::join(names, ", ")));
    return 0;
  }
  return static_cast<std::size_t>(found - names.begin());
}

double SaidValues::number(const char* key, double at_least, double at_most) {
  const nlohmann::json* const value = find(key);
  if (value == nullptr) {
    return at_least;
  }
  // The condition is written so that NaN fails.
  if (!value->is_number() ||
      !(value->get<double>() >= at_least && value->get<double>() <= at_most)) {
    wrong(fmt::format("{}: {}: must be a number, {} to {}", key, said(*value), at_least, at_most));
    return at_least;
  }
  return value->get<double>();
}

std::optional<TaiTime> SaidValues::time_if(const char* key) {
  return has(key) ? std::optional{time(key)} : std::nullopt;
}

TaiTime SaidValues::time(const char* key) {
  const nlohmann::json* const value = find(key);
  if (value == nullptr) {
    return {};
  }
  const bool is_whole = value->is_number_integer() &&
                        (!value->is_number_unsigned() ||
                         value->get<std::uint64_t>() <= static_cast<std::uint64_t>(INT64_MAX));
  const TaiTime t = is_whole ? tai_from_ns(value->get<std::int64_t>()) : TaiTime::min();
  if (!is_telemetry_time(t)) {
    wrong(fmt::format("{}: {}: must be nanoseconds of TAI, {} to before {}", key, said(*value),
                      tai_ns(kEarliestTelemetry), tai_ns(kLatestTelemetry)));
  }
  return t;
}

std::string SaidValues::problems() const {
  std::vector<std::string> all = problems_;
  for (const auto& [key, value] : object_.items()) {
    if (std::find(asked_.begin(), asked_.end(), key) == asked_.end()) {
      all.push_back(fmt::format("{} is not known here: {}", shown(key),
                                asked_.empty() ? "nothing is asked for"
                                               : fmt::format("{} are", fmt::join(asked_, ", "))));
    }
  }
  return fmt::format("{}", fmt::join(all, "; "));
}

constexpr std::array<const char*, 5> kOfEveryAction = {"spacecraft", "by", "action", "note",
                                                       "t_tai_ns"};
constexpr std::array kSensorKinds = {SampleKind::Gyro, SampleKind::Star, SampleKind::Sun,
                                     SampleKind::Magnetometer};

/// Returns the names used in the archive.
std::array<std::string_view, kSensorKinds.size()> sensor_names() {
  std::array<std::string_view, kSensorKinds.size()> names;
  std::transform(kSensorKinds.begin(), kSensorKinds.end(), names.begin(),
                 [](SampleKind kind) { return name_of(kind); });
  return names;
}

void read(SaidValues& said, PulseChannel& channel) {
  channel = static_cast<PulseChannel>(said.name("channel", kPulseChannelNames));
}
void read(SaidValues& said, SampleKind& sensor) {
  sensor = kSensorKinds.at(said.name("channel", sensor_names()));
}

template <class Action, class OfChannel>
ActionEffect of_channel(SaidValues& said) {
  OfChannel action{};
  read(said, action.channel);
  return Action{action};
}

template <class Action, class Channel>
ActionEffect of_segment(SaidValues& said) {
  ExcludeSegment<Channel> segment{
      .from = said.time("from_tai_ns"), .to = said.time("to_tai_ns"), .channel = {}};
  if (segment.to <= segment.from) {
    said.wrong(fmt::format("to_tai_ns: {}: must be later than from_tai_ns", tai_ns(segment.to)));
  }
  if (said.has("channel")) {
    read(said, segment.channel.emplace());
  }
  return Action{segment};
}

Eigen::Vector3d axis_icrf(SaidValues& said) {
  const double ra_deg = said.number("ra_deg", -360.0, 360.0);
  const double dec_deg = said.number("dec_deg", -90.0, 90.0);
  return direction_icrf({.ra_rad = ra_deg * kRadPerDeg, .dec_rad = dec_deg * kRadPerDeg});
}

SpinPrior prior(SaidValues& said) {
  const Eigen::Vector3d axis = axis_icrf(said);
  return {.axis_icrf = axis, .sigma_rad = said.number("sigma_deg", 1e-3, 180.0) * kRadPerDeg};
}

/// Takes the limits that the mission file may have for the alert, with the same bounds.
ActionEffect limits_of_alert(SaidValues& said) {
  std::array<std::string_view, kAlertCodes> keys;
  for (int i = 0; i < kAlertCodes; ++i) {
    keys.at(static_cast<std::size_t>(i)) = name_of(static_cast<AlertCode>(i));
  }
  SetLimit set{.key = std::string{keys.at(said.name("key", keys))}, .limits = {}};
  const TableRule schema = mission_schema().value();
  const auto& rules = schema.tables.at("alerts").tables.at(set.key).keys;
  for (const auto& [name, rule] : rules) {
    if (said.has(name.c_str())) {
      set.limits[name] =
          said.number(name.c_str(), as_number(rule.lower->value), as_number(rule.upper->value));
    }
  }
  if (set.limits.empty()) {
    said.wrong(fmt::format("a limit of {} is missing", set.key));
  }
  return set;
}

/// An action by name with how its arguments are read for each kind of spacecraft; null where that
/// kind does not have it.
struct KnownAction {
  std::string_view name;
  ActionEffect (*of_spinner)(SaidValues& said);
  ActionEffect (*of_three_axis)(SaidValues& said) = nullptr;

  auto read_for(SpacecraftKind kind) const {
    return kind == SpacecraftKind::Spin ? of_spinner : of_three_axis;
  }
};

/// The only list of actions. The page and the schema of the archive are tested against it.
constexpr std::array<KnownAction, 8> kActions{{
    {"exclude_channel", &of_channel<SpinAction, ExcludeChannel<PulseChannel>>,
     &of_channel<AttitudeAction, ExcludeChannel<SampleKind>>},
    {"include_channel", &of_channel<SpinAction, IncludeChannel<PulseChannel>>,
     &of_channel<AttitudeAction, IncludeChannel<SampleKind>>},
    {"exclude_segment", &of_segment<SpinAction, PulseChannel>,
     &of_segment<AttitudeAction, SampleKind>},
    {"choose_root",
     [](SaidValues& said) -> ActionEffect { return SpinAction{ChooseRoot{axis_icrf(said)}}; }},
    {"set_prior",
     [](SaidValues& said) -> ActionEffect { return SpinAction{SetPrior{prior(said)}}; }},
    {"mark_manoeuvre",
     [](SaidValues& /*said*/) -> ActionEffect { return SpinAction{MarkManoeuvre{}}; }},
    {"set_target",
     [](SaidValues& said) -> ActionEffect { return SpinAction{SetTarget{axis_icrf(said)}}; }},
    {"set_limit", &limits_of_alert, &limits_of_alert},
}};

Unexpected invalid(std::string message) {
  return Unexpected{{ErrorCode::InvalidInput, std::move(message)}};
}

/// Sets the time of a segment's action to its beginning, which usually lies in the past.
Expected<OperatorAction> with_time(OperatorAction action) {
  if (const auto segment = segment_in(action.does)) {
    action.t = action.t.value_or(segment->from);
    if (segment->to <= *action.t) {
      return invalid(fmt::format("{}: to_tai_ns: {}: must be later than t_tai_ns, {}",
                                 action.action, tai_ns(segment->to), tai_ns(*action.t)));
    }
  }
  return action;
}

Expected<Nameable> find(const std::string& spacecraft, const KnownSpacecraft& known) {
  const auto found = known.find(spacecraft);
  if (found != known.end()) {
    return found->second;
  }
  std::vector<std::string> names;
  for (const auto& [name, of_spacecraft] : known) {
    names.push_back(name);
  }
  return invalid(fmt::format("spacecraft: '{}': must be one of {}", shown(spacecraft),
                             fmt::join(names, ", ")));
}

template <class What>
std::optional<std::string_view> channel_in(const What& what) {
  if constexpr (requires { what.channel.has_value(); }) {
    return what.channel ? std::optional{name_of(*what.channel)} : std::nullopt;
  } else if constexpr (requires { name_of(what.channel); }) {
    return name_of(what.channel);
  } else {
    return std::nullopt;
  }
}

/// A name that an action names, and those that it may.
struct Named {
  const char* key;
  std::optional<std::string_view> name;
  const std::vector<std::string_view>& allowed;
};

Named named_in(const ActionEffect& does, const Nameable& known) {
  return std::visit(
      [&](const auto& of_kind) -> Named {
        if constexpr (requires { of_kind.key; }) {
          return {"key", of_kind.key, known.alerts};
        } else {
          return {"channel", std::visit([](const auto& what) { return channel_in(what); }, of_kind),
                  known.channels};
        }
      },
      does);
}

/// Refuses what the mission lacks. An action from an archive, whose mission may have had it, is not
/// asked.
Expected<OperatorAction> within_mission(OperatorAction action, const Nameable& known) {
  const auto [key, name, allowed] = named_in(action.does, known);
  if (!name || std::find(allowed.begin(), allowed.end(), *name) != allowed.end()) {
    return action;
  }
  return invalid(fmt::format("{}: {}: \"{}\": the mission of {} has none: must be one of {}",
                             action.action, key, *name, action.spacecraft,
                             fmt::join(allowed, ", ")));
}

}  // namespace

std::optional<Segment> segment_in(const ActionEffect& does) {
  const auto of_one = [](const auto& what) -> std::optional<Segment> {
    if constexpr (requires { what.from; }) {
      return Segment{.from = what.from, .to = what.to};
    } else {
      return std::nullopt;
    }
  };
  return std::visit(
      [&](const auto& of_kind) -> std::optional<Segment> {
        if constexpr (std::is_same_v<std::remove_cvref_t<decltype(of_kind)>, SetLimit>) {
          return std::nullopt;
        } else {
          return std::visit(of_one, of_kind);
        }
      },
      does);
}

std::vector<std::string_view> action_names(std::optional<SpacecraftKind> kind) {
  std::vector<std::string_view> names;
  for (const KnownAction& known : kActions) {
    if (!kind || known.read_for(*kind) != nullptr) {
      names.push_back(known.name);
    }
  }
  return names;
}

Expected<ActionEffect> what_it_does(SpacecraftKind kind, const std::string& action,
                                    const nlohmann::json& arguments) {
  if (!arguments.is_object()) {
    return invalid("an action must be a JSON object");
  }
  const auto* const known = std::find_if(kActions.begin(), kActions.end(), [&](const auto& one) {
    return one.name == action && one.read_for(kind) != nullptr;
  });
  if (known == kActions.end()) {
    return invalid(fmt::format("action: '{}': must be one of {}", shown(action),
                               fmt::join(action_names(kind), ", ")));
  }
  SaidValues said{arguments};
  ActionEffect effect = known->read_for(kind)(said);
  const std::string problems = said.problems();
  return problems.empty() ? Expected<ActionEffect>{std::move(effect)}
                          : invalid(fmt::format("{}: {}", action, problems));
}

Expected<OperatorAction> parse_action(const nlohmann::json& request, const KnownSpacecraft& known) {
  if (!request.is_object()) {
    return invalid("an action must be a JSON object");
  }
  nlohmann::json of_every_action = nlohmann::json::object();
  nlohmann::json arguments = request;
  for (const char* const key : kOfEveryAction) {
    if (request.contains(key)) {
      of_every_action[key] = request.at(key);
      arguments.erase(key);
    }
  }
  SaidValues said{of_every_action};
  OperatorAction action{
      .action_id = unique_id(),
      .spacecraft = said.text("spacecraft"),
      .t = said.time_if("t_tai_ns"),
      .made_utc = utc_now(),
      .by = said.text("by"),
      .action = said.text("action"),
      .arguments = arguments.dump(-1, ' ', false, nlohmann::json::error_handler_t::replace),
      .note = said.text_or_empty("note"),
      .does = {}};
  if (const std::string problems = said.problems(); !problems.empty()) {
    return invalid(problems);
  }
  return find(action.spacecraft, known).and_then([&](const Nameable& of_spacecraft) {
    return what_it_does(of_spacecraft.kind, action.action, arguments)
        .and_then([&](const ActionEffect& does) {
          action.does = does;
          return within_mission(action, of_spacecraft);
        })
        .and_then(with_time);
  });
}

}  // namespace spindrift
