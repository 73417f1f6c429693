#include "services/mission/mission_schema.h"

#include <string>

#include "pipelines/supervision/alert_code.h"

namespace spindrift {

namespace embedded {
extern const char* const mission_schema_toml;
}

namespace {

/// Gives each alert its hold-off, with the same rule for all.
TableRule with_hold_offs(TableRule schema) {
  constexpr double kDefault_s = 60.0;
  constexpr double kLongest_s = 86'400.0;
  for (int i = 0; i < kAlertCodes; ++i) {
    const std::string key{name_of(static_cast<AlertCode>(i))};
    TableRule& alert = schema.tables["alerts"].tables[key];
    alert.about = alert.about.empty() ? "the alert " + key : alert.about;
    alert.keys["hold_off_s"] = {
        .type = ValueType::Number,
        .shape = {},
        .unit = "s",
        .about = "a condition that returns within it is the same occurrence",
        .default_value = kDefault_s,
        .optional = false,
        .lower = Bound{.value = 0.0, .inclusive = true},
        .upper = Bound{.value = kLongest_s, .inclusive = true},
        .not_below_keys = {},
        .one_of = {},
        .form = {}};
  }
  return schema;
}

}  // namespace

Expected<TableRule> mission_schema() {
  return parse_schema(embedded::mission_schema_toml).map(with_hold_offs);
}

}  // namespace spindrift
