// The default limits of alerts, as the mission file's schema has them and as schemas/alerts.md
// says.

#include <map>
#include <regex>
#include <sstream>
#include <string>
#include <variant>
#include <vector>

#include "pipelines/supervision/alert_code.h"
#include "services/mission/mission_schema.h"
#include "tests/support/matchers.h"
#include "tests/support/test_paths.h"
#include "tests/support/text_of.h"

namespace spindrift::alert_defaults_test {

/// Returns the numbers in the column `default` by key; a key with several rows has those of all.
std::map<std::string, std::vector<double>> documented_defaults() {
  std::istringstream lines{text_of(source_folder() / "schemas/alerts.md")};
  const std::regex row{R"(\| `([a-z_.]+)(:[A-Z]+)?` \|[^|]+\|[^|]+\| ([^|]+) \|[^|]+\|)"};
  const std::regex number{R"(\d+(\.\d+)?)"};
  std::map<std::string, std::vector<double>> defaults;
  std::smatch cells;
  for (std::string line; std::getline(lines, line);) {
    if (std::regex_match(line, cells, row)) {
      const std::string text = cells[3];
      std::vector<double>& numbers = defaults[cells[1]];
      for (std::sregex_iterator found{text.begin(), text.end(), number}, end; found != end;
           ++found) {
        numbers.push_back(std::stod(found->str()));
      }
    }
  }
  return defaults;
}

TEST(AlertDefaults, AreDocumented) {
  const auto documented = documented_defaults();
  const auto schema = mission_schema().value();
  auto alerts = schema.tables.at("alerts").tables;
  alerts.erase("before_aos");
  alerts.erase("after_los");
  EXPECT_EQ(alerts.size(), static_cast<std::size_t>(kAlertCodes));
  for (const auto& [key, table] : alerts) {
    std::vector<double> defaults;
    for (const auto& [name, rule] : table.keys) {
      if (rule.default_value && name != "hold_off_s") {
        defaults.push_back(std::get<double>(*rule.default_value));
      }
    }
    ASSERT_TRUE(documented.contains(key)) << key;
    if (!defaults.empty()) {  // Without limits of its own, it has those of another.
      EXPECT_THAT(documented.at(key), ::testing::UnorderedElementsAreArray(defaults)) << key;
    }
    EXPECT_EQ(table.keys.at("hold_off_s").default_value, Scalar{60.0}) << key;
  }
}

}  // namespace spindrift::alert_defaults_test
