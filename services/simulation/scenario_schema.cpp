#include "services/simulation/scenario_schema.h"

#include <utility>

#include "services/mission/mission_schema.h"

namespace spindrift {

namespace embedded {
extern const char* const scenario_schema_toml;
extern const char* const three_axis_schema_toml;
extern const char* const separation_schema_toml;
extern const char* const tumbling_schema_toml;
extern const char* const orientation_schema_toml;
extern const char* const rescue_schema_toml;
}  // namespace embedded

namespace {

void share(const TableRule& from, const char* table, TableRule& with) {
  with.tables.emplace(table, from.tables.at(table));
}

/// Returns the schema of a model of a three-axis spacecraft.
const char* model_schema(ScenarioKind kind) {
  return kind == ScenarioKind::Tumbling      ? embedded::tumbling_schema_toml
         : kind == ScenarioKind::Orientation ? embedded::orientation_schema_toml
         : kind == ScenarioKind::Rescue      ? embedded::rescue_schema_toml
                                             : embedded::separation_schema_toml;
}

/// Requires a body, for a separation each sensor that its events rely on, and for a rescue the
/// magnetometer and the attitude to return to.
void require_sensors(ScenarioKind kind, TableRule& three_axis) {
  three_axis.required = "always";
  three_axis.tables.at("inertia").required = "always";
  if (kind == ScenarioKind::Rescue) {
    for (const char* const table : {"magnetometer", "nominal"}) {
      three_axis.tables.at(table).required = "always";
    }
  }
  if (kind == ScenarioKind::Separation) {
    for (const char* const table : {"gyro", "sun_sensor", "star_tracker"}) {
      three_axis.tables.at(table).required = "always";
    }
  }
}

Expected<TableRule> three_axis_schema(ScenarioKind kind, const TableRule& mission,
                                      const TableRule& spin) {
  constexpr double kLongest_s = 86400.0;
  auto schema = parse_schema(embedded::three_axis_schema_toml);
  const auto model = parse_schema(model_schema(kind));
  if (!schema || !model) {
    return schema ? model : schema;
  }
  schema->tables.insert(model->tables.begin(), model->tables.end());
  for (const char* const table : {"spacecraft", "orbit", "three_axis"}) {
    share(mission, table, *schema);
  }
  schema->tables.at("orbit").required = "always";
  require_sensors(kind, schema->tables.at("three_axis"));
  share(spin, "pass", *schema);
  share(spin, "dispersions", *schema);
  schema->tables.at("pass").keys.at("duration_s").upper = Bound{kLongest_s, true};
  share(spin.tables.at("faults"), "silence", schema->tables.at("faults"));
  return schema;
}

}  // namespace

Expected<TableRule> scenario_schema(ScenarioKind kind) {
  auto spin = parse_schema(embedded::scenario_schema_toml);
  const auto mission = mission_schema();
  if (!spin || !mission) {
    return spin ? mission : spin;
  }
  if (kind != ScenarioKind::Spin) {
    return three_axis_schema(kind, *mission, *spin);
  }
  for (const char* const table : {"spacecraft", "orbit", "spin"}) {
    share(*mission, table, *spin);
  }
  return spin;
}

}  // namespace spindrift
