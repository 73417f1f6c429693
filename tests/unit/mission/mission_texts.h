/// @file
/// Texts of mission files, among them the contract's example, and functions that load them.

#pragma once

#include <toml++/toml.h>

#include <filesystem>
#include <regex>
#include <sstream>
#include <string>
#include <string_view>
#include <vector>

#include "services/mission/mission.h"
#include "tests/support/matchers.h"
#include "tests/support/temporary_folder.h"
#include "tests/support/test_paths.h"
#include "tests/support/text_of.h"

namespace spindrift::mission_test {

inline const std::filesystem::path kData = test_data();

/// Loads a text as mission.toml next to an orbit.oem.
inline Expected<Mission> load(std::string_view toml) {
  const TemporaryFolder folder;
  folder.write("orbit.oem", text_of(kData / "mission" / "orbit.oem"));
  return load_mission(folder.write("mission.toml", toml));
}

/// Returns one string for each problem, without the folder; empty if there is none.
inline std::vector<std::string> problems_of(std::string_view toml) {
  const auto mission = load(toml);
  if (mission) {
    return {};
  }
  EXPECT_EQ(mission.error().code, ErrorCode::InvalidConfiguration);
  std::istringstream message{mission.error().message};
  std::vector<std::string> problems;
  for (std::string line; std::getline(message, line);) {
    problems.push_back(line.substr(line.find("mission.toml")));
  }
  return problems;
}

inline std::string contract() { return text_of(kData / "mission" / "contract.toml"); }

/// Replaces the only match of `pattern`.
inline std::string replaced(const std::string& toml, const std::string& pattern,
                            const std::string& by) {
  const std::regex regex{pattern};
  EXPECT_TRUE(std::regex_search(toml, regex)) << pattern;
  return std::regex_replace(toml, regex, by, std::regex_constants::format_first_only);
}

/// Returns the contract's example with one value set; line numbers are lost.
inline std::string contract_with(const std::string& path, const std::string& value) {
  toml::table document = toml::parse(contract());
  const auto dot = path.rfind('.');
  toml::table& table = *document.at_path(path.substr(0, dot)).as_table();
  table.insert_or_assign(path.substr(dot + 1), *toml::parse("v = " + value).get("v"));
  std::ostringstream out;
  out << document;
  return out.str();
}

inline std::string times(int count, std::string_view text) {
  std::string all;
  for (int i = 0; i < count; ++i) {
    all += text;
  }
  return all;
}

inline constexpr std::string_view kElements = R"([spacecraft]
id = "LEO"
kind = "three_axis"
[orbit.elements]
epoch_tai_ns = 1795143637000000000
a_km = 7000
e = 0.001
i_deg = 98.0
raan_deg = 10.0
argp_deg = 20.0
mean_anomaly_deg = 30.0
)";

}  // namespace spindrift::mission_test
