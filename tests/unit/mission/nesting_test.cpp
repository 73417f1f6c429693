#include "services/mission/nesting.h"

#include <toml++/toml.h>

#include <string>

#include "tests/support/matchers.h"
#include "tests/unit/mission/mission_texts.h"

namespace spindrift::nesting_test {

using mission_test::times;

TEST(Nesting, OfWhatPeopleWriteIsNotTooDeep) {
  for (const std::string& text :
       {std::string{"[a.b.c]\nd.e = [[1.0, 2.5], [3.0, 4.25]]\n"},
        "# " + times(100, "1.2 [{") + "\nk = 1\n", "k = \"" + times(100, ".[{") + "\"\n",
        "k = '" + times(100, ".[{") + "\\'\n", "k = \"a\\\"" + times(100, "[") + "\"\n",
        "k = \"\"\"\n" + times(100, "[\n\"\".") + "\"\"\"\"\"\n[x]\n",
        "k = '''\n" + times(100, "[\n''.") + "'''\n[x]\n", "k = [" + times(100, "1.5, ") + "2]\n",
        times(100, "[[a]]\nb.c = { d = [1] }\n")}) {
    EXPECT_FALSE(line_nested_too_deep(text)) << text;
    EXPECT_NO_THROW(static_cast<void>(toml::parse(text))) << text;
  }
}

TEST(Nesting, IsFoundTooDeepWithItsLine) {
  EXPECT_EQ(line_nested_too_deep("a = 1\n" + times(100'000, "a.") + "a = 1\n"), 2U);
  EXPECT_EQ(line_nested_too_deep("[" + times(100'000, "a . ") + "a]\n"), 1U);
  EXPECT_EQ(line_nested_too_deep("\n\nk = " + times(100'000, "[")), 3U);
  EXPECT_EQ(line_nested_too_deep("k = [\n" + times(17, "[\n")), 17U);
  EXPECT_EQ(line_nested_too_deep(times(100'000, "{a=")), 1U);
  EXPECT_EQ(line_nested_too_deep(times(17, "\"=\".'#'.") + "a = 1"), 1U);
  // The quotes look like the beginning of a string but end one.
  EXPECT_EQ(line_nested_too_deep("k = [\"\"\"x\"\"\"\"\", " + times(17, "[")), 1U);
  EXPECT_EQ(line_nested_too_deep("k = ['''x'''', " + times(17, "[")), 1U);
  EXPECT_EQ(line_nested_too_deep("k = [\"\", " + times(17, "[")), 1U);
  EXPECT_EQ(line_nested_too_deep("k = ['\\', " + times(17, "[")), 1U);
}

}  // namespace spindrift::nesting_test
