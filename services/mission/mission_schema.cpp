#include "services/mission/mission_schema.h"

namespace spindrift {

namespace embedded {
extern const char* const mission_schema_toml;
}

Expected<TableRule> mission_schema() { return parse_schema(embedded::mission_schema_toml); }

}  // namespace spindrift
