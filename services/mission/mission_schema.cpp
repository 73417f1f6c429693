#include "services/mission/mission_schema.h"

#include <array>
#include <string>
#include <utility>

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

/// Lets the limits of the answer's quality differ before and after the contact.
TableRule with_phases(TableRule schema) {
  constexpr std::array kOfQuality{AlertCode::SpinAmbiguous,    AlertCode::SpinDoubtful,
                                  AlertCode::SpinSigma,        AlertCode::SpinDisagree,
                                  AlertCode::SpinNoAnswer,     AlertCode::AttitudeDoubtful,
                                  AlertCode::AttitudeDiverged, AlertCode::AttitudeNoAnswer};
  TableRule& alerts = schema.tables["alerts"];
  for (const auto& [phase, about] :
       {std::pair{"before_aos", "limits that hold before aos_utc of [contact]"},
        std::pair{"after_los", "limits that hold from los_utc of [contact] on"}}) {
    TableRule of_phase{.about = about};
    for (const AlertCode code : kOfQuality) {
      const std::string key{name_of(code)};
      TableRule& alert = of_phase.tables[key] = alerts.tables.at(key);
      alert.keys.erase("hold_off_s");
      for (auto& [name, rule] : alert.keys) {
        rule.default_value.reset();
        rule.optional = true;
      }
    }
    alerts.tables[phase] = std::move(of_phase);
  }
  return schema;
}

}  // namespace

Expected<TableRule> mission_schema() {
  return parse_schema(embedded::mission_schema_toml).map(with_hold_offs).map(with_phases);
}

}  // namespace spindrift
