#include "services/reports/svg.h"

#include <array>

#include "tests/support/matchers.h"
#include "tests/support/well_formed.h"

namespace spindrift::plot::svg_test {

TEST(Svg, IsWellFormedWhateverTheText) {
  Svg svg;
  svg.text({1.0, 2.0}, "a<b & \"c\" > d\x01", {.upwards = true});
  svg.line({0.0, 0.0}, {1.0, 1.0}, {.colour = "#000000", .dashes = "2 3"});
  svg.polyline(std::array{Point{0.0, 0.0}, Point{1.5, 2.5}}, {.colour = "#000000"});
  svg.dot({1.0, 1.0}, 2.0, "#ffffff");
  svg.box({.left = 1.0, .top = 2.0, .right = 4.0, .bottom = 6.0}, "#123456");
  const std::string document = svg.document(100.0, 50.0, "<&>");
  EXPECT_EQ(testing::xml_problem(document), "");
  EXPECT_THAT(document, HasSubstr("a&lt;b &amp; &quot;c&quot; &gt; d?</text>"));
  EXPECT_THAT(document, HasSubstr("<title>&lt;&amp;&gt;</title>"));
  EXPECT_THAT(document, HasSubstr("x=\"1.0\" y=\"2.0\" width=\"3.0\" height=\"4.0\""));
}

TEST(Svg, OfTheTestsCheckFindsWhatIsNotWellFormed) {
  EXPECT_EQ(testing::xml_problem("<a><b x=\"1\"/></a>"), "");
  for (const char* const bad :
       {"<a>", "<a></b>", "<a>&</a>", "<a x=1/>", "<a/><b></b><c></c>", ""}) {
    EXPECT_NE(testing::xml_problem(bad), "") << bad;
  }
}

}  // namespace spindrift::plot::svg_test
