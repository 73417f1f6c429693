#include "services/mission/mission.h"

#include <fmt/format.h>
#include <toml++/toml.h>

#include <algorithm>
#include <array>
#include <cstddef>
#include <utility>

#include "services/mission/mission_check.h"
#include "services/mission/mission_orbit.h"
#include "services/mission/mission_schema.h"
#include "services/mission/mission_spin.h"
#include "services/mission/text_file.h"

namespace spindrift {
namespace {

Expected<toml::table> parse(const std::filesystem::path& path, const std::string& text) {
  try {
    return toml::parse(text);
  } catch (const toml::parse_error& error) {
    const auto& at = error.source().begin;
    return Unexpected{
        {ErrorCode::InvalidConfiguration,
         fmt::format("{}:{}:{}: {}", path.string(), at.line, at.column, error.description())}};
  }
}

Error all_of(std::vector<MissionProblem> problems, const std::filesystem::path& path) {
  // In the order of the file; what has no line comes last.
  std::stable_sort(problems.begin(), problems.end(),
                   [](const auto& a, const auto& b) { return a.line - 1 < b.line - 1; });
  std::vector<std::string> lines;
  lines.reserve(problems.size());
  for (const MissionProblem& problem : problems) {
    lines.push_back(problem.line == 0
                        ? fmt::format("{}: {}", path.string(), problem.text)
                        : fmt::format("{}:{}: {}", path.string(), problem.line, problem.text));
  }
  return {ErrorCode::InvalidConfiguration, fmt::format("{}", fmt::join(lines, "\n"))};
}

}  // namespace

std::string_view name_of(SpacecraftKind kind) {
  static constexpr std::array<std::string_view, 2> kNames = {"spin", "three_axis"};
  return kNames.at(static_cast<std::size_t>(kind));
}

Expected<Mission> load_mission(const std::filesystem::path& path) {
  const auto schema = mission_schema();
  if (!schema) {
    return Unexpected{schema.error()};
  }
  auto text = read_text_file(path);
  if (!text) {
    return Unexpected{std::move(text.error())};
  }
  const auto document = parse(path, *text);
  if (!document) {
    return Unexpected{document.error()};
  }
  auto sha256 = sha256_hex(*text);
  if (!sha256) {
    return Unexpected{std::move(sha256.error())};
  }

  auto [values, problems] = check_mission(*schema, *document);
  auto orbit = load_orbit(values, path.parent_path());
  if (!orbit) {
    const auto* const key = values.contains("orbit.oem") ? "orbit.oem" : "orbit.elements";
    const auto& source = document->at_path(key).node()->source();
    problems.push_back({source.begin.line, std::move(orbit.error().message)});
  }
  if (!problems.empty()) {
    return Unexpected{all_of(std::move(problems), path)};
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
      .toml_text = std::move(*text),
      .sha256 = std::move(*sha256),
      .orbit_sha256 = std::move(orbit->file_sha256)};
}

}  // namespace spindrift
