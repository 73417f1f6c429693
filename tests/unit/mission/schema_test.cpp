#include "services/mission/schema.h"

#include "tests/support/matchers.h"
#include "tests/support/outcome.h"

namespace spindrift::schema_test {

std::string error_of(std::string_view schema) {
  const auto rule = parse_schema(schema);
  return rule ? "no error" : rule.error().message;
}

TEST(Schema, GivesTheRulesAsTheyAreWritten) {
  const auto schema = value_or_throw(parse_schema(R"(
      [a]
      about = "table"
      required = "spin"
      exactly_one_of = ["n", "t"]
      n = { type = "number", unit = "deg", above = 0, at_most = 90.5, default = 3, about = "N" }
      t = { type = "text", one_of = ["x", "y"], optional = true, about = "T" }
      old = { moved = "[b] new" }
      i = { type = "integer", shape = [3, 2], at_least = -1, below = 4, not_below_keys = ["n"], about = "I" }
  )"));
  const TableRule& a = schema.tables.at("a");
  EXPECT_EQ(a.required, "spin");
  EXPECT_THAT(a.exactly_one_of, ElementsAre("n", "t"));

  EXPECT_EQ(a.moved.at("old"), "[b] new");
  EXPECT_FALSE(a.keys.contains("old"));

  const KeyRule& n = a.keys.at("n");
  EXPECT_EQ(n.type, ValueType::Number);
  EXPECT_EQ(n.unit, "deg");
  EXPECT_EQ(n.lower->value, Scalar{std::int64_t{0}});
  EXPECT_FALSE(n.lower->inclusive);
  EXPECT_EQ(n.upper->value, Scalar{90.5});
  EXPECT_TRUE(n.upper->inclusive);
  EXPECT_EQ(n.default_value, Scalar{3.0});
  EXPECT_FALSE(n.optional);

  EXPECT_THAT(a.keys.at("t").one_of, ElementsAre("x", "y"));
  EXPECT_TRUE(a.keys.at("t").optional);
  EXPECT_THAT(a.keys.at("i").shape, ElementsAre(3, 2));
  EXPECT_THAT(a.keys.at("i").not_below_keys, ElementsAre("n"));
}

TEST(Schema, WithARuleThatHasNoMeaningIsRefused) {
  EXPECT_THAT(error_of("[a]\nk = { type = \"number\", atleast = 0, below = 1, about = \"k\" }"),
              HasSubstr("a.k: no meaning is known for 'atleast'"));
  EXPECT_THAT(error_of("[a]\nneeded = true"), HasSubstr("a: no meaning is known for 'needed'"));
  EXPECT_THAT(error_of("[a]\nk = { type = \"float\", about = \"k\" }"),
              HasSubstr("a.k: type must be text, boolean, integer or number"));
  EXPECT_THAT(error_of("[a]\nk = { type = \"text\", form = \"email\", about = \"k\" }"),
              HasSubstr("a.k: the form is not known"));
  EXPECT_THAT(error_of("[a\n"), HasSubstr("schema: line 1: "));
}

TEST(Schema, WithAnIncompleteRuleIsRefused) {
  EXPECT_THAT(error_of("[a]\nk = { type = \"number\", at_least = 0, about = \"k\" }"),
              HasSubstr("a.k: needs a lower and an upper bound"));
  EXPECT_THAT(error_of("[a]\nk = { type = \"text\" }"), HasSubstr("a.k: needs an 'about'"));
}

TEST(Schema, WithADefaultThatBreaksItsOwnRuleIsRefused) {
  EXPECT_THAT(error_of("[a]\nk = { type = \"number\", above = 0, below = 1, default = 1, "
                       "about = \"k\" }"),
              HasSubstr("a.k: the default must lie in (0, 1)"));
}

}  // namespace spindrift::schema_test
