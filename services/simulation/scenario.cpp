#include "services/simulation/scenario.h"

#include <fmt/format.h>
#include <toml++/toml.h>

#include <sstream>
#include <string>
#include <string_view>
#include <utility>
#include <vector>

#include "pipelines/core/shown.h"
#include "pipelines/time/utc.h"
#include "services/base/input_file.h"
#include "services/mission/document.h"
#include "services/mission/mission_orbit.h"
#include "services/mission/spacecraft_kind.h"
#include "services/mission/values.h"
#include "services/simulation/dispersions.h"
#include "services/simulation/scenario_schema.h"
#include "services/simulation/three_axis_scenario.h"

namespace spindrift {
namespace {

// Twice the longest turn, since the search for the next edge looks one turn ahead.
constexpr double kOrbitMargin_s = 30.0;
// Limits of pass.start_tai_ns: UTC exists, and not all leap seconds are guesses.
constexpr TaiTime kEarliest = tai_from_ns(63158400000000000);
constexpr TaiTime kLatest = tai_from_ns(4102444800000000000);

ScenarioKind kind_of(const toml::table& scenario) {
  if (scenario["spacecraft"]["kind"].value<std::string>() != name_of(SpacecraftKind::ThreeAxis)) {
    return ScenarioKind::Spin;
  }
  const auto model = scenario["attitude"]["model"].value<std::string>();
  if (model == "tumbling") {
    return ScenarioKind::Tumbling;
  }
  if (model == "rescue") {
    return ScenarioKind::Rescue;
  }
  return model == "orientation" ? ScenarioKind::Orientation : ScenarioKind::Separation;
}

std::optional<TaiTime> start_of(TomlDocument& document) {
  if (const auto t_tai_ns = value_if<std::int64_t>(document.values, "pass.start_tai_ns")) {
    return tai_from_ns(*t_tai_ns);
  }
  const auto text = value_if<std::string>(document.values, "pass.start_utc");
  if (!text) {
    return std::nullopt;
  }
  const auto t = parse_utc(*text);
  const bool in_range = t && *t >= kEarliest && *t <= kLatest;
  if (!in_range) {
    add_problem(document, "pass.start_utc",
                fmt::format("pass.start_utc = \"{}\": {}", shown(*text),
                            t ? fmt::format("must lie in [{}, {}]", format_utc(kEarliest, 0),
                                            format_utc(kLatest, 0))
                              : t.error().message));
    return std::nullopt;
  }
  return *t;
}

void check_coverage(TomlDocument& document, const Orbit& orbit, std::optional<TaiTime> start) {
  const auto duration_s = value_if<double>(document.values, "pass.duration_s");
  if (!start || !duration_s) {
    return;
  }
  for (const double t_s : {-kOrbitMargin_s, *duration_s + kOrbitMargin_s}) {
    if (const auto state = orbit.at(shifted(*start, t_s)); !state) {
      add_problem(document, orbit_key(document.values),
                  fmt::format("{}: must cover the pass and {} s on both sides: {}",
                              orbit_key(document.values), kOrbitMargin_s, state.error().message));
    }
  }
}

/// Shifts an orbit in time from `own_start` to `start`, with the same states in ICRF.
Expected<Orbit> moved_orbit(const Orbit& orbit, TaiTime own_start, TaiTime start) {
  if (orbit.ephemeris() == nullptr) {
    return orbit.at(own_start)
        .and_then([&](const OrbitState& state) { return KeplerOrbit::through(start, state); })
        .map([](const KeplerOrbit& moved) { return Orbit{moved}; });
  }
  std::vector<OemSegment> segments = orbit.ephemeris()->segments();
  for (OemSegment& segment : segments) {
    segment.usable_from += start - own_start;
    segment.usable_to += start - own_start;
    for (EphemerisPoint& point : segment.points) {
      point.t += start - own_start;
    }
  }
  return OrbitEphemeris::make(std::move(segments)).map([](OrbitEphemeris&& moved) {
    return Orbit{std::move(moved)};
  });
}

/// Returns the scenario's orbit, shifted to a pass at `start` where that is given.
Expected<MissionOrbit> orbit_at(const TomlDocument& document, std::optional<TaiTime> own_start,
                                std::optional<TaiTime> start) {
  return load_orbit(document.values, document.path.parent_path())
      .and_then([&](MissionOrbit&& loaded) -> Expected<MissionOrbit> {
        if (!loaded.orbit || !own_start || start == own_start) {
          return std::move(loaded);
        }
        return moved_orbit(*loaded.orbit, *own_start, *start).map([](Orbit&& moved) {
          return MissionOrbit{.orbit = std::move(moved), .file_sha256 = std::nullopt};
        });
      });
}

std::optional<std::filesystem::path> oem_of(const TomlDocument& document) {
  const auto oem = value_if<std::string>(document.values, "orbit.oem");
  return oem ? std::optional{document.path.parent_path() / *oem} : std::nullopt;
}

void check_flight(TomlDocument& document) {
  switch (kind_of(document.table)) {
    case ScenarioKind::Spin:
      return check_spin_scenario(document);
    case ScenarioKind::Separation:
      return check_separation_scenario(document);
    case ScenarioKind::Tumbling:
      return check_tumbling_scenario(document);
    case ScenarioKind::Orientation:
      return check_orientation_scenario(document);
    case ScenarioKind::Rescue:
      return check_rescue_scenario(document);
  }
}

/// Adds a problem for what a table on board needs and the spacecraft has not.
void check_carried_table(TomlDocument& document) {
  if (!document.values.contains("field_table.kind")) {
    return;
  }
  for (const char* const needed :
       {"orbit.elements", "three_axis.sun_sensor", "three_axis.magnetometer"}) {
    if (!document.table.at_path(needed)) {
      add_problem(document, "field_table",
                  fmt::format("[field_table]: needs [{}]: the table is of one revolution of the "
                              "elements, and its attitude of Sun and field",
                              needed));
    }
  }
}

std::optional<CarriedTable> carried_table(const TomlValues& values) {
  const auto name = value_if<std::string>(values, "field_table.kind");
  if (!name) {
    return std::nullopt;
  }
  return CarriedTable{
      .kind = *table_kind(*name),
      .points = static_cast<int>(value_of<std::int64_t>(values, "field_table.points"))};
}

decltype(Scenario::flight) flight_of(const TomlDocument& document, TaiTime start) {
  switch (kind_of(document.table)) {
    case ScenarioKind::Separation:
      return separation_scenario(document.values, start);
    case ScenarioKind::Tumbling:
      return tumbling_scenario(document.values, start);
    case ScenarioKind::Orientation:
      return orientation_scenario(document.values, start);
    case ScenarioKind::Rescue:
      return rescue_scenario(document.values, start);
    case ScenarioKind::Spin:
      break;
  }
  return spin_scenario(document.values, start);
}

/// Formats a value here, as the TOML library would write a number with 17 digits.
std::string value_text(const toml::node& value) {
  if (const auto number = value.value_exact<double>()) {
    return fmt::format("{}", *number);
  }
  if (const toml::array* const array = value.as_array()) {
    std::vector<std::string> elements;
    for (const toml::node& element : *array) {
      elements.push_back(value_text(element));
    }
    return fmt::format("[{}]", fmt::join(elements, ", "));
  }
  std::ostringstream text;
  value.visit([&](const auto& node) { text << node; });
  return text.str();
}

void append_table(const toml::table& table, const std::string& path, std::string& text) {
  std::string values;
  for (const auto& [key, node] : table) {
    if (!node.is_table()) {
      values += fmt::format("{} = {}\n", key.str(), value_text(node));
    }
  }
  if (!values.empty()) {
    text += fmt::format("\n[{}]\n{}", path, values);
  }
  for (const auto& [key, node] : table) {
    if (const toml::table* const inner = node.as_table()) {
      append_table(*inner, fmt::format("{}.{}", path, key.str()), text);
    }
  }
}

/// Returns the tables that a valid scenario shares with a mission file, unchanged; the orbit is the
/// simulated one, in orbit.oem beside it.
std::string mission_text(const toml::table& scenario) {
  std::string text = "# Written by spindrift simulate for the pass beside it.\n";
  append_table(*scenario.get_as<toml::table>("spacecraft"), "spacecraft", text);
  text += "\n[orbit]\noem = \"orbit.oem\"\n";
  for (const char* const sensors : {"spin", "three_axis"}) {
    if (const toml::table* const table = scenario.get_as<toml::table>(sensors)) {
      append_table(*table, sensors, text);
    }
  }
  return text;
}

}  // namespace

Expected<TomlDocument> checked_scenario(const std::filesystem::path& path, toml::table table) {
  return scenario_schema(kind_of(table)).map([&](const TableRule& schema) {
    auto [values, problems] = check_document(schema, table);
    return TomlDocument{.path = path,
                        .text = {},
                        .table = std::move(table),
                        .values = std::move(values),
                        .problems = std::move(problems)};
  });
}

Expected<TomlDocument> read_scenario(const std::filesystem::path& path) {
  return read_text_file(path).and_then([&](std::string&& text) {
    return parsed_toml(path, text).and_then([&](toml::table&& table) {
      return checked_scenario(path, std::move(table));
    });
  });
}

Expected<Scenario> scenario_of(TomlDocument document, std::optional<TaiTime> other_start) {
  const auto own_start = start_of(document);
  const auto start = other_start ? other_start : own_start;
  auto orbit = orbit_at(document, own_start, start);
  if (!orbit) {
    add_problem(document, orbit_key(document.values), std::move(orbit.error().message));
  } else if (orbit->orbit) {
    check_coverage(document, *orbit->orbit, start);
  }
  check_flight(document);
  check_carried_table(document);
  check_dispersions(document);
  if (auto sound = soundness(document); !sound) {
    return Unexpected{std::move(sound.error())};
  }
  return Scenario{.spacecraft_id = value_of<std::string>(document.values, "spacecraft.id"),
                  .orbit = std::move(*orbit->orbit),
                  .oem = other_start ? std::nullopt : oem_of(document),
                  .start = *start,
                  .duration_s = number(document.values, "pass.duration_s"),
                  .flight = flight_of(document, *start),
                  .mission_toml = mission_text(document.table),
                  .carried_table = carried_table(document.values)};
}

Expected<Scenario> load_scenario(const std::filesystem::path& path,
                                 std::optional<TaiTime> other_start) {
  return read_scenario(path).and_then(
      [&](TomlDocument&& document) { return scenario_of(std::move(document), other_start); });
}

}  // namespace spindrift
