#include "services/simulation/on_board_pass.h"

#include <fmt/format.h>

#include <algorithm>
#include <cmath>

#include "pipelines/frames/angle.h"
#include "pipelines/frames/rotation_vector.h"
#include "pipelines/geomagnetism/tables/on_board_attitude.h"
#include "pipelines/geomagnetism/tables/revolution_field.h"
#include "services/mission/igrf.h"

namespace spindrift {
namespace {

using nlohmann::ordered_json;

/// Returns what the computer knows: the table is that of `geomag table` for the date of the epoch.
Expected<OnBoardModel> model_of(const KeplerOrbit& orbit, const CarriedTable& carried) {
  return igrf().and_then([&](const MainFieldModel& model) {
    return model.at(decimal_year(orbit.epoch())).and_then([&](const MainField& field) {
      RevolutionField revolution{orbit, field};
      return make_table([&](double behind_rad) { return revolution.at(behind_rad); }, carried.kind,
                        orbit.true_anomaly_at_epoch_rad(), carried.points)
          .map([&](FieldTable&& table) {
            return OnBoardModel{.orbit = orbit, .table = std::move(table), .field = field};
          });
    });
  });
}

template <class Value>
std::vector<Value> values_of(const PlacedValues& telemetry) {
  std::vector<Value> values;
  for (const auto& placed : telemetry.of<Value>()) {
    values.push_back(placed.value);
  }
  return values;
}

/// Returns the largest and the root mean square of the errors.
ordered_json error_json(const OnBoardPass& pass, double OnBoardError::*error_rad) {
  double most_rad = 0.0;
  double sum_rad2 = 0.0;
  for (const OnBoardError& error : pass.errors) {
    most_rad = std::max(most_rad, error.*error_rad);
    sum_rad2 += error.*error_rad * (error.*error_rad);
  }
  const auto count = static_cast<double>(std::max<std::size_t>(pass.errors.size(), 1));
  return {{"largest_deg", kDegPerRad * most_rad},
          {"rms_deg", kDegPerRad * std::sqrt(sum_rad2 / count)}};
}

std::string error_text(const ordered_json& error) {
  return fmt::format("at most {:.3f} deg, rms {:.3f} deg", error["largest_deg"].get<double>(),
                     error["rms_deg"].get<double>());
}

}  // namespace

Expected<OnBoardPass> on_board_pass(const Scenario& scenario, const PlacedValues& telemetry,
                                    const BodyMotion& motion) {
  return model_of(*scenario.orbit.elements(), *scenario.carried_table)
      .and_then([&](const OnBoardModel& model) {
        return on_board_attitudes(model, values_of<SunDirection>(telemetry),
                                  values_of<MagneticField>(telemetry))
            .map([&](const std::vector<OnBoardAttitude>& attitudes) {
              OnBoardPass pass{.table_bytes = model.table.bytes(), .errors = {}};
              for (const auto& [t, by_table, by_field] : attitudes) {
                const double t_s = seconds_between(scenario.start, t);
                const Eigen::Quaterniond truth = motion.at(t_s).q_icrf_body;
                pass.errors.push_back({.t_s = t_s,
                                       .with_table_rad = angle_between_rad(truth, by_table),
                                       .with_field_rad = angle_between_rad(truth, by_field),
                                       .by_table_rad = angle_between_rad(by_field, by_table)});
              }
              return pass;
            });
      });
}

ordered_json to_json(const OnBoardPass& pass) {
  return {{"table_bytes", pass.table_bytes},
          {"attitudes", pass.errors.size()},
          {"error_with_table", error_json(pass, &OnBoardError::with_table_rad)},
          {"error_with_field", error_json(pass, &OnBoardError::with_field_rad)},
          {"moved_by_table", error_json(pass, &OnBoardError::by_table_rad)}};
}

std::string on_board_text(const CarriedTable& table, const ordered_json& json) {
  return fmt::format(
      "  on board, by Sun and field: {} attitudes\n"
      "    error with the {} table of {} points, {} bytes: {}\n"
      "    error with the field itself in its place: {}\n"
      "    the table moves the attitude by {}\n",
      json["attitudes"].get<std::size_t>(), name_of(table.kind), table.points,
      json["table_bytes"].get<std::size_t>(), error_text(json["error_with_table"]),
      error_text(json["error_with_field"]), error_text(json["moved_by_table"]));
}

}  // namespace spindrift
