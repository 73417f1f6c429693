#include "services/scenario/scenario_schema.h"

#include "services/mission/mission_schema.h"

namespace spindrift {

namespace embedded {
extern const char* const scenario_schema_toml;
extern const char* const separation_schema_toml;
}  // namespace embedded

namespace {

void share(const TableRule& from, const char* table, TableRule& with) {
  with.tables.emplace(table, from.tables.at(table));
}

/// A body is needed, and each sensor that a separation always has.
void require_sensors(TableRule& three_axis) {
  for (const char* const table : {"gyro", "sun_sensor", "star_tracker", "inertia"}) {
    three_axis.tables.at(table).required = "always";
  }
}

Expected<TableRule> separation_schema(const TableRule& mission, const TableRule& spin) {
  constexpr double kLongest_s = 86400.0;
  return parse_schema(embedded::separation_schema_toml).map([&](TableRule&& schema) {
    for (const char* const table : {"spacecraft", "orbit", "three_axis"}) {
      share(mission, table, schema);
    }
    schema.tables.at("orbit").required = "always";
    require_sensors(schema.tables.at("three_axis"));
    share(spin, "pass", schema);
    schema.tables.at("pass").keys.at("duration_s").upper = Bound{kLongest_s, true};
    share(spin.tables.at("faults"), "silence", schema.tables.at("faults"));
    return std::move(schema);
  });
}

}  // namespace

Expected<TableRule> scenario_schema(SpacecraftKind kind) {
  auto spin = parse_schema(embedded::scenario_schema_toml);
  const auto mission = mission_schema();
  if (!spin || !mission) {
    return spin ? mission : spin;
  }
  if (kind == SpacecraftKind::ThreeAxis) {
    return separation_schema(*mission, *spin);
  }
  for (const char* const table : {"spacecraft", "orbit", "spin"}) {
    share(*mission, table, *spin);
  }
  return spin;
}

}  // namespace spindrift
