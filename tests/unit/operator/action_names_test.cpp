// The names of actions: as parsed, as the archive allows them, and as the page offers them.

#include <regex>
#include <set>
#include <string>

#include "services/operator/parse_action.h"
#include "tests/support/matchers.h"
#include "tests/support/test_paths.h"
#include "tests/support/text_of.h"

namespace spindrift::action_names_test {

using Names = std::set<std::string>;

/// Returns what stands in `text` behind `begin` and before `end`.
std::string between(const std::string& text, const std::string& begin, const std::string& end) {
  const std::size_t from = text.find(begin) + begin.size();
  return text.substr(from, text.find(end, from) - from);
}

/// Returns the first group of each match.
Names names_in(const std::string& text, const std::string& pattern) {
  const std::regex name{pattern};
  Names names;
  for (std::sregex_iterator found{text.begin(), text.end(), name}, end; found != end; ++found) {
    names.insert((*found)[1]);
  }
  return names;
}

Names parsed(SpacecraftKind kind) {
  const auto names = action_names(kind);
  return {names.begin(), names.end()};
}

std::string offered() {
  return between(text_of(source_folder() / "services/console/web/page/actions.js"),
                 "\nconst actions = {", "\n};");
}

TEST(ActionNames, AreThoseThatTheArchiveAllows) {
  constexpr std::size_t kOfEveryKind = 1;
  ASSERT_EQ(parsed(SpacecraftKind::Spin).size(), std::variant_size_v<SpinAction> + kOfEveryKind);
  const std::string tables = text_of(source_folder() / "schemas/tables.sql");
  EXPECT_EQ(names_in(between(tables, "CHECK (action IN (", "))"), R"('(\w+)')"),
            parsed(SpacecraftKind::Spin));
}

TEST(ActionNames, AreThoseThatThePageOffersForEachKindOfSpacecraft) {
  EXPECT_EQ(names_in(offered(), R"(\n  (\w+): \{)"), parsed(SpacecraftKind::Spin));
  Names of_every_kind = names_in(offered(), R"(\n  (\w+): \{)");
  for (const std::string& of_spinners :
       names_in(offered(), R"(\n  (\w+): \{\s+word: '[^']+', of: 'spin')")) {
    of_every_kind.erase(of_spinners);
  }
  EXPECT_EQ(of_every_kind, parsed(SpacecraftKind::ThreeAxis));
}

}  // namespace spindrift::action_names_test
