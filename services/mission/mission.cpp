#include "services/mission/mission.h"

#include <fmt/format.h>

#include <algorithm>
#include <array>
#include <cstddef>
#include <utility>

#include "services/mission/mission_orbit.h"
#include "services/mission/mission_schema.h"
#include "services/mission/mission_spin.h"
#include "services/toml_schema/document.h"
#include "services/toml_schema/text_file.h"

namespace spindrift {
std::string_view name_of(SpacecraftKind kind) {
  static constexpr std::array<std::string_view, 2> kNames = {"spin", "three_axis"};
  return kNames.at(static_cast<std::size_t>(kind));
}

std::string doubt_about_orbit(const Mission& mission) {
  const OrbitEphemeris* const ephemeris = mission.orbit ? mission.orbit->ephemeris() : nullptr;
  if (ephemeris == nullptr) {
    return {};
  }
  const auto& segments = ephemeris->segments();
  const auto other = std::find_if(segments.begin(), segments.end(), [&](const OemSegment& segment) {
    return segment.object_name != mission.spacecraft_id &&
           segment.object_id != mission.spacecraft_id;
  });
  return other == segments.end()
             ? std::string{}
             : fmt::format(
                   "the orbit file says OBJECT_NAME = {}, OBJECT_ID = {}, the mission "
                   "file spacecraft.id = \"{}\"",
                   other->object_name, other->object_id, mission.spacecraft_id);
}

Expected<Mission> load_mission(const std::filesystem::path& path) {
  const auto schema = mission_schema();
  if (!schema) {
    return Unexpected{schema.error()};
  }
  auto document = read_document(path, *schema);
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
  const auto kind =
      std::get<std::string>(values.at("spacecraft.kind")) == name_of(SpacecraftKind::Spin)
          ? SpacecraftKind::Spin
          : SpacecraftKind::ThreeAxis;
  return Mission{
      .spacecraft_id = std::get<std::string>(values.at("spacecraft.id")),
      .kind = kind,
      .orbit = std::move(orbit->orbit),
      .spin = kind == SpacecraftKind::Spin ? std::optional{spin_config(values)} : std::nullopt,
      .toml_text = std::move(document->text),
      .sha256 = std::move(*sha256),
      .orbit_sha256 = std::move(orbit->file_sha256)};
}

}  // namespace spindrift
