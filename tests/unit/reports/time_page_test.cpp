#include "services/reports/time_page.h"

#include "tests/support/matchers.h"

namespace spindrift::plot::time_page_test {

std::string page_with(const std::string& name) {
  const TaiTime t = tai_from_ns(1'795'143'637'000'000'000);
  TimePage page{"title", "subtitle", {t, shifted(t, 60.0)}};
  page.panel(100.0, linear_axis("value", 0.0, 1.0, 5),
             {{.name = name, .colour = "#000000", .values = {0.5, 0.5}}});
  return page.document({});
}

TEST(TimePage, NamesCurvesBesideThePanelOrEndsLongNamesAtTheEdgeOfThePage) {
  EXPECT_THAT(page_with("all edges so far"),
              HasSubstr("text-anchor=\"start\">all edges so far</text>"));
  const std::string longer = page_with("sequential, 1 sigma: none");
  EXPECT_THAT(longer, HasSubstr("<text x=\"1172.0\""));
  EXPECT_THAT(longer, HasSubstr("text-anchor=\"end\">sequential, 1 sigma: none</text>"));
}

}  // namespace spindrift::plot::time_page_test
