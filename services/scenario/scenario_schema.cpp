#include "services/scenario/scenario_schema.h"

#include "services/mission/mission_schema.h"

namespace spindrift {

namespace embedded {
extern const char* const scenario_schema_toml;
}

Expected<TableRule> scenario_schema() {
  auto schema = parse_schema(embedded::scenario_schema_toml);
  const auto mission = mission_schema();
  if (!schema || !mission) {
    return schema ? mission : schema;
  }
  for (const char* const shared : {"spacecraft", "orbit", "spin"}) {
    schema->tables.emplace(shared, mission->tables.at(shared));
  }
  // No other kind can be simulated yet.
  schema->tables.at("spacecraft").keys.at("kind").one_of = {"spin"};
  return schema;
}

}  // namespace spindrift
