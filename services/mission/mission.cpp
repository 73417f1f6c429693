#include "services/mission/mission.h"

#include <fmt/format.h>

#include <array>
#include <cstddef>
#include <optional>
#include <utility>

#include "services/base/input_file.h"
#include "services/base/sha256.h"
#include "services/mission/document.h"
#include "services/mission/igrf.h"
#include "services/mission/mission_alerts.h"
#include "services/mission/mission_orbit.h"
#include "services/mission/mission_schema.h"
#include "services/mission/mission_spin.h"
#include "services/mission/mission_three_axis.h"
#include "services/mission/values.h"

namespace spindrift {
namespace {

SpacecraftKind kind_of(const TomlValues& values) {
  return value_of<std::string>(values, "spacecraft.kind") == name_of(SpacecraftKind::Spin)
             ? SpacecraftKind::Spin
             : SpacecraftKind::ThreeAxis;
}

std::set<std::string> tables_of(const TomlValues& values) {
  std::set<std::string> tables;
  for (const auto& [key, value] : values) {
    tables.insert(key.substr(0, key.rfind('.')));
  }
  return tables;
}

std::optional<std::filesystem::path> ground_model(const TomlValues& values,
                                                  const std::filesystem::path& folder) {
  const auto scenario = value_if<std::string>(values, "ground_model.scenario");
  return scenario ? std::optional{folder / *scenario} : std::nullopt;
}

/// @param only The only kind allowed; empty allows any.
Expected<void> allow(TomlDocument& document, std::optional<SpacecraftKind> only) {
  const auto kind = kind_of(document.values);
  if (only && kind != *only) {
    add_problem(document, "spacecraft.kind",
                fmt::format(R"(spacecraft.kind = "{}": must be "{}" for this command)",
                            name_of(kind), name_of(*only)));
    return soundness(document);
  }
  return {};
}

/// @param only The only kind allowed; empty allows any.
Expected<Mission> parse(const std::filesystem::path& path, std::string text,
                        std::optional<SpacecraftKind> only) {
  const auto schema = mission_schema();
  if (!schema) {
    return Unexpected{schema.error()};
  }
  auto document = parse_document(path, std::move(text), *schema);
  if (!document) {
    return Unexpected{std::move(document.error())};
  }
  auto sha256 = sha256_hex(document->text);
  if (!sha256) {
    return Unexpected{std::move(sha256.error())};
  }
  const TomlValues& values = document->values;
  auto orbit = load_orbit(values, path.parent_path());
  if (!orbit) {
    add_problem(*document, orbit_key(values), std::move(orbit.error().message));
  }
  if (auto sound = soundness(*document); !sound) {
    return Unexpected{std::move(sound.error())};
  }
  auto separation = separation_plan(*document);
  const auto contact = planned_contact(*document);
  check_calibration(*document, *schema, kind_of(values));
  check_fields_of_view(*document);
  if (auto sound = soundness(*document); !sound) {
    return Unexpected{std::move(sound.error())};
  }
  if (auto allowed = allow(*document, only); !allowed) {
    return Unexpected{std::move(allowed.error())};
  }
  if (kind_of(values) == SpacecraftKind::Spin) {
    check_estimated_biases(*document);
  }
  if (auto sound = soundness(*document); !sound) {
    return Unexpected{std::move(sound.error())};
  }
  auto defaults = default_sigmas(*document, kind_of(values));
  auto spacecraft_id = std::get<std::string>(values.at("spacecraft.id"));
  const OrbitEphemeris* const ephemeris = orbit->orbit ? orbit->orbit->ephemeris() : nullptr;
  auto doubts =
      ephemeris == nullptr
          ? std::vector<std::string>{}
          : orbit_doubts(*ephemeris, value_of<std::string>(values, "orbit.oem"), spacecraft_id);
  return Mission{
      .spacecraft_id = std::move(spacecraft_id),
      .config = kind_of(values) == SpacecraftKind::Spin
                    ? std::variant<SpinConfig, ThreeAxisConfig>{spin_config(values)}
                    : three_axis_config(values),
      .separation = separation,
      .orbit = std::move(orbit->orbit),
      .toml_text = std::move(document->text),
      .sha256 = std::move(*sha256),
      .orbit_sha256 = std::move(orbit->file_sha256),
      .tables = tables_of(values),
      .orbit_doubts = std::move(doubts),
      .alerts = alert_limits(values),
      .alert_values = alert_values(values),
      .target = spin_target(values),
      .contact = contact,
      .preferred_source = value_if<std::string>(values, "sources.prefer").value_or(std::string{}),
      .host_within_s = number(values, "time.host_within_s"),
      .stores_residuals = value_of<bool>(values, "archive.residuals"),
      .ground_model = ground_model(values, path.parent_path()),
      .default_sigmas = std::move(defaults),
      .path = std::filesystem::absolute(path)};
}

Expected<Mission> load(const std::filesystem::path& path, std::optional<SpacecraftKind> only) {
  return read_text_file(path).and_then(
      [&](std::string&& text) { return parse(path, std::move(text), only); });
}

}  // namespace

Expected<Mission> load_mission(const std::filesystem::path& path) {
  return load(path, std::nullopt);
}

Expected<Mission> mission_of(const std::filesystem::path& path, std::string text) {
  return parse(path, std::move(text), std::nullopt);
}

Expected<Mission> load_spinner(const std::filesystem::path& path) {
  return load(path, SpacecraftKind::Spin);
}

std::optional<TaiTime> field_end(const Mission& mission) {
  const ThreeAxisConfig* const three_axis = mission.three_axis();
  return three_axis != nullptr && three_axis->magnetometer ? std::optional{igrf_end()}
                                                           : std::nullopt;
}

}  // namespace spindrift
