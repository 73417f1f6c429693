#include "pipelines/geomagnetism/shc.h"

#include <fmt/format.h>

#include <string>

#include "tests/support/matchers.h"
#include "tests/support/outcome.h"

namespace spindrift::shc_test {

/// Returns a model with two epochs in which g11 is -2000 nT and -1990 nT and all else is 0.
std::string small_model() {
  std::string text = "# made\n1 13 2 2 1 2000.0 2005.0\n   2000.0 2005.0\n";
  for (int degree = 1; degree <= kHighestDegree; ++degree) {
    for (int order = -degree; order <= degree; ++order) {
      text += degree == 1 && order == 1 ? "1 1 -2000 -1990\r\n"
                                        : fmt::format("{} {} 0 0.0\n", degree, order);
    }
  }
  return text;
}

std::string with(const std::string& old, const std::string& mine) {
  std::string text = small_model();
  return text.replace(text.find(old), old.size(), mine);
}

std::string refused(const std::string& text) {
  const auto model = parse_shc(text);
  if (model) {
    return {};
  }
  EXPECT_EQ(model.error().code, ErrorCode::InvalidConfiguration);
  return model.error().message;
}

TEST(Shc, IsReadAsItStands) {
  const auto model = value_or_throw(parse_shc(small_model()));
  EXPECT_EQ(model.first_year(), 2000.0);
  EXPECT_EQ(model.last_year(), 2005.0);
  // On the equator at longitude 180 the field of a dipole along x is twice as strong and parallel
  // to it.
  const auto field_nt = model.at(2002.5)->at({-kFieldRadius_km, 0.0, 0.0});
  EXPECT_NEAR(field_nt->x(), 2.0 * -1995.0, 1e-9);
  EXPECT_NEAR(field_nt->y(), 0.0, 1e-9);
}

TEST(Shc, IsRefusedWithLineAndReason) {
  for (const auto& [text, line, reason] : {
           std::tuple{std::string{}, "line 1", "0 rows"},
           {with("2000.0 2005.0\n1", "2000.0 2005.0\n2000.0 2005.0\n1"), "line 199", "198 rows"},
           {with("1 13 2 2 1", "1 14 2 2 1"), "line 2", "must be 1 to 13"},
           {with("1 13 2 2 1", "0 13 2 2 1"), "line 2", "must be 1 to 13"},
           {with("1 13 2 2 1", "1 13 2 3 1"), "line 2", "must be 2 and 1"},
           {with("1 13 2 2 1 2000.0 2005.0", "1 13"), "line 2", "must begin with"},
           {with("1 13 2 2 1", "1 13 3 2 1"), "line 3", "2 epochs: the head says 3"},
           {with("   2000.0 2005.0", "   2000.0"), "line 3", "1 epochs: the head says 2"},
           {with("5 2 0 0.0", "5 2 0"), "", "3 numbers: must be degree, order and 2 values"},
           {with("5 2 0 0.0", "5 2 0 nan"), "", "must hold numbers"},
           {with("5 2 0 0.0", "5 2 0 1,0"), "", "must hold numbers"},
           {with("5 2 0 0.0", "14 2 0 0"), "", "degree 14, order 2"},
           {with("5 2 0 0.0", "5 -6 0 0"), "", "degree 5, order -6"},
           {with("5 2 0 0.0", "1e99 2 0 0"), "", "order 2"},
           {with("5 2 0 0.0", "5 1 0 0"), "", "degree 5, order 1: is there twice"},
           {with("   2000.0 2005.0", "   2005.0 2000.0"), "", "2000 behind 2005"},
       }) {
    EXPECT_THAT(refused(text), AllOf(HasSubstr(line), HasSubstr(reason)));
  }
}

}  // namespace spindrift::shc_test
