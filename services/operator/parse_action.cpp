#include "services/operator/parse_action.h"

#include <fmt/format.h>
#include <fmt/ranges.h>

#include <algorithm>
#include <array>
#include <optional>
#include <string_view>
#include <utility>
#include <vector>

#include "pipelines/core/shown.h"
#include "pipelines/frames/angle.h"
#include "pipelines/frames/celestial.h"
#include "services/base/unique_id.h"
#include "services/base/wall_clock.h"
#include "services/operator/said_values.h"

namespace spindrift {
namespace {

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

template <class Channel>
ExcludeSegment<Channel> segment(SaidValues& said) {
  ExcludeSegment<Channel> segment{
      .from = said.time("from_tai_ns"), .to = said.time("to_tai_ns"), .channel = {}};
  if (segment.to <= segment.from) {
    said.wrong(fmt::format("to_tai_ns: {}: must be later than from_tai_ns", tai_ns(segment.to)));
  }
  if (said.has("channel")) {
    read(said, segment.channel.emplace());
  }
  return segment;
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

/// An action by name; actions on channels exist for every kind of spacecraft.
template <class Action>
struct Named {
  std::string_view name;
  Action (*read)(SaidValues& said);
};

template <class Action, class Channel>
std::vector<Named<Action>> of_channels() {
  return {{"exclude_channel",
           [](SaidValues& said) -> Action {
             ExcludeChannel<Channel> action{};
             read(said, action.channel);
             return action;
           }},
          {"include_channel",
           [](SaidValues& said) -> Action {
             IncludeChannel<Channel> action{};
             read(said, action.channel);
             return action;
           }},
          {"exclude_segment", [](SaidValues& said) -> Action { return segment<Channel>(said); }}};
}

std::vector<Named<SpinAction>> of_spinners() {
  auto all = of_channels<SpinAction, PulseChannel>();
  all.push_back(
      {"choose_root", [](SaidValues& said) -> SpinAction { return ChooseRoot{axis_icrf(said)}; }});
  all.push_back(
      {"set_prior", [](SaidValues& said) -> SpinAction { return SetPrior{prior(said)}; }});
  all.push_back(
      {"mark_manoeuvre", [](SaidValues& /*said*/) -> SpinAction { return MarkManoeuvre{}; }});
  all.push_back(
      {"set_target", [](SaidValues& said) -> SpinAction { return SetTarget{axis_icrf(said)}; }});
  return all;
}

Unexpected invalid(std::string message) {
  return Unexpected{{ErrorCode::InvalidInput, std::move(message)}};
}

template <class Action>
Expected<std::variant<SpinAction, AttitudeAction>> one_of(const std::vector<Named<Action>>& all,
                                                          const std::string& name,
                                                          const nlohmann::json& arguments) {
  std::vector<std::string_view> names;
  for (const Named<Action>& known : all) {
    names.push_back(known.name);
    if (known.name == name) {
      SaidValues said{arguments};
      Action action = known.read(said);
      const std::string problems = said.problems();
      return problems.empty()
                 ? Expected<std::variant<SpinAction, AttitudeAction>>{std::move(action)}
                 : invalid(fmt::format("{}: {}", name, problems));
    }
  }
  return invalid(
      fmt::format("action: '{}': must be one of {}", shown(name), fmt::join(names, ", ")));
}

struct Segment {
  TaiTime from;
  TaiTime to;
};

/// Returns empty for an action without a segment.
std::optional<Segment> segment_in(const std::variant<SpinAction, AttitudeAction>& does) {
  const auto of_one = [](const auto& what) -> std::optional<Segment> {
    if constexpr (requires { what.from; }) {
      return Segment{.from = what.from, .to = what.to};
    } else {
      return std::nullopt;
    }
  };
  return std::visit([&](const auto& of_kind) { return std::visit(of_one, of_kind); }, does);
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

Expected<SpacecraftKind> kind_of(const std::string& spacecraft, const KnownSpacecraft& known) {
  const auto found = known.find(spacecraft);
  if (found != known.end()) {
    return found->second;
  }
  std::vector<std::string> names;
  for (const auto& [name, kind] : known) {
    names.push_back(name);
  }
  return invalid(fmt::format("spacecraft: '{}': must be one of {}", shown(spacecraft),
                             fmt::join(names, ", ")));
}

}  // namespace

Expected<std::variant<SpinAction, AttitudeAction>> what_it_does(SpacecraftKind kind,
                                                                const std::string& action,
                                                                const nlohmann::json& arguments) {
  if (!arguments.is_object()) {
    return invalid("an action must be a JSON object");
  }
  return kind == SpacecraftKind::Spin
             ? one_of(of_spinners(), action, arguments)
             : one_of(of_channels<AttitudeAction, SampleKind>(), action, arguments);
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
  return kind_of(action.spacecraft, known)
      .and_then([&](SpacecraftKind kind) { return what_it_does(kind, action.action, arguments); })
      .and_then([&](const std::variant<SpinAction, AttitudeAction>& does) {
        action.does = does;
        return with_time(action);
      });
}

}  // namespace spindrift
